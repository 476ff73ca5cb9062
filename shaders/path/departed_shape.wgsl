// The shape that a ray departs from, or no shape if it is not in this brick.
// provides: departed_shape
// needs: Departure, NO_ID, Shape, brick, no_shape, shapes

fn departed_shape(departure: Departure) -> Shape {
    let at = departure.shape_index - brick.first_shape;
    let is_here = departure.id != NO_ID && at < brick.shape_count;
    var shape = no_shape();
    if (is_here) {
        shape = shapes[at];
    }
    return shape;
}
