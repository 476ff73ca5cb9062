// Relative location of a sample on the film, in [-1, 1]^2 or slightly outside. The offset from the centre of the pixel
// is in pixels to the right and down.
// provides: sample_location
// needs: fence, frame

fn sample_location(pixel_in_film: vec2u, offset: vec2f) -> vec2f {
    let size = vec2i(frame.film_size);
    let doubled = vec2i(pixel_in_film) * 2 + 1 - size;
    let location = (vec2f(doubled) + 2.0 * offset) / vec2f(size);
    return vec2f(fence(location.x), fence(-frame.y_sign * location.y));
}
