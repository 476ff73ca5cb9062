// The buffers of the colours and materials of a brick's shapes. Twin: src/gpu/scene/appearance.rs.

//// alone
// The buffers of a brick for kernels that do not search it.
// provides: appearances, brick, palette, shapes
// needs: Brick, Shape

// The brick, see accel/brick.wgsl.
@group(1) @binding(0) var<uniform> brick: Brick;
// The shapes, see accel/brick.wgsl.
@group(1) @binding(1) var<storage, read> shapes: array<Shape>;
// Appearance words in the order of `shapes`: a colour word for each shape and, from `brick.material_first` on, a
// material word for each shape if there are several materials.
@group(1) @binding(2) var<storage, read> appearances: array<u32>;
// Linear colours with alpha, or the values of all bytes if shapes have individual RGBA8 colours.
@group(1) @binding(3) var<storage, read> palette: array<vec4f>;

//// beside-structure
// The buffers that kernels which search a brick and shade its shapes need beside those of the structure.
// provides: appearances, palette

// Appearance words, see the other variant.
@group(3) @binding(0) var<storage, read> appearances: array<u32>;
// Linear colours, see the other variant.
@group(3) @binding(1) var<storage, read> palette: array<vec4f>;
