// A part of the scene that fits into bindings, and the nearest of its shapes.
// provides: Nearest, Search, brick, distance_to, ids, nearest_hit, offer, shapes
// needs: Brick, Entry, Excluded, Hit, NO_HIT, Ray, Shape, find_nearest, intersect, is_excluded

struct Nearest {
    t: f32,
    // Index in input order.
    id: u32,
    // Index into `shapes`.
    shape_index: u32,
}

// How many shapes there are, which is the first, the box of the grid, and how words of colour are read.
@group(1) @binding(0) var<uniform> brick: Brick;
// In the order of the structure; what they are, the primitive's part says. The sign of a radius means nothing here.
@group(1) @binding(1) var<storage, read> shapes: array<Shape>;
// Index of each shape in input order.
@group(1) @binding(2) var<storage, read> ids: array<u32>;

// A ray, and the shapes that it does not hit.
struct Search {
    ray: Ray,
    // One over the direction, from `inverse_direction`.
    inverse: vec3f,
    excluded: Excluded,
}

// The distance to a shape, or NO_HIT.
fn distance_to(search: Search, shape_index: u32) -> f32 {
    let shape = shapes[shape_index];
    return select(intersect(search.ray, shape).t, NO_HIT, is_excluded(search.excluded, shape_index, shape));
}

// Takes a shape if it is nearer, or as near and of a smaller id: the answer does not depend on the order
// in which shapes are tried. Ids are read only here, because a read is dear on a software device.
fn offer(nearest: ptr<function, Nearest>, t: f32, shape_index: u32) {
    if (t < NO_HIT && t <= (*nearest).t) {
        let id = ids[shape_index];
        if (t < (*nearest).t || id < (*nearest).id) {
            *nearest = Nearest(t, id, shape_index);
        }
    }
}

// What of the brick is nearer than what has been found before it, or else that.
fn nearest_hit(entry: Entry, excluded: Excluded, before: Hit) -> Hit {
    var nearest = Nearest(before.t, before.id, 0u);
    if (entry.is_inside) {
        find_nearest(Search(entry.ray, entry.inverse, excluded), &nearest);
    }
    var hit = before;
    if (nearest.id != before.id) {
        hit = Hit(nearest.t, nearest.id, brick.first_shape + nearest.shape_index, entry.distance);
    }
    return hit;
}
