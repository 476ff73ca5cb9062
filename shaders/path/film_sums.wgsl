// The sums over a pixel's samples. Each pixel has three vectors:
//   colour and opacity,
//   the rounding errors of the sums of colour and of squared luminance,
//   the albedo of the first surface, and the squared luminance.
// provides: Sum, film, plus
// needs: fence, fence3

// Sums of the pixels, with three vectors for each pixel.
@group(0) @binding(5) var<storage, read_write> film: array<vec4f>;

struct Sum {
    value: vec4f,
    // Accumulated rounding error of `value`.
    rest: vec4f,
}

fn fence4(v: vec4f) -> vec4f {
    return vec4f(fence3(v.xyz), fence(v.w));
}

// Adds a number to a sum and keeps the rounding error (Knuth, The Art of Computer Programming, volume 2, section 4.2.2,
// theorem B).
fn plus(sum: Sum, more: vec4f) -> Sum {
    let value = fence4(sum.value + more);
    let part = fence4(value - sum.value);
    let lost = fence4(sum.value - fence4(value - part)) + fence4(more - part);
    return Sum(value, fence4(sum.rest + fence4(lost)));
}
