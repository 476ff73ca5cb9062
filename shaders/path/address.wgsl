// The pixel and the sample that a path belongs to.
// provides: address_of
// needs: dispatch, frame, quotient

struct Address {
    // Pixel of the film.
    pixel: vec2u,
    sample: u32,
}

fn address_of(index: u32) -> Address {
    let size = frame.tile_size;
    let row = quotient(index, size.x);
    let in_flight = quotient(row, size.y);
    let pixel = vec2u(index - row * size.x, row - in_flight * size.y);
    return Address(frame.tile_origin + pixel, dispatch.sample + in_flight);
}
