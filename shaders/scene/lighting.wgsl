// What lights, sky, ground and materials are.
// provides: filter_table, ground_distance, lighting, lighting_has, table, tables
// needs: LIGHTING_GROUND, LightingParameters, NO_HIT, Ray

// Sky, ground, sampling, and where the tables start.
@group(2) @binding(0) var<uniform> lighting: LightingParameters;
// Lights, emitters, materials and energies, each at its own place. Bits, because there are whole numbers among them,
// which as f32 are subnormal and might be flushed.
@group(2) @binding(1) var<storage, read> tables: array<vec4u>;

fn table(index: u32) -> vec4f {
    return bitcast<vec4f>(tables[index]);
}

fn lighting_has(flag: u32) -> bool {
    return (lighting.flags & flag) != 0u;
}

fn filter_table(index: u32) -> f32 {
    return lighting.filter_table[index >> 2u][index & 3u];
}

// Where a ray meets the ground from above, or NO_HIT; perhaps behind its origin, as far as it has come already.
fn ground_distance(ray: Ray, behind: f32) -> f32 {
    let toward = dot(ray.direction, lighting.ground_normal);
    let height = dot(ray.origin - lighting.ground_point, lighting.ground_normal);
    let is_toward = lighting_has(LIGHTING_GROUND) && toward < 0.0;
    let t = height / select(1.0, -toward, is_toward);
    return select(NO_HIT, t, is_toward && t > -behind);
}
