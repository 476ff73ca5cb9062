// An emissive sphere of the scene, read from the table of emitters.
// provides: Emitter, emitter, emitter_words

const EMITTER_COLUMNS: u32 = 2048u;
const EMITTER_ROWS: u32 = 2048u;

// The table of emitters: three texels for each, row by row and layer by layer. It is a texture because the size of a
// texture array is not limited by that of a buffer's binding. Texels are bits, because some are integers, which as f32
// would be subnormal and might be flushed to zero.
@group(2) @binding(2) var emitters: texture_2d_array<u32>;

// An emissive sphere, the probability with which it is sampled, and its radiance.
struct Emitter {
    sphere: vec4f,
    id: u32,
    probability: f32,
    radiance: vec3f,
}

// A texel of the table: of emitter i, 3i is the sphere; 3i + 1 has its id, the largest random number that chooses it
// and its probability; and 3i + 2 is its radiance.
fn emitter_words(at: u32) -> vec4u {
    let row = at / EMITTER_COLUMNS;
    return textureLoad(emitters, vec2u(at % EMITTER_COLUMNS, row % EMITTER_ROWS), row / EMITTER_ROWS, 0);
}

fn emitter(index: u32) -> Emitter {
    let chosen = emitter_words(3u * index + 1u);
    return Emitter(bitcast<vec4f>(emitter_words(3u * index)), chosen.x, bitcast<f32>(chosen.z),
        bitcast<vec3f>(emitter_words(3u * index + 2u).xyz));
}
