// Operations with other legal results than the nearest ones, chosen by a hash of their operands. Each computes the
// result of the device, which is assumed to be the nearest number, and may then step to the neighbour on the other side
// of the exact result. The host declares MODE, the index of a `Rounding`; SEED; and FAULT, the number of ULP by which
// results are off instead, if it is not 0.

const ADV_SIGN: u32 = 0x80000000u;
const ADV_EXPONENT: u32 = 0x7f800000u;

// Whether results step at random, if the magnitude then grows, by their sign, and the other way round. Each is 0 or 1.
var<private> adv_random: u32;
var<private> adv_grow: u32;
var<private> adv_sign: u32;
var<private> adv_flip: u32;

fn adv_hash(a: u32, b: u32) -> u32 {
    return (((a + SEED) * 0x9e3779b1u) ^ b) * 0x85ebca77u;
}

// Chooses how an invocation rounds: as MODE says, or each in its own way.
fn adv_begin(invocation: u32) {
    let own = adv_hash(invocation, 0x51ed270bu) >> 29u;
    let mode = select(MODE, select(0u, own - 3u, own > 3u), MODE == 5u);
    adv_random = select(0u, 1u, mode == 0u);
    adv_grow = 1u - adv_random;
    adv_sign = select(0u, 1u, mode == 1u || mode == 2u);
    adv_flip = select(0u, 1u, mode == 2u || mode == 4u);
}

// The neighbour of a rounded result, where the exact magnitude is greater (1) or not, or the result.
fn adv_neighbour(bits: u32, is_inexact: bool, grows: u32, hash: u32) -> u32 {
    if (FAULT != 0u) {
        let off = select(0u - FAULT, FAULT, hash >= ADV_SIGN);
        return select(bits + off, bits, (bits & ADV_EXPONENT) < 0x10000000u);
    }
    let wants = ((hash >> 31u) & adv_random) ^ (grows & adv_grow) ^ ((bits >> 31u) & adv_sign) ^ adv_flip;
    return bits + select(0u, 2u * grows - 1u, is_inexact && wants != 0u);
}

fn adv_add(a: f32, b: f32) -> f32 {
    let is_less = abs(a) < abs(b);
    let sum = fence(a + b);
    // The rounding error of a sum, exactly (Dekker, 1971).
    let lost = select(b, a, is_less) - fence(sum - select(a, b, is_less));
    let bits = bitcast<u32>(sum);
    let grows = 1u - ((bits ^ bitcast<u32>(lost)) >> 31u);
    return bitcast<f32>(adv_neighbour(bits, lost != 0.0, grows, adv_hash(bitcast<u32>(a), bitcast<u32>(b))));
}

// What a rounded product has lost: the bits that were dropped, from the highest bit on, whether it was rounded up, and
// how many they were. Nothing is known where a factor or the product is subnormal.
struct AdvLost {
    bits: u32,
    is_rounded_up: bool,
    count: u32,
}

fn adv_lost(a: u32, b: u32, product: u32) -> AdvLost {
    // The lower 32 of 48 bits.
    let bits = ((a & 0x7fffffu) | 0x800000u) * ((b & 0x7fffffu) | 0x800000u);
    // The exponents tell whether the product of the significands is below 2.
    let count = 24u - (((a ^ b ^ product) >> 23u) & 1u);
    let lost = bits << (32u - count);
    let smallest = min(min(a & ADV_EXPONENT, b & ADV_EXPONENT), product & ADV_EXPONENT);
    // A tie is rounded to even.
    let is_rounded_up = lost + ((bits >> count) & 1u) > ADV_SIGN;
    return AdvLost(select(lost, 0u, smallest == 0u), is_rounded_up, count);
}

fn adv_mul(a: f32, b: f32) -> f32 {
    let product = bitcast<u32>(a * b);
    let lost = adv_lost(bitcast<u32>(a), bitcast<u32>(b), product);
    let hash = adv_hash(bitcast<u32>(a), bitcast<u32>(b));
    let bits = adv_neighbour(product, lost.bits != 0u, select(1u, 0u, lost.is_rounded_up), hash);
    // Subnormal numbers may become zero.
    let is_flushed = (bits & ADV_EXPONENT) == 0u && (hash & 0x40000000u) != 0u;
    return bitcast<f32>(select(bits, bits & ADV_SIGN, is_flushed));
}

// The fused product and sum: the sum of both and of what the product has lost.
fn adv_fma(a: f32, b: f32, c: f32) -> f32 {
    let product = fence(a * b);
    let lost = adv_lost(bitcast<u32>(a), bitcast<u32>(b), bitcast<u32>(product));
    let sign = (bitcast<u32>(a) ^ bitcast<u32>(b)) & ADV_SIGN;
    let exponent = i32((bitcast<u32>(a) & ADV_EXPONENT) >> 23u) + i32((bitcast<u32>(b) & ADV_EXPONENT) >> 23u) - 173;
    // Where the unit would be subnormal, it is left out: products and sums need not be fused.
    let unit = bitcast<f32>(select(0u, (u32(exponent) << 23u) | sign, exponent > 0 && exponent < 255));
    let rest = lost.bits >> (32u - lost.count);
    let part = f32(i32(rest) - select(0, 1 << lost.count, lost.is_rounded_up && lost.bits != 0u)) * unit;
    let sum = fence(product + c);
    let is_less = abs(product) < abs(c);
    let left = fence(select(c, product, is_less) - fence(sum - select(product, c, is_less)));
    return fence(sum + fence(left + fence(part)));
}
