// As origin_id.wgsl, of rays that end on a shape which sends out light; they do not meet that either.

var<private> left: u32;
var<private> sought: u32;

fn leave(departure: Departure) {
    left = departure.id;
    sought = NO_ID;
    if (departure.word != NO_EMITTER) {
        sought = emitter(departure.word).id;
    }
}

fn is_left(shape_index: u32, shape: Shape) -> bool {
    let id = ids[shape_index];
    return id == left || id == sought;
}
