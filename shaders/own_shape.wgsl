// What a ray starts on, if it is in this brick.

fn own_shape(from_shape: Left) -> Shape {
    let at = from_shape.place - brick.first_place;
    let is_here = from_shape.id != NO_ID && at < brick.place_count;
    let shape = bare(shapes[select(0u, at, is_here)]);
    return select(no_shape(), shape, is_here);
}
