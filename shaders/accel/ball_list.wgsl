// The list of a cell: first whether the part of the ray in the cell meets a coarse ball around each sphere, and then the
// spheres whose balls it meets.
//
// The ids in a list ascend, and the nearest sphere of the list replaces an equally near one of an earlier cell. The
// cell that contains the nearest hit point holds all spheres through that point and is tested last. The smallest id
// therefore wins among equal distances, and no id needs to be read.
// provides: NO_LIST, find_candidates, list_of, test_candidates
// needs: Found, IN_VECTOR, KIND, LAST_BALL, LIST, NO_HIT, PartInCell, Search, balls, brick, count_iterations,
//   distance_within, ids, met

// The number of balls that are tested before the spheres of those that are met: one for each bit of a word.
const AT_ONCE: u32 = 32u;
// The bits of a reference that contain the index.
const SHAPE_INDEX: u32 = 0x7fffffffu;

// A list that is being tested.
struct List {
    // Index of the next vector of balls, or NO_LIST if there are no more.
    next: u32,
    // Element of the list that bit 0 of `candidates` stands for.
    first: u32,
    // A bit for each sphere whose ball was met and which has not been tested.
    candidates: u32,
    // Distance of the nearest hit in this list.
    t: f32,
}

const NO_LIST: u32 = 0xffffffffu;

// The list of the cell with the given word.
fn list_of(word: u32) -> List {
    let first = (word & ~KIND) / IN_VECTOR;
    return List(select(NO_LIST, first, (word & KIND) == LIST), 0u, 0u, NO_HIT);
}

// Finds the spheres, among the next AT_ONCE of the list, whose balls are met.
fn find_candidates(list: ptr<function, List>, part: PartInCell) {
    var at = (*list).next;
    // Always computed anew, it would be wrong in lavapipe of Mesa 22.3 for rays that have left the loop of the caller.
    (*list).first = select((*list).first, at * IN_VECTOR, at != NO_LIST);
    var candidates = 0u;
    var tested = 0u;
    loop {
        if (at == NO_LIST || tested == AT_ONCE) {
            break;
        }
        let four = balls[at];
        candidates |= met(four, part) << tested;
        tested += IN_VECTOR;
        at = select(at + 1u, NO_LIST, four.w >= LAST_BALL);
    }
    count_iterations(tested);
    (*list).next = at;
    (*list).candidates = candidates;
}

// Tests the spheres that `find_candidates` found.
fn test_candidates(search: Search, list: ptr<function, List>, found: ptr<function, Found>) {
    loop {
        if ((*list).candidates == 0u) {
            break;
        }
        let at = (*list).first + firstTrailingBit((*list).candidates);
        (*list).candidates &= (*list).candidates - 1u;
        let shape_index = ids[brick.first_reference + at] & SHAPE_INDEX;
        let t = distance_within(search, shape_index, (*list).t);
        if (t < (*list).t) {
            (*list).t = t;
            if (t <= (*found).t) {
                *found = Found(t, shape_index);
            }
        }
    }
}
