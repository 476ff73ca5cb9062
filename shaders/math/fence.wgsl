// A number that is rounded where it stands: WGSL lets compilers reassociate sums and products, and some do.
// None can see through an exclusive or with a number that it does not know. What bounds the error of a
// picture, in src/verify, counts on each of these; `pinhole info --self-test` tests them on a device.
// provides: fence, fence3
// needs: runtime_zero

fn fence(v: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(v) ^ runtime_zero());
}

fn fence3(v: vec3f) -> vec3f {
    return bitcast<vec3f>(bitcast<vec3u>(v) ^ vec3u(runtime_zero()));
}
