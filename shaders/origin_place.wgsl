// Rays that start on a shape do not meet it: from outside it is left for good, and the far side, for a ray that goes
// inside, is known without a search. So no distance is too small to count. Here rays know the place of what they start
// on among the shapes that they search, and whatever is equal to it is in this brick.

var<private> left: Shape;

fn leave(departure: Departure) {
    left = own_shape(departure);
}

fn is_left(shape_index: u32, shape: Shape) -> bool {
    return is_same(shape, left);
}
