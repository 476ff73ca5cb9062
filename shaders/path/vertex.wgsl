// The point where a ray hits a shape or the ground, and the properties of the surface there.
// provides: HIT_GROUND, HIT_NOTHING, HIT_SHAPE, NOT_ROUND, OTHER_BRICK, Place, Vertex, classify_hit,
//   distance_from_camera, ground_vertex, shape_vertex, vertex_of
// needs: Hit, NO_HIT, NO_ID, PATH_INSIDE, Ray, brick, fence3, ground_distance, has, lighting, load_departure,
//   material_index, opacity_of, place_on, shapes, sphere_color, store_hit

struct Vertex {
    position: vec3f,
    // Unit normal on the visible side.
    normal: vec3f,
    // Whether the visible side is the inside of a shape.
    is_back: bool,
    // Distance along the ray.
    distance: f32,
    // Id of the shape, or NO_ID for the ground.
    id: u32,
    shape_index: u32,
    // The sphere of `Place`; its radius is 0 for the ground.
    sphere: vec4f,
    color: vec3f,
    opacity: f32,
    // Row in the table of materials; the ground has the first.
    material: u32,
}

// Where a ray hits a shape.
struct Place {
    position: vec3f,
    // Unit normal, which points out of the shape.
    outward: vec3f,
    // Whether the ray hits the inside.
    is_back: bool,
    // Centre and radius of a sphere. The inside of other shapes has no centre, so they have the radius NOT_ROUND.
    sphere: vec4f,
}

// Radius of shapes that are not round, so large that no ray to a light reaches a far side that is found by it. Searches find
// their far sides.
const NOT_ROUND: f32 = 1e37;

// Kinds of hits. Each path is shaded by exactly one dispatch: that of the brick that contains the shape, or that of
// the first brick for the ground and for misses. For all other dispatches the kind is OTHER_BRICK.
const OTHER_BRICK: u32 = 0u;
const HIT_NOTHING: u32 = 1u;
const HIT_GROUND: u32 = 2u;
const HIT_SHAPE: u32 = 3u;

// The distance that a ray has travelled before its origin, on which it may have hit the ground. A camera ray starts at
// the box of the shapes, other rays on a surface.
fn distance_from_camera(length: f32, surface: u32) -> f32 {
    return select(0.0, length, surface == 0u);
}

fn classify_hit(ray: Ray, hit: Hit, is_on_ground: bool, behind: f32) -> u32 {
    let shape_distance = select(hit.distance + hit.t, NO_HIT, hit.id == NO_ID);
    let to_ground = select(ground_distance(ray, behind), NO_HIT, is_on_ground);
    let shape_index = hit.shape_index - brick.first_shape;
    let is_ground = to_ground < shape_distance;
    if (is_ground || hit.id == NO_ID) {
        let kind = select(HIT_NOTHING, HIT_GROUND, is_ground);
        return select(OTHER_BRICK, kind, brick.is_first != 0u);
    }
    // The subtraction wraps around, so shapes of earlier bricks have a large index.
    return select(OTHER_BRICK, HIT_SHAPE, shape_index < brick.shape_count);
}

// The surface that a ray hits. If it is the ground, the hit of the shape behind is cleared, so that no other brick
// shades it.
fn vertex_of(index: u32, ray: Ray, hit: Hit, kind: u32, flags: u32, behind: f32) -> Vertex {
    if (kind == HIT_GROUND) {
        store_hit(index, Hit(NO_HIT, NO_ID, 0u, 0.0));
        return ground_vertex(ray, behind);
    }
    // A ray that goes into the shape on which it starts may hit its far side.
    return shape_vertex(ray, hit, has(flags, PATH_INSIDE) && hit.id == load_departure(index).id);
}

fn shape_vertex(ray: Ray, hit: Hit, is_far_side: bool) -> Vertex {
    let shape_index = hit.shape_index - brick.first_shape;
    let entered = Ray(fence3(ray.origin + hit.distance * ray.direction), ray.direction);
    let place = place_on(shapes[shape_index], entered, hit, is_far_side);
    let normal = select(place.outward, -place.outward, place.is_back);
    let color = sphere_color(shape_index);
    let material = material_index(shape_index) + 1u;
    let opacity = color.a * opacity_of(material);
    return Vertex(place.position, normal, place.is_back, hit.distance + hit.t, hit.id, hit.shape_index, place.sphere,
        color.rgb, opacity, material);
}

fn ground_vertex(ray: Ray, behind: f32) -> Vertex {
    let distance = ground_distance(ray, behind);
    let on_ray = ray.origin + distance * ray.direction;
    let n = lighting.ground_normal;
    let position = fence3(on_ray - dot(on_ray - lighting.ground_point, n) * n);
    return Vertex(position, n, false, distance, NO_ID, 0u, vec4f(0.0), lighting.ground_color, 1.0, 0u);
}
