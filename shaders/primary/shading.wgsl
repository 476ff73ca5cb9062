// The colour of a surface in pictures of primary rays. Twin: `Shading` in src/render/integrator.rs.
// provides: surface_color
// needs: Ray, frame

const SHADING_FLAT: u32 = 0u;
const SHADING_HEADLIGHT: u32 = 1u;

fn surface_color(color: vec3f, normal: vec3f, ray: Ray) -> vec3f {
    if (frame.shading == SHADING_HEADLIGHT) {
        return color * abs(dot(normal, ray.direction));
    }
    return color;
}
