// Sums the variances of pixels' means and their luminances, to measure the noise of a picture. Each of the 64 lanes of
// a workgroup sums 64 pixels that are 64 pixels apart.
// dispatched: when the host measures the noise, with one invocation for 64 pixels.
// provides: noise
// needs: dispatch, film, frame, luminance, start_fences

// Sums of the variances of pixels' means and of their luminances.
@group(0) @binding(6) var<storage, read_write> variations: array<vec2f>;

@compute @workgroup_size(64)
fn noise(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let pixels = frame.tile_size.x * frame.tile_size.y;
    let n = f32(dispatch.sample);
    var found = vec2f(0.0);
    let first = group.x * 4096u + lane;
    for (var i = 0u; i < 64u; i++) {
        let pixel = min(first + i * 64u, pixels - 1u);
        let light = luminance(film[3u * pixel].rgb) / n;
        let square = film[3u * pixel + 2u].w / n;
        let variance = max(square - light * light, 0.0) / max(n - 1.0, 1.0);
        found += select(vec2f(variance, light), vec2f(0.0), first + i * 64u >= pixels);
    }
    variations[group.x * 64u + lane] = found;
}
