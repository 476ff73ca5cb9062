// Of a path: no light is looked for yet.

fn start_light(index: u32) {
    store(index, SHADOW, vec4f(0.0, 0.0, 1.0, 0.0));
    store(index, PENDING, vec4f(0.0));
}
