// The ray of a pixel as the first brick had it: another kernel's might differ in the last bit.

@group(0) @binding(3) var<storage, read_write> rays: array<vec4f>;

fn entry_of(pixel_in_tile: vec2u) -> Entry {
    let first = 2u * hit_index(pixel_in_tile);
    let origin = rays[first];
    let direction = rays[first + 1u].xyz;
    let made = enter_scene(camera_ray(relative_location(frame.tile_origin + pixel_in_tile)));
    return Entry(Ray(origin.xyz, direction), inverse_direction(direction), origin.w, made.is_inside);
}
