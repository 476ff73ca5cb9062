// Materials, read from their table. Twin: src/scene/material.rs.
// provides: CONDUCTOR, DIELECTRIC, EMISSIVE, ENERGIES, LAMBERT, Material, energy, material_of, opacity_of
// needs: Vertex, lighting, table, tables

const LAMBERT: u32 = 0u;
const CONDUCTOR: u32 = 1u;
const DIELECTRIC: u32 = 2u;
const EMISSIVE: u32 = 3u;

struct Material {
    kind: u32,
    // The share of the specular lobe, the index of refraction, or the strength of an emitter.
    parameter: f32,
    // The square of the roughness; 0 is smooth.
    alpha: f32,
    // Index in `tables` of the first energy of the lobe.
    energies: u32,
    // Absorption coefficient inside, per unit of length.
    absorption: vec3f,
}

fn material_of(vertex: Vertex) -> Material {
    let row = lighting.material_first + 2u * vertex.material;
    let bits = tables[row];
    let numbers = bitcast<vec2f>(bits.yz);
    return Material(bits.x, numbers.x, numbers.y, bits.w, table(row + 1u).rgb);
}

// The opacity of a material, without the alpha of the colour.
fn opacity_of(material: u32) -> f32 {
    return table(lighting.material_first + 2u * material + 1u).w;
}

// Number of entries in a table of energies.
const ENERGIES: u32 = 256u;

// The fraction of light that a lobe reflects at a given cosine. Twin: `lookup` in src/light/energy.rs.
fn energy(first: u32, cosine: f32) -> f32 {
    let along = sqrt(sqrt(clamp(cosine, 0.0, 1.0))) * f32(ENERGIES - 1u);
    let below = min(u32(along), ENERGIES - 2u);
    let a = bitcast<f32>(tables[first + (below >> 2u)][below & 3u]);
    let b = bitcast<f32>(tables[first + ((below + 1u) >> 2u)][(below + 1u) & 3u]);
    return a + (along - f32(below)) * (b - a);
}
