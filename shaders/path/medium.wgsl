// What absorbs light between two surfaces.

//// none
// A scene without glass: nothing absorbs light on the way.
// provides: kept_by, load_medium, store_medium

fn load_medium(index: u32) -> vec3f {
    return vec3f(0.0);
}

fn store_medium(index: u32, medium: vec3f) {}

fn kept_by(medium: vec3f, distance: f32) -> vec3f {
    return vec3f(1.0);
}

//// glass
// Glass absorbs light on the way (Beer's law).
// provides: kept_by, load_medium, store_medium
// needs: MEDIUM, load, store

fn load_medium(index: u32) -> vec3f {
    return load(index, MEDIUM).xyz;
}

fn store_medium(index: u32, medium: vec3f) {
    store(index, MEDIUM, vec4f(medium, 0.0));
}

fn kept_by(medium: vec3f, distance: f32) -> vec3f {
    return exp(-medium * distance);
}
