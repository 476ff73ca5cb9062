// Absorption of light between two surfaces, by Beer's law. Only glass absorbs any.
// provides: load_medium, store_medium, transmittance
// needs: ANY_MATERIALS, MEDIUM, load, store

fn load_medium(index: u32) -> vec3f {
    var medium = vec3f(0.0);
    if (ANY_MATERIALS) {
        medium = load(index, MEDIUM).xyz;
    }
    return medium;
}

fn store_medium(index: u32, medium: vec3f) {
    if (ANY_MATERIALS) {
        store(index, MEDIUM, vec4f(medium, 0.0));
    }
}

fn transmittance(medium: vec3f, distance: f32) -> vec3f {
    var share = vec3f(1.0);
    if (ANY_MATERIALS) {
        share = exp(-medium * distance);
    }
    return share;
}
