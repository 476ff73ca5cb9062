// Shapes that a search does not hit. A ray that departs from a shape does not hit it: outside it has left it for good,
// and inside the distance to its far side is known without a search, so that no distance is too small to count. A ray
// towards a light that is a shape does not hit that shape either.

//// none
// For rays that start on no shape.
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
// The index is that of the structure that is searched, and all equal shapes are in the same brick.
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
// The shape may be in another brick, or have another index because other shapes are left out; so ids are compared, which
// takes a read for every test. Equal shapes all have the id of the first.
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
// As by-index, and also the light that the ray goes to.
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
// As by-id, and also the light that the ray goes to.
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
