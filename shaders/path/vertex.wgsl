// The point where a ray hits a sphere or the ground, and the properties of the surface there.
// provides: HIT_GROUND, HIT_NOTHING, HIT_SPHERE, OTHER_BRICK, Vertex, classify_hit, distance_from_camera,
//   exit_distance_of, ground_vertex, sphere_vertex, vertex_of
// needs: Hit, NO_HIT, NO_ID, PATH_INSIDE, Ray, brick, fence3, ground_distance, has, intersect, lighting,
//   load_departure, material_index, opacity_of, shapes, sphere_color, sphere_normal, store_hit

struct Vertex {
    position: vec3f,
    // Unit normal on the visible side.
    normal: vec3f,
    // Whether the visible side is the inside of a sphere.
    is_back: bool,
    // Distance along the ray.
    distance: f32,
    // Id of the sphere, or NO_ID for the ground.
    id: u32,
    shape_index: u32,
    // Centre and radius of the sphere; the radius is 0 for the ground.
    sphere: vec4f,
    color: vec3f,
    opacity: f32,
    // Row in the table of materials; the ground has the first.
    material: u32,
}

// Kinds of hits. Each path is shaded by exactly one dispatch: that of the brick that contains the sphere, or that of
// the first brick for the ground and for misses. For all other dispatches the kind is OTHER_BRICK.
const OTHER_BRICK: u32 = 0u;
const HIT_NOTHING: u32 = 1u;
const HIT_GROUND: u32 = 2u;
const HIT_SPHERE: u32 = 3u;

// The distance that a ray has travelled before its origin, on which it may have hit the ground. A camera ray starts at
// the box of the spheres, other rays on a surface.
fn distance_from_camera(length: f32, surface: u32) -> f32 {
    return select(0.0, length, surface == 0u);
}

fn classify_hit(ray: Ray, hit: Hit, is_on_ground: bool, behind: f32) -> u32 {
    let sphere_distance = select(hit.distance + hit.t, NO_HIT, hit.id == NO_ID);
    let to_ground = select(ground_distance(ray, behind), NO_HIT, is_on_ground);
    let shape_index = hit.shape_index - brick.first_shape;
    let is_ground = to_ground < sphere_distance;
    if (is_ground || hit.id == NO_ID) {
        let kind = select(HIT_NOTHING, HIT_GROUND, is_ground);
        return select(OTHER_BRICK, kind, brick.is_first != 0u);
    }
    // The subtraction wraps around, so shapes of earlier bricks have a large index.
    return select(OTHER_BRICK, HIT_SPHERE, shape_index < brick.shape_count);
}

// The surface that a ray hits. If it is the ground, the hit of the sphere behind is cleared, so that no other brick
// shades it.
fn vertex_of(index: u32, ray: Ray, hit: Hit, kind: u32, flags: u32, behind: f32) -> Vertex {
    if (kind == HIT_GROUND) {
        store_hit(index, Hit(NO_HIT, NO_ID, 0u, 0.0));
        return ground_vertex(ray, behind);
    }
    // A ray that goes into the sphere on which it starts may hit its far side.
    return sphere_vertex(ray, hit, has(flags, PATH_INSIDE) && hit.id == load_departure(index).id);
}

fn sphere_vertex(ray: Ray, hit: Hit, is_far_side: bool) -> Vertex {
    let shape_index = hit.shape_index - brick.first_shape;
    let sphere = vec4f(shapes[shape_index].xyz, abs(shapes[shape_index].w));
    let entered = Ray(fence3(ray.origin + hit.distance * ray.direction), ray.direction);
    var found = intersect(entered, sphere);
    let middle = dot(sphere.xyz - entered.origin, ray.direction);
    // The search has decided which side of the sphere is hit.
    let half_chord = select(abs(found.from_foot), abs(middle), is_far_side);
    let is_back = is_far_side || hit.t > middle;
    found.from_foot = select(-half_chord, half_chord, is_back);
    let outward = sphere_normal(entered, found);
    // The point is moved onto the sphere, unless the sphere is so large that its rounding errors exceed those of the
    // ray.
    let on_sphere = sphere.xyz + sphere.w * outward;
    let on_ray = entered.origin + hit.t * ray.direction;
    let position = fence3(select(on_sphere, on_ray, sphere.w > 64.0 * (hit.t + hit.distance)));
    let normal = select(outward, -outward, is_back);
    let color = sphere_color(shape_index);
    let material = material_index(shape_index) + 1u;
    let opacity = color.a * opacity_of(material);
    return Vertex(position, normal, is_back, hit.distance + hit.t, hit.id, hit.shape_index, sphere, color.rgb, opacity, material);
}

// The distance from a point of a sphere through its inside to the far side; 0 if the direction points outwards.
fn exit_distance_of(vertex: Vertex, direction: vec3f) -> f32 {
    return max(2.0 * dot(vertex.sphere.xyz - vertex.position, direction), 0.0);
}

fn ground_vertex(ray: Ray, behind: f32) -> Vertex {
    let distance = ground_distance(ray, behind);
    let on_ray = ray.origin + distance * ray.direction;
    let n = lighting.ground_normal;
    let position = fence3(on_ray - dot(on_ray - lighting.ground_point, n) * n);
    return Vertex(position, n, false, distance, NO_ID, 0u, vec4f(0.0), lighting.ground_color, 1.0, 0u);
}
