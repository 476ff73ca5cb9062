// Rays that start on no sphere.

fn is_left(sphere: vec4f) -> bool {
    return false;
}
