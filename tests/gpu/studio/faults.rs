//! Faults of the kernels of studios that the checker must find, with the stage in which it must find them.

use pinhole::verify::LitStage;
use pinhole::verify::LitStage::{
    Accumulate, Ambient, Extend, Gather, Illuminate, Shadow, Start, Surface, Vertex,
};

use super::scenes;
use crate::light::scenes::LitView;

/// A shader edit that is a fault, with a view in which it is visible.
pub(crate) struct Fault {
    pub(crate) name: &'static str,
    pub(crate) stage: LitStage,
    pub(crate) view: fn() -> LitView,
    pub(crate) file: &'static str,
    pub(crate) find: &'static str,
    pub(crate) replace: &'static str,
}

type Row = (&'static str, LitStage, fn() -> LitView, &'static str, &'static str, &'static str);

pub(crate) fn all() -> impl Iterator<Item = Fault> {
    [RAYS, SURFACES, SHADOWS, LIGHTS, AMBIENT, CATCHERS, SUMS].into_iter().flatten().map(
        |&(name, stage, view, file, find, replace)| Fault {
            name,
            stage,
            view,
            file,
            find,
            replace,
        },
    )
}

const RAYS: &[Row] = &[
    (
        "film_point_of_another_sample",
        Start,
        scenes::lamps,
        "path/start.wgsl",
        "address.sample, 0u)",
        "address.sample & 15u, 0u)",
    ),
    (
        "far_side_forgotten",
        Extend,
        scenes::translucent,
        "path/extend.wgsl",
        "is_alive && has(start.flags, PATH_INSIDE)",
        "false",
    ),
    (
        "own_sphere_met_again",
        Extend,
        scenes::translucent,
        "accel/excluded.wgsl#by-index",
        "return is_same(shape, excluded.departed);",
        "return false;",
    ),
];

const SURFACES: &[Row] = &[
    (
        "point_beside_the_surface",
        Vertex,
        scenes::lamps,
        "path/vertex.wgsl",
        "sphere.xyz + sphere.w * outward",
        "sphere.xyz + 1.00001 * sphere.w * outward",
    ),
    (
        "normal_of_the_other_side",
        Surface,
        scenes::lamps,
        "studio/surface.wgsl",
        "store(index, NORMAL, vec4f(vertex.normal, 0.0));",
        "store(index, NORMAL, vec4f(-vertex.normal, 0.0));",
    ),
    (
        "opacity_counted_twice",
        Surface,
        scenes::translucent,
        "studio/surface.wgsl",
        "let rest = left_over - weight;",
        "let rest = left_over - weight * vertex.opacity;",
    ),
    (
        "weight_a_ten_thousandth_off",
        Surface,
        scenes::translucent,
        "studio/surface.wgsl",
        "let weight = left_over * vertex.opacity;",
        "let weight = 0.9999 * left_over * vertex.opacity;",
    ),
    (
        "fog_by_the_last_distance_only",
        Surface,
        scenes::translucent,
        "studio/surface.wgsl",
        "let far = first.w + vertex.distance;",
        "let far = vertex.distance;",
    ),
    (
        "fog_without_a_limit",
        Surface,
        scenes::fog,
        "studio/faded.wgsl",
        "* lighting.cue_scale, 0.0, 1.0)",
        "* lighting.cue_scale, 0.0, 0.999)",
    ),
    (
        "emitter_a_thousandth_dimmer",
        Surface,
        scenes::fog,
        "studio/surface.wgsl",
        "vec3f(material.parameter), is_emitter",
        "vec3f(0.999 * material.parameter), is_emitter",
    ),
    (
        "translucent_side_casts_its_own_shadow",
        Surface,
        scenes::translucent,
        "studio/surface.wgsl",
        "vertex.is_back && vertex.opacity >= 1.0",
        "vertex.is_back",
    ),
    (
        "background_behind_the_last_surface_forgotten",
        Surface,
        scenes::few_surfaces,
        "studio/surface.wgsl",
        "select(0.0, rest, dispatch.is_last != 0u) * shown",
        "select(0.0, rest, dispatch.is_last != 0u) * 0.0 * shown",
    ),
    (
        "color_of_a_later_surface",
        Surface,
        scenes::translucent,
        "studio/surface.wgsl",
        "let is_first = dispatch.surface == 0u && !is_caught;",
        "let is_first = dispatch.surface <= 1u && !is_caught;",
    ),
    (
        "lobe_of_the_wrong_roughness",
        Surface,
        scenes::lamps,
        "studio/surface.wgsl",
        "vec2f(share, material.alpha)",
        "vec2f(share, sqrt(material.alpha))",
    ),
    (
        "opacity_too_low_by_the_surface_before",
        Surface,
        scenes::translucent,
        "studio/surface.wgsl",
        "let added = select(vec4f(seen, weight)",
        "let added = select(vec4f(seen, weight * left_over)",
    ),
];

const SHADOWS: &[Row] = &[
    (
        "shadow_of_another_sample",
        Shadow,
        scenes::lamps,
        "studio/shadow.wgsl",
        "sample_pair(seed, address.sample, 2u",
        "sample_pair(seed, address.sample ^ 1u, 2u",
    ),
    (
        "shadow_of_another_pair",
        Shadow,
        scenes::translucent,
        "studio/shadow.wgsl",
        "4096u * dispatch.surface",
        "2048u * dispatch.surface",
    ),
    (
        "light_behind_the_surface_searched",
        Shadow,
        scenes::lamps,
        "studio/shadow.wgsl",
        "select(0.0, lamp.distance, is_before)",
        "lamp.distance",
    ),
    (
        "shadow_beyond_the_light",
        Shadow,
        scenes::enclosed,
        "studio/hidden_light.wgsl",
        "find_any(Search(entry.ray, entry.inverse, excluded), rest)",
        "find_any(Search(entry.ray, entry.inverse, excluded), 4.0 * rest)",
    ),
    (
        "shadow_shorter_by_the_way_into_the_box",
        Shadow,
        scenes::sharp,
        "studio/hidden_light.wgsl",
        "let rest = distance - entry.distance;",
        "let rest = 0.6 * distance - entry.distance;",
    ),
    (
        "ground_hides_nothing",
        Shadow,
        scenes::sharp,
        "studio/hidden_light.wgsl",
        "var is_hidden = is_in_own || is_below;",
        "var is_hidden = is_in_own;",
    ),
    (
        "far_side_hides_nothing",
        Shadow,
        scenes::enclosed,
        "studio/hidden_light.wgsl",
        "var is_hidden = is_in_own || is_below;",
        "var is_hidden = is_below;",
    ),
    (
        "bit_of_the_neighbor",
        Shadow,
        scenes::lamps,
        "studio/shadow.wgsl",
        "1u << (dispatch.light & 31u)",
        "1u << ((dispatch.light + 1u) & 31u)",
    ),
    (
        "bits_replaced_instead_of_added",
        Shadow,
        scenes::lamps,
        "studio/hide.wgsl",
        "w |= lights;",
        "w = lights;",
    ),
    (
        "own_sphere_hides_the_light",
        Shadow,
        scenes::translucent,
        "accel/excluded.wgsl#by-id",
        "return ids[shape_index] == excluded.departed;",
        "return false;",
    ),
];

const LIGHTS: &[Row] = &[
    (
        "light_of_another_sample",
        Illuminate,
        scenes::lamps,
        "studio/illuminate.wgsl",
        "sample_pair(seed, address.sample, 2u",
        "sample_pair(seed, address.sample ^ 1u, 2u",
    ),
    (
        "bits_beyond_a_word",
        Illuminate,
        scenes::more_lights,
        "studio/illuminate.wgsl",
        "1u << (light & 31u)",
        "1u << ((light + light / 32u) & 31u)",
    ),
    (
        "bits_not_cleared",
        Illuminate,
        scenes::lamps,
        "studio/illuminate.wgsl",
        "paths[slot(index, NORMAL)].w = 0u;",
        "",
    ),
    (
        "head_light_from_aside",
        Illuminate,
        scenes::lamps,
        "studio/illuminate.wgsl",
        "Lamp(out, 0.0,",
        "Lamp(normal, 0.0,",
    ),
    (
        "matt_part_not_reduced_by_the_lobe",
        Illuminate,
        scenes::lamps,
        "studio/reflected.wgsl",
        "(1.0 - lobe.x) * cosine * albedo",
        "cosine * albedo",
    ),
    (
        "lobe_a_hundredth_too_bright",
        Illuminate,
        scenes::lamps,
        "studio/reflected.wgsl",
        "lobe.x * PI * mirrors",
        "1.01 * lobe.x * PI * mirrors",
    ),
    (
        "lobe_without_what_it_loses",
        Illuminate,
        scenes::lamps,
        "studio/reflected.wgsl",
        "/ energy(bitcast<u32>(lobe.z), o.z)",
        "/ max(1.0, energy(bitcast<u32>(lobe.z), o.z))",
    ),
    (
        "point_light_a_ten_thousandth_brighter",
        Illuminate,
        scenes::lamps,
        "scene/lamp.wgsl",
        "power.rgb / max(distance * distance, 1e-30)",
        "1.0001 * power.rgb / max(distance * distance, 1e-30)",
    ),
    (
        "lobe_on_a_surface_of_full_weight",
        Illuminate,
        scenes::translucent,
        "studio/reflected.wgsl",
        "let shine = weight * lobe_light",
        "let shine = max(weight, 0.9) * lobe_light",
    ),
];

const AMBIENT: &[Row] = &[
    (
        "directions_of_another_surface",
        Ambient,
        scenes::translucent,
        "studio/ambient.wgsl",
        "4096u * dispatch.surface + 4095u",
        "4095u",
    ),
    (
        "directions_of_each_sample_alike",
        Ambient,
        scenes::lamps,
        "studio/ambient.wgsl",
        "address.sample * lighting.occlusion_samples + light",
        "light",
    ),
    (
        "occlusion_a_tenth_too_far",
        Ambient,
        scenes::lamps,
        "studio/ambient.wgsl",
        "direction, lighting.occlusion_radius)",
        "direction, 1.1 * lighting.occlusion_radius)",
    ),
    (
        "directions_beyond_a_word",
        Ambient,
        scenes::more_directions,
        "studio/ambient.wgsl",
        "1u << (light & 31u), is_near",
        "1u << min(light, 31u), is_near",
    ),
    (
        "one_direction_too_many",
        Gather,
        scenes::lamps,
        "studio/gather.wgsl",
        "(f32(dispatch.count) - hidden)",
        "(f32(dispatch.count) + 1.0 - hidden)",
    ),
    (
        "share_of_one_batch",
        Gather,
        scenes::more_directions,
        "studio/gather.wgsl",
        "1.0 / f32(lighting.occlusion_samples)",
        "1.0 / f32(dispatch.count)",
    ),
];

const CATCHERS: &[Row] = &[
    (
        "shadow_without_the_lights_share",
        Illuminate,
        scenes::catcher,
        "studio/illuminate.wgsl",
        "caught(central_light(light, start.position) / total, albedo.w)",
        "caught(central_light(light, start.position), albedo.w)",
    ),
    (
        "light_at_the_eye_counts",
        Illuminate,
        scenes::catcher,
        "studio/catcher.wgsl",
        "select(light_there, 0.0, kind == LAMP_HEAD)",
        "select(light_there, luminance(power.rgb), kind == LAMP_HEAD)",
    ),
    (
        "background_not_darkened",
        Illuminate,
        scenes::catcher,
        "studio/catcher.wgsl",
        "return vec4f(-behind, alpha);",
        "return vec4f(-0.999 * behind, alpha);",
    ),
    (
        "ambient_shadow_of_full_luminance",
        Gather,
        scenes::catcher,
        "studio/gather.wgsl",
        "caught(share * hidden * luminance(lighting.ambient) / total, albedo.w)",
        "caught(share * hidden / total, albedo.w)",
    ),
    (
        "catcher_is_opaque",
        Surface,
        scenes::catcher,
        "studio/surface.wgsl",
        "vec4f(left_over * shown, 0.0), is_caught",
        "vec4f(left_over * shown, 1.0), is_caught",
    ),
];

/// Faults of the sums of samples, which show only where there are sums of samples before.
const SUMS: &[Row] = &[
    (
        "film_that_leaks",
        Accumulate,
        scenes::lamps,
        "path/film_sums.wgsl",
        "let value = fence4(sum.value + more);",
        "let value = fence4(0.99999 * sum.value + more);",
    ),
    (
        "rest_thrown_away",
        Accumulate,
        scenes::lamps,
        "path/film_sums.wgsl",
        "return Sum(value, fence4(sum.rest + fence4(lost)));",
        "return Sum(value, fence4(lost) + 0.001 * more);",
    ),
    (
        "opacity_replaced",
        Accumulate,
        scenes::lamps,
        "path/film_sums.wgsl",
        "sums.opacity + radiance.w",
        "radiance.w",
    ),
    (
        "late_samples_left_out",
        Accumulate,
        scenes::lamps,
        "path/accumulate.wgsl",
        "for (var i = 0u; i < dispatch.count; i++) {",
        "for (var i = 0u; i < select(dispatch.count, 0u, dispatch.sample > 60u); i++) {",
    ),
    (
        "square_of_one_channel",
        Accumulate,
        scenes::lamps,
        "path/film_sums.wgsl",
        "let light = luminance(radiance.rgb);",
        "let light = radiance.g;",
    ),
];
