// Rays of the fisheye camera. Twin: src/camera/fisheye.rs.
//
// `right`, `up` and `forward` are unit vectors. `first` and `second` are half the sides of the film in units of the
// radius of the visible disk. `third` is half the angle of view in half turns.
// provides: fisheye_ray
// needs: CameraRay, Ray, fence, fence3, frame, sin_cos_half_turns

// Smallest radius in the disk at which the direction of a point is defined. Points nearer to the centre count as the
// centre.
const SMALLEST_SPOT: f32 = 0x1p-40;

fn fisheye_ray(location: vec2f) -> CameraRay {
    let camera = frame.camera;
    let spot = vec2f(fence(location.x * camera.first), fence(location.y * camera.second));
    let radius = fence(sqrt(dot(spot, spot)));
    let angle = sin_cos_half_turns(fence(min(radius, 1.0) * camera.third));
    let side = spot / max(radius, SMALLEST_SPOT);
    let aside = fence3(side.x * camera.right + side.y * camera.up);
    let toward = fence3(angle.x * aside + angle.y * camera.forward);
    let length = sqrt(dot(toward, toward));
    let ray = Ray(camera.origin, fence3(toward * (1.0 / length)));
    return CameraRay(ray, 0.0, radius <= 1.0);
}
