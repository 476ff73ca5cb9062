// The structs of rays and of camera rays.
// provides: CameraRay, Ray

struct Ray {
    origin: vec3f,
    // Unit length, up to rounding.
    direction: vec3f,
}

struct CameraRay {
    ray: Ray,
    // Distance from the origin of the ray in the camera to the origin that is used here.
    distance: f32,
    // Whether the camera has a ray at this location. If not, the other fields are those of an arbitrary ray.
    is_seen: bool,
}
