// The sums over a pixel's samples. Each pixel has three vectors:
//   colour and opacity,
//   the rounding errors of the sums of colour and of squared luminance,
//   the albedo of the first surface, and the squared luminance.
// provides: film, load_sums, store_sums, with_sample
// needs: fence, fence3, luminance

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

// The sums of a pixel.
struct PixelSums {
    // Colour and squared luminance.
    sum: Sum,
    opacity: f32,
    albedo: vec3f,
}

fn load_sums(pixel: u32) -> PixelSums {
    let color = film[3u * pixel];
    let others = film[3u * pixel + 2u];
    return PixelSums(Sum(vec4f(color.rgb, others.w), film[3u * pixel + 1u]), color.w, others.rgb);
}

fn store_sums(pixel: u32, sums: PixelSums) {
    film[3u * pixel] = vec4f(sums.sum.value.rgb, sums.opacity);
    film[3u * pixel + 1u] = sums.sum.rest;
    film[3u * pixel + 2u] = vec4f(sums.albedo, sums.sum.value.w);
}

// Adds a sample, with its colour and opacity, and the albedo of its first surface.
fn with_sample(sums: PixelSums, radiance: vec4f, albedo: vec3f) -> PixelSums {
    let light = luminance(radiance.rgb);
    let sum = plus(sums.sum, vec4f(radiance.rgb, light * light));
    return PixelSums(sum, sums.opacity + radiance.w, sums.albedo + albedo);
}
