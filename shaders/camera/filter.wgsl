// Offsets of samples from the centre of their pixel, distributed by the pixel filter. Twin: `offset` in
// src/camera/filter.rs. Another part provides the table of 257 numbers: `fn filter_table(index: u32) -> f32`.
// provides: filter_offset
// needs: fence, filter_table

// The offset in pixels for two random numbers, given as fractions of 2^32.
fn filter_offset(u: vec2u) -> vec2f {
    return vec2f(filter_offset_along(u.x), filter_offset_along(u.y));
}

fn filter_offset_along(u: u32) -> f32 {
    let low = filter_table(u >> 24u);
    let high = filter_table((u >> 24u) + 1u);
    let fraction = f32((u >> 8u) & 0xffffu) * 0x1p-16;
    return fence(low + fence(fraction * fence(high - low)));
}
