// Fences, which force a compiler to round a number at this place. WGSL allows compilers to reassociate sums and
// products, and some do. No compiler can simplify an exclusive or with a number that it does not know, which is 0, but as
// the difference of two numbers from a uniform that are not 0 (scene/frame.wgsl). The error bounds
// of src/verify depend on every fence, and `pinhole info --self-test` tests fences on a device.
// provides: fence, fence3
// needs: runtime_zero

fn fence(v: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(v) ^ runtime_zero());
}

fn fence3(v: vec3f) -> vec3f {
    return bitcast<vec3f>(bitcast<vec3u>(v) ^ vec3u(runtime_zero()));
}
