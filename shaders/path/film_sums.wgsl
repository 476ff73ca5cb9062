// Sums of the samples of a pixel, of three vectors each: pixel by pixel, and in each
//   colour and opacity,
//   what rounding left out of the colour, and out of the sum of the squares of luminances,
//   the first surface's colour, and the squares of luminances.
// provides: Sum, film, plus
// needs: fence, fence3

// Pixel by pixel, the three vectors of its sums.
@group(0) @binding(5) var<storage, read_write> film: array<vec4f>;

struct Sum {
    value: vec4f,
    // What rounding has left out of it.
    rest: vec4f,
}

fn fence4(v: vec4f) -> vec4f {
    return vec4f(fence3(v.xyz), fence(v.w));
}

// Knuth, The Art of Computer Programming, volume 2, section 4.2.2, theorem B: what a sum of two numbers leaves out.
fn plus(sum: Sum, more: vec4f) -> Sum {
    let value = fence4(sum.value + more);
    let part = fence4(value - sum.value);
    let lost = fence4(sum.value - fence4(value - part)) + fence4(more - part);
    return Sum(value, fence4(sum.rest + fence4(lost)));
}
