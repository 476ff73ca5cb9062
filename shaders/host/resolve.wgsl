// Writes the means of the sums of a tile's pixels to the host's colour texture.
// dispatched: for all pixels of a tile, when a recording has completed samples of them.
// provides: resolve
// needs: WORKGROUP_SIDE, dispatch, film, frame, mean_of, start_fences, write_with_alpha

@compute @workgroup_size(WORKGROUP_SIDE, WORKGROUP_SIDE)
fn resolve(@builtin(global_invocation_id) invocation: vec3u) {
    start_fences();
    let pixel = invocation.xy;
    if (any(pixel >= frame.tile_size)) {
        return;
    }
    let index = pixel.y * frame.tile_size.x + pixel.x;
    let sum = film[3u * index];
    let rest = film[3u * index + 1u];
    // Number of samples.
    let count = dispatch.sample;
    let color = vec3f(
        mean_of(sum.r, rest.r, count),
        mean_of(sum.g, rest.g, count),
        mean_of(sum.b, rest.b, count),
    );
    write_with_alpha(frame.tile_origin + pixel, color, clamp(mean_of(sum.a, 0.0, count), 0.0, 1.0));
}
