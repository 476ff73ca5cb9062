// The ray of a pixel as the first brick had it: another kernel's might differ in the last bit.

@group(0) @binding(3) var<storage, read_write> rays: array<vec4f>;

fn entry_of(pixel_in_tile: vec2u) -> Entry {
    let first = 2u * hit_index(pixel_in_tile);
    let origin = rays[first];
    let direction = rays[first + 1u];
    let inverse = inverse_direction(direction.xyz);
    return Entry(Ray(origin.xyz, direction.xyz), inverse, origin.w, direction.w > 1.5);
}
