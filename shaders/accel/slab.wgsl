// The ray in the form that box tests need. src/accel/slab.rs explains why the tests never miss a
// sphere.
// provides: SlabRay

struct SlabRay {
    origin: vec3f,
    // Reciprocals of the direction's components.
    inverse: vec3f,
    // By how much boxes are wider for this ray than they are.
    wider: f32,
}
