struct Ray {
    origin: vec3f,
    // Unit length, up to rounding.
    direction: vec3f,
}

struct CameraRay {
    ray: Ray,
    // From the camera's own origin of this ray to where it starts here.
    distance: f32,
}
