// As origin_place.wgsl, of rays that end on a shape which sends out light; they do not meet that either.

var<private> left: Shape;
var<private> sought: Shape;

fn leave(from_shape: Left) {
    left = own_shape(from_shape);
    sought = no_shape();
    if (from_shape.word != NO_EMITTER) {
        sought = emitter(from_shape.word).sphere;
    }
}

fn is_left(place: u32, shape: Shape) -> bool {
    return is_same(shape, left) || is_same(shape, sought);
}
