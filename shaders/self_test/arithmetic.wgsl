// Computes operations whose results may be rounded.
// dispatched: by the self-test, with one invocation for each input.
// provides: arithmetic
// needs: fence, fence3

struct Operands {
    // |a| >= |b|.
    a: f32,
    b: f32,
    // A number close to -p.
    p: f32,
    q: f32,
    factor: f32,
    dividend: f32,
    divisor: f32,
    radicand: f32,
    u: vec3f,
    v: vec3f,
}

struct Arithmetic {
    sum: f32,
    back: f32,
    error: f32,
    unfenced_error: f32,
    scaled: f32,
    difference: f32,
    product: f32,
    quotient: f32,
    root: f32,
    inverse_root: f32,
    dot: f32,
}

// Inputs, with one struct for each invocation.
@group(0) @binding(1) var<storage, read> operands: array<Operands>;
// Results of the device, with one struct for each invocation.
@group(0) @binding(2) var<storage, read_write> answers: array<Arithmetic>;

@compute @workgroup_size(64)
fn arithmetic(@builtin(global_invocation_id) invocation: vec3u) {
    let o = operands[invocation.x];
    var answer: Arithmetic;
    // TwoSum, whose last line is the rounding error of the sum (Knuth, The Art of Computer Programming 2, 4.2.2).
    answer.sum = fence(o.a + o.b);
    answer.back = fence(answer.sum - o.a);
    answer.error = fence(fence(o.a - fence(answer.sum - answer.back)) + fence(o.b - answer.back));
    // The same without fences, which an optimiser may replace by zero.
    let sum = o.a + o.b;
    let back = sum - o.a;
    answer.unfenced_error = (o.a - (sum - back)) + (o.b - back);
    // An optimiser might replace this sum by (p + q) * factor.
    let products = fence3(vec3f(o.p, o.q, o.a) * vec3f(o.factor, o.factor, o.b));
    answer.scaled = fence(products.x + products.y);
    answer.difference = fence(o.a - o.b);
    answer.product = products.z;
    answer.quotient = o.dividend / o.divisor;
    answer.root = sqrt(o.radicand);
    // The argument is never zero, to avoid infinities.
    answer.inverse_root = inverseSqrt(select(o.radicand, 1.0, o.radicand == 0.0));
    answer.dot = fence(dot(o.u, o.v));
    answers[invocation.x] = answer;
}
