// Adds the samples in flight of every pixel to the sums of the pixel. They are added one after another, so that the
// sums do not depend on the number of samples in flight.
// dispatched: once for all pixels of a tile, after all surfaces.
// provides: accumulate
// needs: FIRST, NO_PATH, Sum, dispatch, film, frame, load, luminance, path_of, plus, radiance_so_far, start_fences

@compute @workgroup_size(64)
fn accumulate(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let pixel = path_of(group, lane);
    if (pixel == NO_PATH) {
        return;
    }
    let pixels = frame.tile_size.x * frame.tile_size.y;
    let color = film[3u * pixel];
    let rest = film[3u * pixel + 1u];
    let others = film[3u * pixel + 2u];
    var alpha = color.w;
    var albedo = others.rgb;
    // The sum of the colour and of the squared luminance.
    var sum = Sum(vec4f(color.rgb, others.w), rest);
    for (var i = 0u; i < dispatch.count; i++) {
        let index = i * pixels + pixel;
        let sample = radiance_so_far(index);
        let light = luminance(sample.rgb);
        sum = plus(sum, vec4f(sample.rgb, light * light));
        alpha += sample.w;
        albedo += load(index, FIRST).rgb;
    }
    film[3u * pixel] = vec4f(sum.value.rgb, alpha);
    film[3u * pixel + 1u] = sum.rest;
    film[3u * pixel + 2u] = vec4f(albedo, sum.value.w);
}
