// Adds a sample of every pixel to what the pixel has.

// Colour and opacity; the first surface's colour, and the square of the luminance: sums.
@group(0) @binding(5) var<storage, read_write> film: array<vec4f>;

@compute @workgroup_size(64)
fn deposit(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    zero_bits = frame.zero;
    let pixel = pixel_in_tile(group.xy, lane);
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let index = hit_index(pixel);
    let sample = settled(index);
    let light = dot(sample.rgb, vec3f(0.2126, 0.7152, 0.0722));
    film[2u * index] += sample;
    film[2u * index + 1u] += vec4f(load(index, FIRST).rgb, light * light);
}
