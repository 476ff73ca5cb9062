// Rays that start on no sphere.

fn is_left(shape: Shape) -> bool {
    return false;
}
