// The pixel that an invocation renders.
// provides: pixel_in_tile, quotient
// needs: WORKGROUP_SIDE, frame

// A workgroup renders 8x8 pixels. Its lanes follow a Z-order curve, so that the 8 or 32 lanes that run together are
// close to each other. The host chooses the order of the rows of workgroups: software devices give each thread a
// contiguous run of workgroups, and none of them should get only background.
fn pixel_in_tile(group: vec2u, lane: u32) -> vec2u {
    let ordinal = (frame.first_group.y + group.y) * frame.row_step;
    let row = remainder(ordinal, frame.traced_size.y);
    let in_group = vec2u(every_second_bit(lane), every_second_bit(lane >> 1u));
    let group_in_tile = frame.traced_first + vec2u(frame.first_group.x + group.x, row);
    return group_in_tile * WORKGROUP_SIDE + in_group;
}

// a % b for a less than 2^24. It avoids integer division, which software devices perform lane by lane.
fn remainder(a: u32, b: u32) -> u32 {
    // The quotient may be too large by one, and the rest is then negative, or too small by one.
    let rest = i32(a) - i32(f32(a) / f32(b)) * i32(b);
    let raised = select(rest, rest + i32(b), rest < 0);
    return u32(select(raised, raised - i32(b), raised >= i32(b)));
}

// a / b for a less than 2^24.
fn quotient(a: u32, b: u32) -> u32 {
    let near = i32(f32(a) / f32(b));
    let rest = i32(a) - near * i32(b);
    return u32(near + select(0, 1, rest >= i32(b)) - select(0, 1, rest < 0));
}

// Three bits of a lane's index: bits 0, 2 and 4.
fn every_second_bit(lane: u32) -> u32 {
    return (lane & 1u) | ((lane >> 1u) & 2u) | ((lane >> 2u) & 4u);
}
