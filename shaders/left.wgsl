// What a path leaves: which shape, not what it is, so that shapes of any kind can be left.

struct Left {
    // The shape; NO_ID for none. Of shapes in one place all have the id of the first.
    id: u32,
    // Its place, counted through all bricks.
    place: u32,
    // How far it is to its far wall, if the ray goes inside.
    far_wall: f32,
    // Of a path, which emitter is looked for, which hides itself from nobody; in a studio, the bits of the radius.
    word: u32,
}

// For `word`.
const NO_EMITTER: u32 = 0xffffffffu;

fn load_left(index: u32) -> Left {
    let bits = paths[slot(index, LEFT)];
    return Left(bits.x, bits.y, bitcast<f32>(bits.z), bits.w);
}

fn store_left(index: u32, left_shape: Left) {
    paths[slot(index, LEFT)] =
        vec4u(left_shape.id, left_shape.place, bitcast<u32>(left_shape.far_wall), left_shape.word);
}
