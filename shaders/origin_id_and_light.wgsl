// As origin_id.wgsl, of rays that end on a shape which sends out light; they do not meet that either.

var<private> left: u32;
var<private> sought: u32;

fn leave(from_shape: Left) {
    left = from_shape.id;
    sought = NO_ID;
    if (from_shape.word != NO_EMITTER) {
        sought = emitter(from_shape.word).id;
    }
}

fn is_left(place: u32, shape: Shape) -> bool {
    let id = ids[place];
    return id == left || id == sought;
}
