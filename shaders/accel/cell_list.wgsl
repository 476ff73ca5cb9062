// Testing the spheres of a cell's list of references. The highest bit of the last reference is set.
//
// The ids in a list ascend, and the nearest sphere of the list replaces an equally near one of an earlier cell. The
// cell that contains the nearest hit point holds all spheres through that point and is tested last. The smallest id
// therefore wins among equal distances, and no id needs to be read.
// provides: test_list
// needs: Found, NO_HIT, NO_SHAPE, Search, count_iterations, distance_within

// Indices of the spheres of all cells, list after list.
@group(1) @binding(4) var<storage, read> references: array<u32>;

// The bits of a reference that contain the index.
const SHAPE_INDEX: u32 = 0x7fffffffu;

fn test_list(search: Search, start: u32, found: ptr<function, Found>) {
    var t = NO_HIT;
    var shape_index = NO_SHAPE;
    var at = start;
    loop {
        let reference = references[at];
        let candidate = reference & SHAPE_INDEX;
        let here = distance_within(search, candidate, t);
        if (here < t) {
            t = here;
            shape_index = candidate;
        }
        if (reference != candidate) {
            break;
        }
        at++;
    }
    // Every list has an end, so it suffices to count its iterations here.
    count_iterations(at - start);
    if (shape_index != NO_SHAPE && t <= (*found).t) {
        *found = Found(t, shape_index);
    }
}
