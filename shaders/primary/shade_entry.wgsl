// The ray of a pixel with which its hit is shaded.

//// made
// The ray of a pixel, computed again where its hit is shaded, because storing it would take longer.
// provides: shade_entry
// needs: Entry, make_entry

fn shade_entry(pixel_in_tile: vec2u) -> Entry {
    return make_entry(pixel_in_tile);
}

//// recorded
// The ray of a pixel, computed again where its hit is shaded, and recorded for src/verify.
// provides: shade_entry
// needs: Entry, hit_index, make_entry

// Rays with four vectors for each pixel, of which the last two are of this ray: origin and distance; direction, and 1 if
// the ray misses the scene's box or 2 if it hits the box.
@group(0) @binding(3) var<storage, read_write> rays: array<vec4f>;

fn shade_entry(pixel_in_tile: vec2u) -> Entry {
    let entry = make_entry(pixel_in_tile);
    let first = 4u * hit_index(pixel_in_tile) + 2u;
    rays[first] = vec4f(entry.ray.origin, entry.distance);
    rays[first + 1u] = vec4f(entry.ray.direction, select(1.0, 2.0, entry.is_inside));
    return entry;
}
