// The spheres of one cell of a grid.
//
// They ascend in id, and the nearest of this list replaces one that is as near: the cell in which a ray's nearest point
// lies has all spheres that share the point, and is the last that is tested. So of equal distances the smallest id wins,
// and no id need be read.

//// copied
// A cell's list is a run of spheres; the last one's radius is negative.
// provides: test_list
// needs: Found, NO_HIT, NO_SHAPE, Search, count_iterations, distance_to, shapes

fn test_list(search: Search, start: u32, found: ptr<function, Found>) {
    var t = NO_HIT;
    var shape_index = NO_SHAPE;
    var at = start;
    loop {
        let here = distance_to(search, at);
        if (here < t) {
            t = here;
            shape_index = at;
        }
        if (shapes[at].w < 0.0) {
            break;
        }
        at++;
    }
    // Every list has an end, so that it is enough to count here.
    count_iterations(at - start);
    if (shape_index != NO_SHAPE && t <= (*found).t) {
        *found = Found(t, shape_index);
    }
}

//// referenced
// A cell's list is a run of indices of spheres; the last one's highest bit is set.
// provides: test_list
// needs: Found, NO_HIT, NO_SHAPE, Search, count_iterations, distance_to

// List after list, indices of spheres.
@group(1) @binding(4) var<storage, read> references: array<u32>;

// The bits of a reference that are an index.
const SHAPE_INDEX: u32 = 0x7fffffffu;

fn test_list(search: Search, start: u32, found: ptr<function, Found>) {
    var t = NO_HIT;
    var shape_index = NO_SHAPE;
    var at = start;
    loop {
        let reference = references[at];
        let candidate = reference & SHAPE_INDEX;
        let here = distance_to(search, candidate);
        if (here < t) {
            t = here;
            shape_index = candidate;
        }
        if (reference != candidate) {
            break;
        }
        at++;
    }
    // Every list has an end, so that it is enough to count here.
    count_iterations(at - start);
    if (shape_index != NO_SHAPE && t <= (*found).t) {
        *found = Found(t, shape_index);
    }
}
