// Operations whose results may be off by several ULP. The host declares DIVIDE_STEPS and ROOT_STEPS, by how many numbers
// a result is moved at most, which is half an ULP off before.

// A result that is off by up to some steps, but not into the numbers whose steps are twice as long.
fn adv_steps(value: f32, most: u32, hash: u32) -> f32 {
    let bits = bitcast<u32>(value);
    let any = i32(((hash >> 16u) * (2u * most + 1u)) >> 16u) - i32(most);
    let is_down = (((bits >> 31u) & adv_sign) ^ adv_flip) != 0u;
    var steps = select(select(i32(most), -i32(most), is_down), any, adv_random != 0u);
    if (FAULT != 0u) {
        steps = select(-i32(FAULT), i32(FAULT), hash >= ADV_SIGN);
    }
    let moved = bits + u32(steps);
    let is_small = (bits & ADV_EXPONENT) < 0x01000000u;
    let is_beyond = (moved & ADV_EXPONENT) > (bits & ADV_EXPONENT);
    return bitcast<f32>(select(moved, bits, is_small || is_beyond));
}

fn adv_div(a: f32, b: f32) -> f32 {
    return adv_steps(a / b, DIVIDE_STEPS, adv_hash(bitcast<u32>(a), bitcast<u32>(b) ^ 1u));
}

// The product with the inverse, which compilers put in place of a quotient.
fn adv_div_inverse(a: f32, b: f32) -> f32 {
    return adv_mul(a, adv_div(1.0, b));
}

fn adv_sqrt(a: f32) -> f32 {
    return adv_steps(sqrt(a), ROOT_STEPS, adv_hash(bitcast<u32>(a), 2u));
}

// The device's own exponential may be as far off as it may, but for one step.
fn adv_exp(a: f32) -> f32 {
    return adv_steps(exp(a), 1u, adv_hash(bitcast<u32>(a), 4u));
}

fn adv_pow(a: f32, b: f32) -> f32 {
    return adv_steps(pow(a, b), 1u, adv_hash(bitcast<u32>(a), bitcast<u32>(b) ^ 5u));
}
