// The parameters and tables of lights, sky, ground and materials.
// provides: background, filter_table, ground_distance, lighting, lighting_has, table, tables
// needs: LIGHTING_GROUND, LIGHTING_TRANSPARENT, LightingParameters, NO_HIT, Ray

// Parameters of sky, ground and sampling, and the indices at which the tables start.
@group(2) @binding(0) var<uniform> lighting: LightingParameters;
// Tables of lights, materials and energies, one after another. They are stored as bits, because some are
// integers, which as f32 would be subnormal and might be flushed to zero.
@group(2) @binding(1) var<storage, read> tables: array<vec4u>;

fn table(index: u32) -> vec4f {
    return bitcast<vec4f>(tables[index]);
}

fn lighting_has(flag: u32) -> bool {
    return (lighting.flags & flag) != 0u;
}

// What a picture shows where there is nothing.
fn background() -> vec3f {
    return select(lighting.background, vec3f(0.0), lighting_has(LIGHTING_TRANSPARENT));
}

fn filter_table(index: u32) -> f32 {
    return lighting.filter_table[index >> 2u][index & 3u];
}

// The distance at which a ray hits the ground from above, or NO_HIT. It may be negative, down to -`behind`, the
// distance that the ray has travelled before its origin.
fn ground_distance(ray: Ray, behind: f32) -> f32 {
    let toward = dot(ray.direction, lighting.ground_normal);
    let height = dot(ray.origin - lighting.ground_point, lighting.ground_normal);
    let is_toward = toward < 0.0 && lighting_has(LIGHTING_GROUND);
    let t = height / select(1.0, -toward, is_toward);
    // With parallel rays, the other condition depends on uniforms alone, so it must be the second; see
    // docs/explain/drivers.md.
    return select(NO_HIT, t, t > -behind && is_toward);
}
