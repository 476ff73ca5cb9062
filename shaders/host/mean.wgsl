// The mean of a sum and its rounding errors, rounded to the nearest number. Twin: src/gpu/passes/lit/sums.rs.
// provides: mean_of
// needs: fence

// A quotient in f32 may be off by a few units in the last place. What is left over is computed exactly, from parts of at
// most 12 bits each (Dekker, A floating-point technique for extending the available precision, 1971), and corrects it.
// There are fewer than 2^24 samples.
fn mean_of(sum: f32, rest: f32, count: u32) -> f32 {
    let samples = f32(count);
    let quotient = fence(sum / samples);
    if (abs(quotient) > 1e37) {
        return quotient;
    }
    let high = bitcast<f32>(bitcast<u32>(quotient) & 0xfffff000u);
    let low = fence(quotient - high);
    let many = f32(count & 0xfffff000u);
    let few = f32(count & 0xfffu);
    let without_high = fence(fence(sum - fence(high * many)) - fence(high * few));
    let left = fence(fence(without_high - fence(low * many)) - fence(low * few));
    return quotient + fence(fence(left + rest) / samples);
}
