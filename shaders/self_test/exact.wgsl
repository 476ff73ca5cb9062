// Computes operations whose results must be exact, and subnormal numbers, which a device may flush to zero.
// dispatched: by the self-test, with one invocation for each input.
// provides: exact
// needs: fence

struct Values {
    // A number with an absolute value below 2^31.
    f: f32,
    g: f32,
    // An integer that f32 represents exactly.
    whole: u32,
    i: u32,
    j: u32,
    // Normal numbers whose difference is subnormal, as is the product of `small` and `scale`.
    small: f32,
    other: f32,
    scale: f32,
    // Subnormal numbers whose sum is subnormal.
    tiny: f32,
    speck: f32,
}

struct Exact {
    from_whole: f32,
    truncated: i32,
    unsigned: u32,
    floored: f32,
    smaller: f32,
    larger: f32,
    selected: f32,
    // The result of each comparison, in one bit.
    comparisons: u32,
    bits: u32,
    from_bits: f32,
    added: u32,
    subtracted: u32,
    multiplied: u32,
    divided: u32,
    remainder: u32,
    shifted_left: u32,
    shifted_right: u32,
    ones: u32,
    lowest: u32,
    tiny_difference: f32,
    tiny_product: f32,
    tiny_sum: f32,
}

// Inputs, with one struct for each invocation.
@group(0) @binding(1) var<storage, read> values: array<Values>;
// Results of the device, with one struct for each invocation.
@group(0) @binding(2) var<storage, read_write> answers: array<Exact>;

fn bit(condition: bool, number: u32) -> u32 {
    return select(0u, 1u, condition) << number;
}

@compute @workgroup_size(64)
fn exact(@builtin(global_invocation_id) invocation: vec3u) {
    let v = values[invocation.x];
    var answer: Exact;
    answer.from_whole = f32(v.whole);
    answer.truncated = i32(v.f);
    answer.unsigned = u32(max(v.f, 0.0));
    answer.floored = floor(v.f);
    answer.smaller = min(v.f, v.g);
    answer.larger = max(v.f, v.g);
    answer.selected = select(v.f, v.g, v.i < v.j);
    answer.comparisons = bit(v.f < v.g, 0u) | bit(v.f <= v.g, 1u) | bit(v.f == v.g, 2u)
        | bit(v.f != v.g, 3u) | bit(v.f >= v.g, 4u) | bit(v.f > v.g, 5u);
    answer.bits = bitcast<u32>(v.f) + 1u;
    answer.from_bits = bitcast<f32>(bitcast<u32>(v.g) ^ 0x80000000u);
    answer.added = v.i + v.j;
    answer.subtracted = v.i - v.j;
    answer.multiplied = v.i * v.j;
    answer.divided = v.i / v.j;
    answer.remainder = v.i % v.j;
    answer.shifted_left = v.i << (v.j & 31u);
    answer.shifted_right = v.i >> (v.j & 31u);
    answer.ones = countOneBits(v.i);
    answer.lowest = firstTrailingBit(v.i);
    answer.tiny_difference = fence(v.small - v.other);
    answer.tiny_product = fence(v.small * v.scale);
    answer.tiny_sum = fence(v.tiny + v.speck);
    answers[invocation.x] = answer;
}
