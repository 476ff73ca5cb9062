// Where samples lie around their pixel's centre. Twin: `offset` in src/camera/filter.rs. A kernel gives the table, of 257
// numbers: `fn filter_table(index: u32) -> f32`.
// provides: filter_offset
// needs: fence, filter_table

// In pixels, for two fractions of 2^32.
fn filter_offset(u: vec2u) -> vec2f {
    return vec2f(filter_offset_along(u.x), filter_offset_along(u.y));
}

fn filter_offset_along(u: u32) -> f32 {
    let low = filter_table(u >> 24u);
    let high = filter_table((u >> 24u) + 1u);
    let fraction = f32((u >> 8u) & 0xffffu) * 0x1p-16;
    return fence(low + fence(fraction * fence(high - low)));
}
