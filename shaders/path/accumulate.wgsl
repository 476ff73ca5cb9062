// Adds the samples in flight of every pixel to the sums of the pixel. They are added one after another, so that the
// sums do not depend on the number of samples in flight.
// dispatched: once for all pixels of a tile, after all surfaces.
// provides: accumulate
// needs: FIRST, NO_PATH, dispatch, frame, load, load_sums, path_of, radiance_so_far, start_fences, store_sums,
//   with_sample

@compute @workgroup_size(64)
fn accumulate(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    start_fences();
    let pixel = path_of(group, lane);
    if (pixel == NO_PATH) {
        return;
    }
    let pixels = frame.tile_size.x * frame.tile_size.y;
    var sums = load_sums(pixel);
    for (var i = 0u; i < dispatch.count; i++) {
        let index = i * pixels + pixel;
        sums = with_sample(sums, radiance_so_far(index), load(index, FIRST).rgb);
    }
    store_sums(pixel, sums);
}
