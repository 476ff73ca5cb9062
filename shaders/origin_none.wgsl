// Rays that start on no shape.

fn is_left(place: u32, shape: Shape) -> bool {
    return false;
}
