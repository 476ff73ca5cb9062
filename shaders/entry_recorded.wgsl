// The ray of a pixel, made where it is used, and kept for src/verify.

// Two a pixel: origin and distance; direction, and 1 for a ray that misses the scene's box or 2 for one that meets it.
@group(0) @binding(3) var<storage, read_write> rays: array<vec4f>;

fn entry_of(pixel_in_tile: vec2u) -> Entry {
    let entry = make_entry(pixel_in_tile);
    let first = 2u * hit_index(pixel_in_tile);
    rays[first] = vec4f(entry.ray.origin, entry.distance);
    rays[first + 1u] = vec4f(entry.ray.direction, select(1.0, 2.0, entry.is_inside));
    return entry;
}
