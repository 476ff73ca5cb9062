// A brick, which is a part of the scene that fits into bindings, and the tests of its shapes.
// provides: Nearest, Search, brick, distance_within, hit_of, ids, offer, shapes
// needs: Brick, Entry, Excluded, Hit, NO_HIT, Ray, Shape, distance_of_excluded, intersect, is_excluded

struct Nearest {
    t: f32,
    // Index in input order.
    id: u32,
    // Index into `shapes`.
    shape_index: u32,
}

// Number of shapes, index of the first, box of the grid, and layout of the appearance words.
@group(1) @binding(0) var<uniform> brick: Brick;
// Shapes in the order of the structure, in the layout of the primitive.
@group(1) @binding(1) var<storage, read> shapes: array<Shape>;
// Index of each shape in input order.
@group(1) @binding(2) var<storage, read> ids: array<u32>;

// A ray, and the shapes that are excluded from its search.
struct Search {
    ray: Ray,
    // Reciprocals of the direction's components, from `inverse_direction`.
    inverse: vec3f,
    excluded: Excluded,
}

// The distance to a shape if it is less than a limit, otherwise any distance that is not. Only a shape that would be
// the nearest is compared with the excluded ones, because that takes as long as the test of a sphere.
fn distance_within(search: Search, shape_index: u32, limit: f32) -> f32 {
    let shape = shapes[shape_index];
    var t = intersect(search.ray, shape).t;
    if (t < limit && is_excluded(search.excluded, shape_index, shape)) {
        t = distance_of_excluded(search, shape);
    }
    return t;
}

// Replaces the nearest hit if a shape is nearer, or as near with a smaller id. The result therefore does not depend on
// the order in which shapes are tested. Ids are read only here, because memory accesses are expensive on software
// devices.
fn offer(nearest: ptr<function, Nearest>, t: f32, shape_index: u32) {
    if (t < NO_HIT && t <= (*nearest).t) {
        let id = ids[shape_index];
        if (t < (*nearest).t || id < (*nearest).id) {
            *nearest = Nearest(t, id, shape_index);
        }
    }
}

// The nearest hit, where `before` is that of earlier bricks.
fn hit_of(nearest: Nearest, entry: Entry, before: Hit) -> Hit {
    var hit = before;
    if (nearest.id != before.id) {
        hit = Hit(nearest.t, nearest.id, brick.first_shape + nearest.shape_index, entry.distance);
    }
    return hit;
}
