// The ray of the camera of a pipeline, for a location on the film and a pair of numbers that chooses a point on the lens.
// provides: camera_ray
// needs: CameraRay, fisheye_ray, orthographic_ray, panorama_ray, pinhole_ray, thin_lens_ray

// The number of the camera.
override CAMERA: u32;
const PINHOLE: u32 = 0u;
const ORTHOGRAPHIC: u32 = 1u;
const THIN_LENS: u32 = 2u;
const PANORAMA: u32 = 3u;
const FISHEYE: u32 = 4u;

fn camera_ray(location: vec2f, lens: vec2f) -> CameraRay {
    var made: CameraRay;
    switch CAMERA {
        case ORTHOGRAPHIC: {
            made = orthographic_ray(location);
        }
        case THIN_LENS: {
            made = thin_lens_ray(location, lens);
        }
        case PANORAMA: {
            made = panorama_ray(location);
        }
        case FISHEYE: {
            made = fisheye_ray(location);
        }
        case PINHOLE, default: {
            made = pinhole_ray(location);
        }
    }
    return made;
}
