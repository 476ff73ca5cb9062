// Sine and cosine of an angle in turns. The error of WGSL's built-in functions may be 2^-11.
// provides: sin_cos_turns
// needs: fence

// Sine and cosine of an angle of up to 2^20 turns, with an error of less than 2^-22. Twin: `f64::sin_cos`.
fn sin_cos_turns(turns: f32) -> vec2f {
    // The nearest quarter turn, and the exact remainder, which is at most an eighth of a turn.
    let quarter = floor(4.0 * turns + 0.5);
    let rest = fence(turns - 0.25 * quarter);
    let square = fence(rest * rest);
    // Minimax polynomials (Remez) on [0, 1/64], with errors of at most 2^-28.
    let sine = fence(rest * (6.2831855 + square * (-41.341663 + square * (81.59235
        + square * -75.39356))));
    let cosine = fence(1.0 + square * (-19.739208 + square * (64.93931
        + square * (-85.4423 + square * 59.202797))));
    let which = u32(i32(quarter)) & 3u;
    let ordered = select(vec2f(sine, cosine), vec2f(cosine, sine), (which & 1u) != 0u);
    return select(ordered, -ordered, (vec2u(which, which + 1u) & vec2u(2u)) != vec2u(0u));
}
