// The colour of a surface in pictures of primary rays. Twin: `Shading` in src/render/integrator.rs.
// provides: SHADING_TRANSPARENT, surface_color
// needs: Ray, frame

const SHADING_FLAT: u32 = 0u;
const SHADING_HEADLIGHT: u32 = 1u;
// Added to one of these where misses are transparent.
const SHADING_TRANSPARENT: u32 = 2u;

fn surface_color(color: vec3f, normal: vec3f, ray: Ray) -> vec3f {
    if ((frame.shading & SHADING_HEADLIGHT) != 0u) {
        return color * abs(dot(normal, ray.direction));
    }
    return color;
}
