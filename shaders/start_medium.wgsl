// Nothing absorbs light yet.

fn start_medium(index: u32) {
    store(index, MEDIUM, vec4f(0.0));
}
