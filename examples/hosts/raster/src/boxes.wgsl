// Boxes with a light from above.

struct Box {
    world_from_box: mat4x4f,
    color: vec4f,
}

struct Frame {
    clip_from_world: mat4x4f,
    boxes: array<Box, 6>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) normal: vec3f,
    @location(1) color: vec3f,
}

// The corners of a cube from -1 to 1: six sides of two triangles.
@vertex
fn corner(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Corner {
    let axis = vertex / 12u;
    let sign = select(-1.0, 1.0, (vertex / 6u) % 2u == 1u);
    let at = vertex % 6u;
    let u = select(-1.0, 1.0, at == 1u || at == 2u || at == 4u);
    let v = select(-1.0, 1.0, at == 2u || at == 4u || at == 5u);
    var place = vec3f(sign, u, v);
    var normal = vec3f(sign, 0.0, 0.0);
    if (axis == 1u) {
        place = place.zxy;
        normal = normal.zxy;
    } else if (axis == 2u) {
        place = place.yzx;
        normal = normal.yzx;
    }
    let matrix = frame.boxes[instance].world_from_box;
    let in_world = matrix * vec4f(place, 1.0);
    // The matrices scale along the axes of the box, so a normal of a side only changes its length.
    let turned = (matrix * vec4f(normal, 0.0)).xyz;
    return Corner(frame.clip_from_world * in_world, normalize(turned), frame.boxes[instance].color.rgb);
}

@fragment
fn lit(corner: Corner) -> @location(0) vec4f {
    let light = max(dot(normalize(corner.normal), normalize(vec3f(0.5, 1.0, 0.4))), 0.0);
    return vec4f(corner.color * (0.25 + 0.75 * light), 1.0);
}
