// The ray of a pixel from the point where it enters the scene's box.

//// made
// The ray of a pixel, computed where it is used.
// provides: entry_of
// needs: Entry, make_entry

fn entry_of(pixel_in_tile: vec2u) -> Entry {
    return make_entry(pixel_in_tile);
}

//// recorded
// The ray of a pixel, computed where it is used, and recorded for src/verify. Later bricks take the ray that the first
// recorded: another pipeline might compute a ray that differs in the last bit.
// provides: entry_of
// needs: Entry, IS_LATER_BRICK, Ray, hit_index, inverse_direction, make_entry

// Rays with four vectors for each pixel, of which the first two are of this ray: origin and distance; direction, and 1
// if the ray misses the scene's box or 2 if it hits the box.
@group(0) @binding(3) var<storage, read_write> rays: array<vec4f>;

fn entry_of(pixel_in_tile: vec2u) -> Entry {
    let first = 4u * hit_index(pixel_in_tile);
    var entry: Entry;
    if (IS_LATER_BRICK) {
        let origin = rays[first];
        let direction = rays[first + 1u];
        let inverse = inverse_direction(direction.xyz);
        entry = Entry(Ray(origin.xyz, direction.xyz), inverse, origin.w, direction.w > 1.5);
    } else {
        entry = make_entry(pixel_in_tile);
        rays[first] = vec4f(entry.ray.origin, entry.distance);
        rays[first + 1u] = vec4f(entry.ray.direction, select(1.0, 2.0, entry.is_inside));
    }
    return entry;
}

//// probed
// The ray of a pixel, computed where it is used. In place of the ray, the sum of two of its numbers is recorded, with
// its rounding error, for the self-test: whether fences hold in a kernel that traces.
// provides: entry_of
// needs: Entry, fence, hit_index, make_entry

// Two vectors for each pixel: a sum, the sum less its first term, the rounding error, and the same without fences; the
// two terms.
@group(0) @binding(3) var<storage, read_write> rays: array<vec4f>;

fn entry_of(pixel_in_tile: vec2u) -> Entry {
    let entry = make_entry(pixel_in_tile);
    let first = 2u * hit_index(pixel_in_tile);
    // TwoSum, as in self_test/arithmetic.wgsl, with |a| > |b|.
    let a = fence(4.0 + fence(entry.ray.origin.x));
    let b = fence(entry.ray.direction.x);
    let sum = fence(a + b);
    let back = fence(sum - a);
    let error = fence(fence(a - fence(sum - back)) + fence(b - back));
    let unfenced = (a - ((a + b) - ((a + b) - a))) + (b - ((a + b) - a));
    rays[first] = vec4f(sum, back, error, unfenced);
    rays[first + 1u] = vec4f(a, b, 0.0, 2.0);
    return entry;
}
