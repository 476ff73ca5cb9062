// What the shapes of a brick look like. Twin: src/gpu/scene/appearance.rs.
// provides: brick, material_index, shapes, sphere_color
// needs: Brick, Shape

// As in accel/brick.wgsl.
@group(1) @binding(0) var<uniform> brick: Brick;
// As in accel/brick.wgsl.
@group(1) @binding(1) var<storage, read> shapes: array<Shape>;
// In the order of `shapes`: a word of colour each; and from `brick.material_first` on, where shapes are of several
// materials, a word of material each.
@group(1) @binding(2) var<storage, read> appearances: array<u32>;
// Linear colours, and alpha; where shapes have colours of their own, in RGBA8, what every byte stands for.
@group(1) @binding(3) var<storage, read> palette: array<vec4f>;

// A shape's linear colour, and its alpha. One read a component, whether they stand together in the palette or not.
fn sphere_color(shape_index: u32) -> vec4f {
    let word = appearances[min(shape_index, brick.last_appearance)];
    let at = (vec4u(word) >> (brick.color_shift * vec4u(0u, 1u, 2u, 3u))) & vec4u(brick.color_mask);
    return vec4f(palette[at.x].r, palette[at.y].g, palette[at.z].b, palette[at.w].a);
}

// A shape's row in the table of materials, not counting the ground's.
fn material_index(shape_index: u32) -> u32 {
    return appearances[min(brick.material_first + shape_index, brick.last_appearance)] & brick.material_mask;
}
