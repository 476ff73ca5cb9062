// What a surface does with light. Twin: src/scene/material.rs.
// provides: CONDUCTOR, DIELECTRIC, EMISSIVE, ENERGIES, LAMBERT, Material, energy, material_of, opacity_of
// needs: Vertex, lighting, table, tables

const LAMBERT: u32 = 0u;
const CONDUCTOR: u32 = 1u;
const DIELECTRIC: u32 = 2u;
const EMISSIVE: u32 = 3u;

struct Material {
    kind: u32,
    // The share of Lambert's lobe, the index of refraction, or the strength of an emitter.
    parameter: f32,
    // The square of the roughness; 0 is smooth.
    alpha: f32,
    // Where the energies of its lobe start in `tables`.
    energies: u32,
    // How much light is absorbed inside, for each unit of length.
    absorption: vec3f,
}

fn material_of(vertex: Vertex) -> Material {
    let row = lighting.material_first + 2u * vertex.material;
    let bits = tables[row];
    let numbers = bitcast<vec2f>(bits.yz);
    return Material(bits.x, numbers.x, numbers.y, bits.w, table(row + 1u).rgb);
}

// Without the alpha of the colour.
fn opacity_of(material: u32) -> f32 {
    return table(lighting.material_first + 2u * material + 1u).w;
}

// A table of an energy has so many numbers, and starts at the next multiple of four.
const ENERGIES: u32 = 256u;

// What a lobe keeps of the light that it gets at a cosine. Twin: `lookup` in src/light/energy.rs.
fn energy(first: u32, cosine: f32) -> f32 {
    let along = sqrt(sqrt(clamp(cosine, 0.0, 1.0))) * f32(ENERGIES - 1u);
    let below = min(u32(along), ENERGIES - 2u);
    let a = bitcast<f32>(tables[first + (below >> 2u)][below & 3u]);
    let b = bitcast<f32>(tables[first + ((below + 1u) >> 2u)][(below + 1u) & 3u]);
    return a + (along - f32(below)) * (b - a);
}
