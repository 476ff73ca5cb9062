// The colour of a pixel as the host's target takes it.
// provides: color_for_host

// How the colour is turned into that of the target.
override ENCODING: u32;
const AS_STORED: u32 = 0u;
const TO_LINEAR: u32 = 1u;
const TO_SRGB: u32 = 2u;

fn color_for_host(color: vec3f) -> vec3f {
    var turned = color;
    if (ENCODING == TO_LINEAR) {
        turned = linear_of(color);
    }
    if (ENCODING == TO_SRGB) {
        turned = srgb_of(color);
    }
    return turned;
}

// The inverse transfer function of sRGB, IEC 61966-2-1. Its power is replaced by the polynomial with the least relative
// error, 1.1e-4, because powers take a software device several times as long. Colours have eight bits, and the error is
// less than a hundredth of the difference between two of them.
fn linear_of(color: vec3f) -> vec3f {
    var power = vec3f(-0.12352837);
    power = power * color + 0.41711057;
    power = power * color - 0.63052071;
    power = power * color + 0.81013801;
    power = power * color + 0.49075403;
    power = power * color + 0.03508037;
    power = power * color + 0.00085719915;
    return select(power, color / 12.92, color <= vec3f(0.04045));
}

// The transfer function of sRGB, IEC 61966-2-1.
fn srgb_of(color: vec3f) -> vec3f {
    let light = clamp(color, vec3f(0.0), vec3f(1.0));
    // Below the threshold the power is not used. The maximum keeps its base away from zero.
    let power = 1.055 * pow(max(light, vec3f(0.0031308)), vec3f(1.0 / 2.4)) - 0.055;
    return select(power, light * 12.92, light <= vec3f(0.0031308));
}
