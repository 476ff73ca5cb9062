// What a ray starts on, if it is in this brick.

fn own_shape(departure: Departure) -> Shape {
    let at = departure.shape_index - brick.first_shape;
    let is_here = departure.id != NO_ID && at < brick.shape_count;
    let shape = bare(shapes[select(0u, at, is_here)]);
    return select(no_shape(), shape, is_here);
}
