// Rays, and rays of a camera.
// provides: CameraRay, Ray

struct Ray {
    origin: vec3f,
    // Unit length, up to rounding.
    direction: vec3f,
}

struct CameraRay {
    ray: Ray,
    // From the camera's own origin of this ray to where it starts here.
    distance: f32,
    // Whether there is a ray at all; if not, the numbers are those of some ray.
    is_seen: bool,
}
