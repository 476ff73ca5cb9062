// The relative location, in [-1, 1]^2, of a pixel's centre.
// provides: relative_location
// needs: fence, frame

fn relative_location(pixel_in_film: vec2u) -> vec2f {
    // (i + 1/2)/W * 2 - 1 = (2i + 1 - W)/W, with an exact numerator: one rounding in all.
    let size = vec2i(frame.film_size);
    let doubled = vec2i(pixel_in_film) * 2 + 1 - size;
    let location = vec2f(doubled) / vec2f(size);
    return vec2f(fence(location.x), fence(-frame.y_sign * location.y));
}
