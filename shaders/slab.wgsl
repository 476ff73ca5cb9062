// A ray as tests of boxes want it. Twin of src/accel/slab.rs, which says why no test loses a sphere.

// Smaller components of a direction are replaced by this, 2^-40, with their sign: there are no infinities.
const SMALLEST_COMPONENT: f32 = 0x1p-40;

struct SlabRay {
    origin: vec3f,
    // One over the direction.
    inverse: vec3f,
}

fn slab_ray(ray: Ray) -> SlabRay {
    let size = max(abs(ray.direction), vec3f(SMALLEST_COMPONENT));
    return SlabRay(ray.origin, 1.0 / select(size, -size, ray.direction < vec3f(0.0)));
}
