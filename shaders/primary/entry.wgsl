// The ray of a pixel from the point where it enters the scene's box.

//// made
// The ray of a pixel, computed where it is used.
// provides: entry_of
// needs: Entry, make_entry

fn entry_of(pixel_in_tile: vec2u) -> Entry {
    return make_entry(pixel_in_tile);
}

//// recorded
// The ray of a pixel, computed where it is used, and recorded for src/verify.
// provides: entry_of
// needs: Entry, hit_index, make_entry

// Rays with four vectors for each pixel, of which the first two are of this ray: origin and distance; direction, and 1
// if the ray misses the scene's box or 2 if it hits the box.
@group(0) @binding(3) var<storage, read_write> rays: array<vec4f>;

fn entry_of(pixel_in_tile: vec2u) -> Entry {
    let entry = make_entry(pixel_in_tile);
    let first = 4u * hit_index(pixel_in_tile);
    rays[first] = vec4f(entry.ray.origin, entry.distance);
    rays[first + 1u] = vec4f(entry.ray.direction, select(1.0, 2.0, entry.is_inside));
    return entry;
}

//// replayed
// The ray of a pixel as the kernel of the first brick recorded it. Another kernel might compute a ray that differs in
// the last bit.
// provides: entry_of
// needs: Entry, Ray, hit_index, inverse_direction

// Rays as in the variant `recorded`.
@group(0) @binding(3) var<storage, read_write> rays: array<vec4f>;

fn entry_of(pixel_in_tile: vec2u) -> Entry {
    let first = 4u * hit_index(pixel_in_tile);
    let origin = rays[first];
    let direction = rays[first + 1u];
    let inverse = inverse_direction(direction.xyz);
    return Entry(Ray(origin.xyz, direction.xyz), inverse, origin.w, direction.w > 1.5);
}
