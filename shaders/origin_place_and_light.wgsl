// As origin_place.wgsl, of rays that end on a shape which sends out light; they do not meet that either.

var<private> left: Shape;
var<private> sought: Shape;

fn leave(departure: Departure) {
    left = own_shape(departure);
    sought = no_shape();
    if (departure.word != NO_EMITTER) {
        sought = emitter(departure.word).sphere;
    }
}

fn is_left(shape_index: u32, shape: Shape) -> bool {
    return is_same(shape, left) || is_same(shape, sought);
}
