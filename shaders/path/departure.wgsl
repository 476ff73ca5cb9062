// What a path leaves: which shape, not what it is, so that shapes of any kind can be left.
// provides: Departure, NO_EMITTER, load_departure, store_departure
// needs: DEPARTURE, paths, slot

struct Departure {
    // The shape; NO_ID for none. Of shapes in one place all have the id of the first.
    id: u32,
    // Its place, counted through all bricks.
    shape_index: u32,
    // How far it is to its far side, if the ray goes inside.
    exit_distance: f32,
    // Of a path, which emitter is looked for, which hides itself from nobody; in a studio, the bits of the radius.
    word: u32,
}

// For `word`.
const NO_EMITTER: u32 = 0xffffffffu;

fn load_departure(index: u32) -> Departure {
    let bits = paths[slot(index, DEPARTURE)];
    return Departure(bits.x, bits.y, bitcast<f32>(bits.z), bits.w);
}

fn store_departure(index: u32, departure: Departure) {
    paths[slot(index, DEPARTURE)] =
        vec4u(departure.id, departure.shape_index, bitcast<u32>(departure.exit_distance), departure.word);
}
