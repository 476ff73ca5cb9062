// Glass absorbs light on the way (Beer's law).

fn load_medium(index: u32) -> vec3f {
    return load(index, MEDIUM).xyz;
}

fn store_medium(index: u32, medium: vec3f) {
    store(index, MEDIUM, vec4f(medium, 0.0));
}

fn kept_by(medium: vec3f, distance: f32) -> vec3f {
    return exp(-medium * distance);
}
