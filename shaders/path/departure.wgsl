// The surface that a ray departs from. It is identified by id and index, so that it works for every primitive.
// provides: Departure, NO_EMITTER, load_departure, store_departure
// needs: DEPARTURE, paths, slot

struct Departure {
    // Id of the shape, or NO_ID. Equal shapes all have the id of the first of them.
    id: u32,
    // Index of the shape, counted through all bricks.
    shape_index: u32,
    // Distance to the far side of the shape, if the ray goes inside.
    exit_distance: f32,
    // For paths, the index of the emitter that light sampling chose, which is excluded from the search of occluders.
    // For studios, the bits of the shape's radius.
    word: u32,
}

// The value of `word` without an emitter.
const NO_EMITTER: u32 = 0xffffffffu;

fn load_departure(index: u32) -> Departure {
    let bits = paths[slot(index, DEPARTURE)];
    return Departure(bits.x, bits.y, bitcast<f32>(bits.z), bits.w);
}

fn store_departure(index: u32, departure: Departure) {
    paths[slot(index, DEPARTURE)] =
        vec4u(departure.id, departure.shape_index, bitcast<u32>(departure.exit_distance), departure.word);
}
