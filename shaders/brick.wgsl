// A part of the scene that fits into bindings, and the nearest of its spheres.

struct Nearest {
    t: f32,
    // Index in input order.
    id: u32,
    // Index into `spheres`.
    place: u32,
}

@group(1) @binding(0) var<uniform> brick: Brick;
// Centre in the scene's frame, and radius, whose sign means nothing here.
@group(1) @binding(1) var<storage, read> spheres: array<vec4f>;
// Index of each sphere in input order.
@group(1) @binding(2) var<storage, read> ids: array<u32>;

// Takes a sphere if it is nearer, or as near and of a smaller id: the answer does not depend on the order
// in which spheres are tried. Ids are read only here, because a read is dear on a software device.
fn offer(nearest: ptr<function, Nearest>, t: f32, place: u32) {
    if (t < NO_HIT && t <= (*nearest).t) {
        let id = ids[place];
        if (t < (*nearest).t || id < (*nearest).id) {
            *nearest = Nearest(t, id, place);
        }
    }
}
