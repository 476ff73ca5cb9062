// Rays that start on a shape do not meet it, as in origin_place.wgsl. Here what they start on may be in another brick,
// or elsewhere because other shapes are left out; so ids are compared, which takes a read for every test. Of shapes in
// one place all have the id of the first.

var<private> left: u32;

fn leave(departure: Departure) {
    left = departure.id;
}

fn is_left(shape_index: u32, shape: Shape) -> bool {
    return ids[shape_index] == left;
}
