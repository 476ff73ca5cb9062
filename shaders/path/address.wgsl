// Which pixel and which of its samples a path is of.
// provides: address_of
// needs: dispatch, frame, quotient

struct Address {
    // In the film.
    pixel: vec2u,
    sample: u32,
}

fn address_of(index: u32) -> Address {
    let size = frame.tile_size;
    let row = quotient(index, size.x);
    let turn = quotient(row, size.y);
    let pixel = vec2u(index - row * size.x, row - turn * size.y);
    return Address(frame.tile_origin + pixel, dispatch.sample + turn);
}
