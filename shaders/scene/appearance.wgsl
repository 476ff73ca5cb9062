// Colours and materials of the shapes of a brick. Twin: src/gpu/scene/appearance.rs.
// provides: material_index, sphere_color
// needs: appearances, brick, palette

// The linear colour and the alpha of a shape. Each component is read separately, because the components of an RGBA8
// colour have different indices in the palette.
fn sphere_color(shape_index: u32) -> vec4f {
    let word = appearances[min(shape_index, brick.last_appearance)];
    let at = (vec4u(word) >> (brick.color_shift * vec4u(0u, 1u, 2u, 3u))) & vec4u(brick.color_mask);
    return vec4f(palette[at.x].r, palette[at.y].g, palette[at.z].b, palette[at.w].a);
}

// The row of a shape in the table of materials, not counting the row of the ground.
fn material_index(shape_index: u32) -> u32 {
    return appearances[min(brick.material_first + shape_index, brick.last_appearance)] & brick.material_mask;
}
