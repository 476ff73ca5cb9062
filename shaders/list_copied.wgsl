// A cell's list is a run of spheres; the last one's radius is negative.
//
// They ascend in id, and the nearest of this list replaces one that is as near: the cell in which a ray's
// nearest point lies has all spheres that share the point, and is the last that is tested. So of equal
// distances the smallest id wins, and no id need be read.

fn test_list(ray: Ray, start: u32, found: ptr<function, Found>) {
    var t = NO_HIT;
    var shape_index = NO_SHAPE;
    var at = start;
    loop {
        let here = distance_to(ray, at);
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
    spent += at - start;
    if (shape_index != NO_SHAPE && t <= (*found).t) {
        *found = Found(t, shape_index);
    }
}
