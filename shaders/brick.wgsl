// A part of the scene that fits into bindings, and the nearest of its shapes.

struct Nearest {
    t: f32,
    // Index in input order.
    id: u32,
    // Index into `shapes`.
    shape_index: u32,
}

@group(1) @binding(0) var<uniform> brick: Brick;
// In the order of the structure; what they are, the primitive's part says. The sign of a radius means nothing here.
@group(1) @binding(1) var<storage, read> shapes: array<Shape>;
// Index of each shape in input order.
@group(1) @binding(2) var<storage, read> ids: array<u32>;

// The distance to a shape, or NO_HIT.
fn distance_to(ray: Ray, shape_index: u32) -> f32 {
    let shape = shapes[shape_index];
    return select(intersect(ray, shape).t, NO_HIT, is_left(shape_index, shape));
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
fn nearest_hit(entry: Entry, before: Hit) -> Hit {
    var nearest = Nearest(before.t, before.id, 0u);
    if (entry.is_inside) {
        find_nearest(entry.ray, entry.inverse, &nearest);
    }
    var hit = before;
    if (nearest.id != before.id) {
        hit = Hit(nearest.t, nearest.id, brick.first_shape + nearest.shape_index, entry.distance);
    }
    return hit;
}
