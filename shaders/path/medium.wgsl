// Absorption of light between two surfaces.

//// none
// Variant for scenes without glass, in which light is not absorbed between surfaces.
// provides: load_medium, store_medium, transmittance

fn load_medium(index: u32) -> vec3f {
    return vec3f(0.0);
}

fn store_medium(index: u32, medium: vec3f) {}

fn transmittance(medium: vec3f, distance: f32) -> vec3f {
    return vec3f(1.0);
}

//// glass
// Variant for scenes with glass, which absorbs light by Beer's law.
// provides: load_medium, store_medium, transmittance
// needs: MEDIUM, load, store

fn load_medium(index: u32) -> vec3f {
    return load(index, MEDIUM).xyz;
}

fn store_medium(index: u32, medium: vec3f) {
    store(index, MEDIUM, vec4f(medium, 0.0));
}

fn transmittance(medium: vec3f, distance: f32) -> vec3f {
    return exp(-medium * distance);
}
