// Computes where rays hit cones.
// dispatched: by the self-test, with one invocation for each ray and its cone.
// provides: NO_HIT, cones
// needs: Ray, Shape, cone_normal, intersect

// As in scene/frame.wgsl.
const NO_HIT: f32 = 1e30;

struct RayAndCone {
    origin: vec3f,
    direction: vec3f,
    cone: Shape,
}

struct ConeAnswer {
    normal: vec3f,
    t: f32,
}

// Inputs, with one struct for each invocation.
@group(0) @binding(1) var<storage, read> rays_and_cones: array<RayAndCone>;
// Results of the device, with one struct for each invocation.
@group(0) @binding(2) var<storage, read_write> answers: array<ConeAnswer>;

@compute @workgroup_size(64)
fn cones(@builtin(global_invocation_id) invocation: vec3u) {
    let tested = rays_and_cones[invocation.x];
    let hit = intersect(Ray(tested.origin, tested.direction), tested.cone);
    answers[invocation.x] = ConeAnswer(cone_normal(hit.crossing, hit.is_near), hit.t);
}
