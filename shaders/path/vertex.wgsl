// Where a ray meets a sphere or the ground, and what is there.
// provides: GROUND_MET, NOBODY, NOTHING_MET, Vertex, come_from_camera, exit_distance_of, vertex_of, what_is_met
// needs: Hit, NO_HIT, NO_ID, PATH_INSIDE, Ray, brick, dispatch, fence3, ground_distance, has, intersect, lighting,
//   load_departure, material_index, opacity_of, shapes, sphere_color, sphere_normal, store_hit

struct Vertex {
    position: vec3f,
    // Unit, on the side that is seen.
    normal: vec3f,
    // Whether that is the inside of a sphere.
    is_back: bool,
    // Along the ray.
    distance: f32,
    // Of the sphere; NO_ID for the ground.
    id: u32,
    shape_index: u32,
    // The sphere; radius 0 for the ground.
    sphere: vec4f,
    color: vec3f,
    opacity: f32,
    // Its row in the table of materials; the ground has the first.
    material: u32,
}

// Whose turn it is to go on with a pixel: that of the brick with its sphere, and of the first for the rest.
const NOBODY: u32 = 0u;
const NOTHING_MET: u32 = 1u;
const GROUND_MET: u32 = 2u;
const SPHERE_MET: u32 = 3u;

// How far the ray has come before its origin, where the ground may have been met already: a camera's starts where
// spheres begin.
fn come_from_camera(length: f32) -> f32 {
    return select(0.0, length, dispatch.surface == 0u);
}

fn what_is_met(ray: Ray, hit: Hit, is_on_ground: bool, behind: f32) -> u32 {
    let sphere_distance = select(hit.distance + hit.t, NO_HIT, hit.id == NO_ID);
    let to_ground = select(ground_distance(ray, behind), NO_HIT, is_on_ground);
    let shape_index = hit.shape_index - brick.first_shape;
    let is_ground = to_ground < sphere_distance;
    if (is_ground || hit.id == NO_ID) {
        let met = select(NOTHING_MET, GROUND_MET, is_ground);
        return select(NOBODY, met, brick.is_first != 0u);
    }
    // What lies before the brick has become a large number.
    return select(NOBODY, SPHERE_MET, shape_index < brick.shape_count);
}

// What a ray meets. On the ground no other brick is to take the sphere behind for it.
fn vertex_of(index: u32, ray: Ray, hit: Hit, met: u32, flags: u32, behind: f32) -> Vertex {
    if (met == GROUND_MET) {
        store_hit(index, Hit(NO_HIT, NO_ID, 0u, 0.0));
        return ground_vertex(ray, behind);
    }
    // A ray that goes inside of what it starts on may meet its far side.
    return sphere_vertex(ray, hit, has(flags, PATH_INSIDE) && hit.id == load_departure(index).id);
}

fn sphere_vertex(ray: Ray, hit: Hit, is_far_side: bool) -> Vertex {
    let shape_index = hit.shape_index - brick.first_shape;
    let sphere = vec4f(shapes[shape_index].xyz, abs(shapes[shape_index].w));
    let entered = Ray(fence3(ray.origin + hit.distance * ray.direction), ray.direction);
    var found = intersect(entered, sphere);
    let middle = dot(sphere.xyz - entered.origin, ray.direction);
    // Which wall it is, the search has decided.
    let half_chord = select(abs(found.from_foot), abs(middle), is_far_side);
    let is_back = is_far_side || hit.t > middle;
    found.from_foot = select(-half_chord, half_chord, is_back);
    let outward = sphere_normal(entered, found);
    // Back on the sphere, unless that is so large that its own numbers are coarser than the ray's.
    let on_sphere = sphere.xyz + sphere.w * outward;
    let on_ray = entered.origin + hit.t * ray.direction;
    let position = fence3(select(on_sphere, on_ray, sphere.w > 64.0 * (hit.t + hit.distance)));
    let normal = select(outward, -outward, is_back);
    let color = sphere_color(shape_index);
    let material = material_index(shape_index) + 1u;
    let opacity = color.a * opacity_of(material);
    return Vertex(position, normal, is_back, hit.distance + hit.t, hit.id, hit.shape_index, sphere, color.rgb, opacity, material);
}

// How far it is from the surface of a sphere to its other side; 0 if that is not inside.
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
