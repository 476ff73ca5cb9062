// How much the samples of some pixels vary: sums over every 64th pixel of the tile, each workgroup's 64 lanes 64
// pixels each.
// dispatched: when the host asks for the noise, one invocation for 64 pixels.
// provides: noise
// needs: dispatch, film, frame, luminance, start_fences

// The variance of pixels' means, and their luminance.
@group(0) @binding(6) var<storage, read_write> variations: array<vec2f>;

@compute @workgroup_size(64)
fn noise(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let pixels = frame.tile_size.x * frame.tile_size.y;
    let n = f32(dispatch.sample);
    var found = vec2f(0.0);
    let first = group.x * 4096u + lane;
    for (var turn = 0u; turn < 64u; turn++) {
        let pixel = min(first + turn * 64u, pixels - 1u);
        let light = luminance(film[3u * pixel].rgb) / n;
        let square = film[3u * pixel + 2u].w / n;
        let variance = max(square - light * light, 0.0) / max(n - 1.0, 1.0);
        found += select(vec2f(variance, light), vec2f(0.0), first + turn * 64u >= pixels);
    }
    variations[group.x * 64u + lane] = found;
}
