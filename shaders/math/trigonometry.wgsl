// Sine and cosine with small errors, for cameras. The built-in functions of WGSL are only accurate to 2^-11. The error
// bounds are in src/verify/camera/round.rs.
// provides: PI, sin_cos_eighth, sin_cos_half_turns
// needs: fence

const PI: f32 = 3.14159265358979;

// Sine and cosine of an angle of at most an eighth of a turn, pi/4, by their series. The truncation error is below 2e-9
// for the sine and 1.2e-10 for the cosine.
fn sin_cos_eighth(angle: f32) -> vec2f {
    let z = fence(angle * angle);
    let sine = z * (-1.0 / 6.0 + z * (1.0 / 120.0 + z * (-1.0 / 5040.0 + z * (1.0 / 362880.0))));
    let cosine = z * (-0.5 + z * (1.0 / 24.0 + z * (-1.0 / 720.0
        + z * (1.0 / 40320.0 + z * (-1.0 / 3628800.0)))));
    return vec2f(fence(angle + fence(angle * sine)), fence(1.0 + fence(cosine)));
}

// Sine and cosine of an angle of at most a few half turns. Subtracting the nearest quarter turn is exact.
fn sin_cos_half_turns(half_turns: f32) -> vec2f {
    let quarters = round(2.0 * half_turns);
    let rest = fence(half_turns - 0.5 * quarters);
    let first = sin_cos_eighth(fence(PI * rest));
    let quadrant = i32(quarters);
    let turned = select(first, vec2f(first.y, -first.x), (quadrant & 1) != 0);
    return select(turned, -turned, (quadrant & 2) != 0);
}
