// Sample points as a function of pixel, sample and pair of dimensions. Twin: src/camera/sampling.rs, which returns the
// same bits.
// provides: pixel_seed, sample_pair, unit2

fn pixel_seed(pixel: vec2u, seed: u32) -> u32 {
    return sampling_hash(pixel.x + sampling_hash(pixel.y + sampling_hash(seed)));
}

// A pair of random numbers, given as fractions of 2^32.
fn sample_pair(pixel_seed: u32, sample: u32, pair: u32) -> vec2u {
    let order = sampling_hash(pixel_seed ^ sampling_hash(pair));
    let across = sampling_hash(order);
    let down = sampling_hash(across);
    let index = reverseBits(scramble_reversed(reverseBits(vec2u(sample)), vec2u(order)).x);
    let point = vec2u(index, second_sobol_dimension(index));
    return reverseBits(scramble_reversed(point, vec2u(across, down)));
}

// Two numbers in [0, 1) from the upper 24 bits. The conversion is exact.
fn unit2(bits: vec2u) -> vec2f {
    return vec2f(bits >> vec2u(8u)) * 0x1p-24;
}

// A hash function, which is the output function of the PCG generator.
fn sampling_hash(x: u32) -> u32 {
    let state = x * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// Owen scrambling of fractions whose bits are reversed.
fn scramble_reversed(fractions: vec2u, seeds: vec2u) -> vec2u {
    var x = fractions;
    x ^= x * 0x3d20adeau;
    x = (x + seeds) * ((seeds >> vec2u(16u)) | vec2u(1u));
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// The second dimension of the Sobol sequence with reversed bits, which is the product of the index with Pascal's
// triangle modulo 2.
fn second_sobol_dimension(index: u32) -> u32 {
    var x = index;
    x ^= (x & 0xaaaaaaaau) >> 1u;
    x ^= (x & 0xccccccccu) >> 2u;
    x ^= (x & 0xf0f0f0f0u) >> 4u;
    x ^= (x & 0xff00ff00u) >> 8u;
    return x ^ (x >> 16u);
}
