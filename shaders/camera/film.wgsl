// Relative location of a pixel's centre on the film, in [-1, 1]^2.
// provides: relative_location
// needs: fence, frame

fn relative_location(pixel_in_film: vec2u) -> vec2f {
    // (i + 1/2)/W * 2 - 1 = (2i + 1 - W)/W. The numerator is exact, so there is a single rounding.
    let size = vec2i(frame.film_size);
    let doubled = vec2i(pixel_in_film) * 2 + 1 - size;
    let location = vec2f(doubled) / vec2f(size);
    return vec2f(fence(location.x), fence(-frame.y_sign * location.y));
}
