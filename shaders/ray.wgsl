struct Ray {
    origin: vec3f,
    // Unit length, up to rounding.
    direction: vec3f,
}
