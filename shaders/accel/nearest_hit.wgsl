// Searching a brick for the nearest shape.
// provides: nearest_hit
// needs: Entry, Excluded, Hit, Nearest, Search, find_nearest, hit_of

// The nearest hit in the brick, or the hit `before` from earlier bricks if that is nearer.
fn nearest_hit(entry: Entry, excluded: Excluded, before: Hit) -> Hit {
    var nearest = Nearest(before.t, before.id, 0u);
    if (entry.is_inside) {
        find_nearest(Search(entry.ray, entry.inverse, excluded), &nearest);
    }
    return hit_of(nearest, entry, before);
}
