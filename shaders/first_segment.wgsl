// What is known of a path's ray before the first brick is traced: one that starts on a sphere and goes inside meets
// its far wall at the latest, at twice the distance to the middle of the chord.

fn hit_before(index: u32) -> Hit {
    let origin = load(index, ORIGIN);
    let sphere = load(index, LEFT);
    let middle = dot(sphere.xyz - origin.xyz, load(index, DIRECTION).xyz);
    let place = bitcast<u32>(load(index, THROUGHPUT).w);
    let id = bitcast<u32>(load(index, SURFACE).w);
    if (has(bitcast<u32>(origin.w), PATH_INSIDE)) {
        return Hit(max(2.0 * middle, 0.0), id, place, 0.0);
    }
    return Hit(NO_HIT, NO_ID, 0u, 0.0);
}
