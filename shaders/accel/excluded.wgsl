// Shapes that are excluded from a search. A ray that departs from a shape excludes it: outside, the ray never returns
// to a sphere or a cone, and inside, the distance to its far side is known without a search, or the search computes that side
// alone. No minimum distance is therefore needed. A ray towards a light that is a shape excludes that shape as well.
//
// The departed shape is excluded by its index, which is that of the searched structure, if all equal shapes are in the
// same brick. Otherwise it is excluded by its id: an equal shape may be in another brick, or the searched structure may
// lack some shapes and so use other indices. Comparing ids takes one memory access for each test. All equal shapes have
// the id of the first of them.

//// none
// No excluded shapes, for rays that do not start on a shape.
// provides: Excluded, distance_of_excluded, is_excluded, no_exclusion
// needs: NO_HIT, Search, Shape

struct Excluded {
    nothing: u32,
}

fn no_exclusion() -> Excluded {
    return Excluded(0u);
}

fn is_excluded(excluded: Excluded, shape_index: u32, shape: Shape) -> bool {
    return false;
}

fn distance_of_excluded(search: Search, shape: Shape) -> f32 {
    return NO_HIT;
}

//// departed
// Excluding the departed shape.
// provides: Excluded, distance_of_excluded, excluded_by, is_excluded
// needs: Departure, NO_HIT, Search, Shape, departed_shape, ids, is_same, no_shape, searched_far_side

// Whether shapes are excluded by their ids, and not by their indices.
override EXCLUDES_BY_ID: bool;

struct Excluded {
    departed: Shape,
    id: u32,
    // Whether the ray goes inside, and the search has to find the far side.
    goes_inside: bool,
}

fn excluded_by(departure: Departure) -> Excluded {
    var excluded = Excluded(no_shape(), departure.id, false);
    if (!EXCLUDES_BY_ID) {
        excluded.departed = departed_shape(departure);
    }
    return excluded;
}

fn is_excluded(excluded: Excluded, shape_index: u32, shape: Shape) -> bool {
    if (EXCLUDES_BY_ID) {
        return ids[shape_index] == excluded.id;
    }
    return is_same(shape, excluded.departed);
}

fn distance_of_excluded(search: Search, shape: Shape) -> f32 {
    return select(NO_HIT, searched_far_side(search.ray, shape), search.excluded.goes_inside);
}

//// departed-and-light
// Excluding the departed shape, and also the emitter that the ray is directed to.
// provides: Excluded, distance_of_excluded, excluded_by, is_excluded
// needs: Departure, NO_EMITTER, NO_HIT, NO_ID, SAMPLES_LIGHT, Search, Shape, departed_shape, emitter, ids, is_same,
//   no_shape

// Whether shapes are excluded by their ids, and not by their indices.
override EXCLUDES_BY_ID: bool;

struct Excluded {
    departed: Shape,
    light: Shape,
    id: u32,
    light_id: u32,
}

fn excluded_by(departure: Departure) -> Excluded {
    var excluded = Excluded(no_shape(), no_shape(), departure.id, NO_ID);
    if (SAMPLES_LIGHT && departure.word != NO_EMITTER) {
        let light = emitter(departure.word);
        excluded.light = light.sphere;
        excluded.light_id = light.id;
    }
    if (!EXCLUDES_BY_ID) {
        excluded.departed = departed_shape(departure);
    }
    return excluded;
}

fn is_excluded(excluded: Excluded, shape_index: u32, shape: Shape) -> bool {
    if (EXCLUDES_BY_ID) {
        let id = ids[shape_index];
        return id == excluded.id || (SAMPLES_LIGHT && id == excluded.light_id);
    }
    return is_same(shape, excluded.departed) || (SAMPLES_LIGHT && is_same(shape, excluded.light));
}

fn distance_of_excluded(search: Search, shape: Shape) -> f32 {
    return NO_HIT;
}
