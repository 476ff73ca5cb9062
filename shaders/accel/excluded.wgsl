// Shapes that are excluded from a search. A ray that departs from a shape excludes it: outside, the ray never returns
// to a sphere, and inside, the distance to its far side is known without a search. No minimum distance is therefore
// needed. A ray towards a light that is a shape excludes that shape as well.

//// none
// No excluded shapes, for rays that do not start on a shape.
// provides: Excluded, is_excluded, no_exclusion
// needs: Shape

struct Excluded {
    nothing: u32,
}

fn no_exclusion() -> Excluded {
    return Excluded(0u);
}

fn is_excluded(excluded: Excluded, shape_index: u32, shape: Shape) -> bool {
    return false;
}

//// by-index
// Excluding the departed shape by its index. The index is that of the searched structure, and all equal shapes are in
// the same brick.
// provides: Excluded, excluded_by, is_excluded
// needs: Departure, Shape, departed_shape, is_same

struct Excluded {
    departed: Shape,
}

fn excluded_by(departure: Departure) -> Excluded {
    return Excluded(departed_shape(departure));
}

fn is_excluded(excluded: Excluded, shape_index: u32, shape: Shape) -> bool {
    return is_same(shape, excluded.departed);
}

//// by-id
// Excluding the departed shape by its id. An equal shape may be in another brick, or the searched structure may lack
// some shapes and so use other indices. Comparing ids takes one memory access for each test. All equal shapes have the
// id of the first of them.
// provides: Excluded, excluded_by, is_excluded
// needs: Departure, Shape, ids

struct Excluded {
    departed: u32,
}

fn excluded_by(departure: Departure) -> Excluded {
    return Excluded(departure.id);
}

fn is_excluded(excluded: Excluded, shape_index: u32, shape: Shape) -> bool {
    return ids[shape_index] == excluded.departed;
}

//// by-index-and-light
// Excluding the departed shape by its index, and also the emitter that the ray is directed to.
// provides: Excluded, excluded_by, is_excluded
// needs: Departure, NO_EMITTER, Shape, departed_shape, emitter, is_same, no_shape

struct Excluded {
    departed: Shape,
    light: Shape,
}

fn excluded_by(departure: Departure) -> Excluded {
    var light = no_shape();
    if (departure.word != NO_EMITTER) {
        light = emitter(departure.word).sphere;
    }
    return Excluded(departed_shape(departure), light);
}

fn is_excluded(excluded: Excluded, shape_index: u32, shape: Shape) -> bool {
    return is_same(shape, excluded.departed) || is_same(shape, excluded.light);
}

//// by-id-and-light
// Excluding the departed shape by its id, and also the emitter that the ray is directed to.
// provides: Excluded, excluded_by, is_excluded
// needs: Departure, NO_EMITTER, NO_ID, Shape, emitter, ids

struct Excluded {
    departed: u32,
    light: u32,
}

fn excluded_by(departure: Departure) -> Excluded {
    var light = NO_ID;
    if (departure.word != NO_EMITTER) {
        light = emitter(departure.word).id;
    }
    return Excluded(departure.id, light);
}

fn is_excluded(excluded: Excluded, shape_index: u32, shape: Shape) -> bool {
    let id = ids[shape_index];
    return id == excluded.departed || id == excluded.light;
}
