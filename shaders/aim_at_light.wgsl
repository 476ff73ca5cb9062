// In a studio, lights are no spheres.

fn aim(index: u32) -> vec4f {
    return vec4f(0.0);
}
