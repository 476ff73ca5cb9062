// Rays that start on no shape.

fn is_left(shape_index: u32, shape: Shape) -> bool {
    return false;
}
