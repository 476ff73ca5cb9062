// A ray as tests of boxes want it. Twin: src/accel/slab.rs, which says why no test loses a sphere.
// provides: SlabRay

struct SlabRay {
    origin: vec3f,
    // One over the direction.
    inverse: vec3f,
}
