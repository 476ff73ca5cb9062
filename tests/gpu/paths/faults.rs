//! Faults of the kernels of paths that the checker must find, with the stage in which it must find them.

use pinhole::verify::LitStage;
use pinhole::verify::LitStage::{
    Accumulate, Extend, Light, Occlude, Radiance, Scatter, Start, Vertex,
};

use super::scenes::{self, LitView};

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
    [RAYS, SURFACES, COLORS, GLASS, LOBES, LIGHTS, CHANCE, ENDS].into_iter().flatten().map(fault)
}

/// Faults of kernels that exclude spheres by their ids, because equal spheres are in several bricks.
pub(crate) fn of_ids() -> impl Iterator<Item = Fault> {
    IDS.iter().map(fault)
}

fn fault(&(name, stage, view, file, find, replace): &Row) -> Fault {
    Fault { name, stage, view, file, find, replace }
}

const IDS: &[Row] = &[
    (
        "own_id_met_again",
        Extend,
        scenes::thrice,
        "accel/excluded.wgsl#by-id",
        "return ids[shape_index] == excluded.departed;",
        "return false;",
    ),
    (
        "emitter_hides_its_own_id",
        Occlude,
        scenes::thrice,
        "accel/excluded.wgsl#by-id-and-light",
        "id == excluded.departed || id == excluded.light",
        "id == excluded.departed",
    ),
    (
        "shape_of_another_brick",
        Vertex,
        scenes::thrice,
        "path/vertex.wgsl",
        "NO_ID, 0u, vec4f(0.0)",
        "NO_ID, 1u, vec4f(0.0)",
    ),
];

/// Faults of the appearance of spheres.
const COLORS: &[Row] = &[
    (
        "alpha_left_out",
        Radiance,
        scenes::own_colors,
        "path/vertex.wgsl",
        "color.a * opacity_of(material)",
        "opacity_of(material)",
    ),
    (
        "opacity_of_a_material_left_out",
        Radiance,
        scenes::own_colors,
        "path/vertex.wgsl",
        "color.a * opacity_of(material)",
        "color.a",
    ),
    (
        "material_of_the_neighbor",
        Radiance,
        scenes::own_colors,
        "scene/appearance.wgsl",
        "brick.material_first + shape_index,",
        "brick.material_first + shape_index + 1u,",
    ),
    (
        "one_byte_decoded_as_the_next",
        Scatter,
        scenes::own_colors,
        "scene/appearance.wgsl",
        "palette[at.y].g",
        "palette[select(at.y, 186u, at.y == 185u)].g",
    ),
];

/// Faults of the origins of rays and of their hits.
const RAYS: &[Row] = &[
    (
        "film_point_of_another_pair",
        Start,
        scenes::matt,
        "path/start.wgsl",
        "address.sample, 0u)",
        "address.sample, 1u)",
    ),
    (
        "lens_point_of_another_pair",
        Start,
        scenes::lobes,
        "path/start.wgsl",
        "address.sample, 1u)",
        "address.sample, 2u)",
    ),
    (
        "filter_a_thousandth_too_wide",
        Start,
        scenes::matt,
        "camera/film_sample.wgsl",
        "2.0 * offset",
        "2.002 * offset",
    ),
    (
        "own_sphere_met_again",
        Extend,
        scenes::matt,
        "accel/excluded.wgsl#by-index",
        "return is_same(shape, excluded.departed);",
        "return false;",
    ),
    (
        "exit_distance_a_thousandth_too_short",
        Scatter,
        scenes::glass,
        "path/vertex.wgsl",
        "return max(2.0 * dot(",
        "return max(1.998 * dot(",
    ),
    (
        "exit_distance_forgotten",
        Extend,
        scenes::glass,
        "path/extend.wgsl",
        "is_alive && has(start.flags, PATH_INSIDE)",
        "false",
    ),
    (
        "box_entry_forgotten",
        Extend,
        scenes::matt,
        "accel/brick.wgsl",
        "+ nearest.shape_index, entry.distance)",
        "+ nearest.shape_index, 0.0)",
    ),
    (
        "rest_of_a_cell_forgotten",
        Extend,
        scenes::many,
        "accel/ball_list.wgsl",
        "at = select(at + 1u, NO_LIST, four.w >= LAST_BALL);",
        "at = NO_LIST;",
    ),
];

/// Faults of surface points and of their tangent frames.
const SURFACES: &[Row] = &[
    (
        "point_beside_the_surface",
        Vertex,
        scenes::matt,
        "path/vertex.wgsl",
        "sphere.xyz + sphere.w * outward",
        "sphere.xyz + 1.00001 * sphere.w * outward",
    ),
    (
        "near_side_for_far_side",
        Vertex,
        scenes::from_inside,
        "path/vertex.wgsl",
        "is_far_side || hit.t > middle",
        "false",
    ),
    (
        "normal_turned_round",
        Light,
        scenes::matt,
        "path/vertex.wgsl",
        "select(outward, -outward, is_back)",
        "-select(outward, -outward, is_back)",
    ),
    (
        "ground_met_from_below_it",
        Vertex,
        scenes::matt,
        "path/vertex.wgsl",
        "- dot(on_ray - lighting.ground_point, n) * n",
        "- 1.001 * dot(on_ray - lighting.ground_point, n) * n - 0.0001 * n",
    ),
    (
        "another_sphere_left",
        Vertex,
        scenes::matt,
        "path/scatter.wgsl",
        "Departure(vertex.id, vertex.shape_index, next.exit_distance, emitter_of(next.light))",
        "Departure(vertex.id ^ 1u, vertex.shape_index, next.exit_distance, emitter_of(next.light))",
    ),
    (
        "frame_with_a_sign_wrong",
        Scatter,
        scenes::matt,
        "math/warp.wgsl",
        "vec3f(b, s + n.y * n.y * a, -n.y)",
        "vec3f(b, s + n.y * n.y * a, n.y)",
    ),
    (
        "direction_of_another_pair",
        Scatter,
        scenes::matt,
        "path/bounce.wgsl",
        "2u + 8u * at.number",
        "3u + 8u * at.number",
    ),
    (
        "disk_not_concentric",
        Scatter,
        scenes::matt,
        "math/disk.wgsl",
        "0.25 * PI * part",
        "0.24 * PI * part",
    ),
    (
        "density_two_percent_off",
        Scatter,
        scenes::matt,
        "path/scatter_light.wgsl#matt",
        "vertex.color, toward.z / PI",
        "vertex.color, 1.02 * toward.z / PI",
    ),
    (
        "opacity_by_another_chance",
        Vertex,
        scenes::opacity,
        "path/leave.wgsl",
        "chance.y >= vertex.opacity",
        "chance.x >= vertex.opacity",
    ),
    (
        "passed_on_the_wrong_side",
        Scatter,
        scenes::opacity,
        "path/leave.wgsl",
        "side_of(at, true)",
        "side_of(at, false)",
    ),
    (
        "albedo_of_a_later_surface",
        Vertex,
        scenes::matt,
        "path/leave.wgsl",
        "scattered == 0u && path.first.w >= 0.0",
        "true",
    ),
];

/// Faults of glass and of absorption.
const GLASS: &[Row] = &[
    (
        "fresnel_of_one_polarisation",
        Scatter,
        scenes::glass,
        "path/dielectric.wgsl",
        "0.5 * (across * across + along * along)",
        "across * across",
    ),
    (
        "index_the_other_way_round",
        Scatter,
        scenes::glass,
        "path/dielectric.wgsl",
        "select(1.0 / material.parameter, material.parameter, is_entering)",
        "select(material.parameter, 1.0 / material.parameter, is_entering)",
    ),
    (
        "index_a_thousandth_off",
        Scatter,
        scenes::glass,
        "path/dielectric.wgsl",
        "- out / relative",
        "- out / (1.001 * relative)",
    ),
    (
        "medium_kept_after_leaving",
        Scatter,
        scenes::glass,
        "path/bounce.wgsl",
        "select(medium, inside, is_glass && is_behind)",
        "select(medium, at.material.absorption, is_glass && is_behind)",
    ),
    (
        "absorption_a_percent_off",
        Scatter,
        scenes::glass,
        "path/medium.wgsl#glass",
        "-medium * distance",
        "-1.01 * medium * distance",
    ),
    (
        "rough_glass_without_masking",
        Scatter,
        scenes::glass,
        "path/dielectric.wgsl",
        "ggx_lambda(material.alpha, abs(toward.z))",
        "0.0",
    ),
    (
        "light_behind_glass_counted_twice",
        Scatter,
        scenes::glass,
        "path/bounce.wgsl",
        "select(0u, PATH_FULL, is_glass)",
        "0u",
    ),
];

/// Faults of specular lobes and metals.
const LOBES: &[Row] = &[
    (
        "masking_of_each_side_alone",
        Radiance,
        scenes::lobes,
        "path/microfacet.wgsl",
        "1.0 / (1.0 + ggx_lambda(alpha, out.z) + ggx_lambda(alpha, toward.z))",
        "1.0 / ((1.0 + ggx_lambda(alpha, out.z)) * (1.0 + ggx_lambda(alpha, toward.z)))",
    ),
    (
        "energy_not_given_back",
        Radiance,
        scenes::lobes,
        "path/bsdf.wgsl",
        "vec3f(1.0 / kept)",
        "vec3f(1.0)",
    ),
    (
        "energy_of_the_next_cosine",
        Radiance,
        scenes::lobes,
        "scene/material.wgsl",
        "min(u32(along), ENERGIES - 2u)",
        "min(u32(along) + 4u, ENERGIES - 2u)",
    ),
    (
        "fourth_power_for_fifth",
        Light,
        scenes::metals,
        "path/bsdf.wgsl",
        "(m2 * m2 * m)",
        "(m2 * m2)",
    ),
    (
        "mirrors_of_half_the_roughness",
        Scatter,
        scenes::metals,
        "path/bsdf.wgsl",
        "visible_mirror(material.alpha, out, u)",
        "visible_mirror(0.5 * material.alpha, out, u)",
    ),
    (
        "density_of_a_lobe_two_percent_off",
        Scatter,
        scenes::lobes,
        "path/microfacet.wgsl",
        "return seen * ggx_density(alpha, half) / (4.0 * out.z);",
        "return 1.02 * seen * ggx_density(alpha, half) / (4.0 * out.z);",
    ),
    (
        "lobe_by_another_chance",
        Scatter,
        scenes::lobes,
        "path/leave.wgsl",
        "bounce(at, out, chance.x,",
        "bounce(at, out, chance.y,",
    ),
];

/// Faults of light sampling.
const LIGHTS: &[Row] = &[
    (
        "cosine_left_out",
        Light,
        scenes::matt,
        "path/scatter_light.wgsl#matt",
        "select(0.0, toward.z / PI, toward.z > 0.0 && out.z > 0.0)",
        "select(0.0, 1.0 / PI, toward.z > 0.0 && out.z > 0.0)",
    ),
    (
        "emitter_after_the_chosen_one",
        Light,
        scenes::emitters,
        "scene/emitters.wgsl",
        "return find_emitter(1u, bits);",
        "return (find_emitter(1u, bits) + 1u) % lighting.emitter_count;",
    ),
    (
        "light_of_another_pair",
        Light,
        scenes::emitters,
        "path/direct.wgsl#any",
        "sample, 4u",
        "sample, 2u",
    ),
    (
        "balance_left_out",
        Light,
        scenes::emitters,
        "path/direct.wgsl#any",
        "select(1.0, balanced, is_balanced)",
        "1.0",
    ),
    (
        "sources_not_counted",
        Light,
        scenes::matt,
        "path/direct.wgsl#any",
        "PI * sources * lamp.strength",
        "PI * lamp.strength",
    ),
    (
        "point_falls_off_by_distance",
        Light,
        scenes::matt,
        "scene/lamp.wgsl",
        "power.rgb / max(distance * distance, 1e-30)",
        "power.rgb / max(distance, 1e-30)",
    ),
    (
        "lamp_of_half_its_size",
        Light,
        scenes::lobes,
        "scene/lamp.wgsl",
        "power.rgb * (2.0 * k)",
        "power.rgb * k",
    ),
    (
        "sun_without_a_size",
        Light,
        scenes::sun,
        "scene/lamp.wgsl",
        "to_world(axes_around(light_record.xyz), cone_direction(u, k))",
        "light_record.xyz",
    ),
    (
        "sky_chosen_in_another_row",
        Light,
        scenes::image,
        "scene/environment.wgsl",
        "let row = environment_row(chance.y);",
        "let row = environment_row(chance.x);",
    ),
    (
        "sky_turned_the_other_way",
        Light,
        scenes::image,
        "scene/environment.wgsl",
        "vec2f(longitude.x, -longitude.y), 1.0)",
        "vec2f(longitude.x, -longitude.y), -1.0)",
    ),
    (
        "head_light_without_pi",
        Radiance,
        scenes::lobes,
        "path/bounce.wgsl",
        "return PI * sum *",
        "return sum *",
    ),
    (
        "own_surface_hides_no_light",
        Light,
        scenes::from_inside,
        "path/direct.wgsl#any",
        "&& !is_in_own",
        "",
    ),
    (
        "ground_hides_no_light",
        Light,
        scenes::image_over_ground,
        "path/direct.wgsl#any",
        "&& !is_below",
        "",
    ),
    (
        "shadow_ray_too_short",
        Occlude,
        scenes::emitters,
        "path/occlude.wgsl",
        "let rest = shadow.w - entry.distance;",
        "let rest = 0.5 * shadow.w - entry.distance;",
    ),
    (
        "shadow_ray_too_long",
        Occlude,
        scenes::emitters,
        "path/occlude.wgsl",
        "let rest = shadow.w - entry.distance;",
        "let rest = 2.0 * shadow.w - entry.distance;",
    ),
    (
        "emitter_hides_itself",
        Occlude,
        scenes::emitters,
        "accel/excluded.wgsl#by-index-and-light",
        "light = emitter(departure.word).sphere;",
        "",
    ),
    (
        "nothing_hides_light",
        Occlude,
        scenes::matt,
        "path/occlude.wgsl",
        "paths[slot(index, PENDING)].w = 0u;",
        "",
    ),
];

/// Faults of light that scattered rays hit.
const CHANCE: &[Row] = &[
    (
        "met_light_without_a_weight",
        Radiance,
        scenes::emitters,
        "path/by_chance.wgsl",
        "return select(weight, 1.0,",
        "return select(1.0, 1.0,",
    ),
    (
        "met_light_counted_directly",
        Radiance,
        scenes::emitters_directly,
        "path/by_chance.wgsl",
        "select(balanced, 0.0, lighting.light_sampling == LIGHT_DIRECT)",
        "balanced",
    ),
    (
        "known_density_of_another_emitter",
        Radiance,
        scenes::emitters,
        "path/direct.wgsl#any",
        "emitter_with_id(id)",
        "(emitter_with_id(id) + 1u) % lighting.emitter_count",
    ),
    (
        "gradient_of_the_wrong_half",
        Radiance,
        scenes::matt,
        "scene/sky.wgsl#plain",
        "direction.y >= 0.0",
        "direction.y < 0.0",
    ),
    (
        "sun_met_too_far_aside",
        Radiance,
        scenes::sun,
        "path/by_chance.wgsl",
        "<= 2.0 * k",
        "<= 4.0 * k",
    ),
    (
        "texel_beside",
        Radiance,
        scenes::image,
        "scene/environment.wgsl",
        "atan2_turns(flat.x, 0.0 - flat.y) + 0.5",
        "atan2_turns(flat.x, 0.0 - flat.y) + 0.53",
    ),
];

/// Faults of the ends of paths, and of departures.
const ENDS: &[Row] = &[
    (
        "roulette_without_division",
        Scatter,
        scenes::matt,
        "path/bounce.wgsl",
        "carried / max(survival, 1e-30)",
        "carried",
    ),
    (
        "roulette_by_another_chance",
        Scatter,
        scenes::matt,
        "path/bounce.wgsl",
        "6u + 8u * at.number)).x",
        "7u + 8u * at.number)).x",
    ),
    (
        "roulette_one_surface_late",
        Scatter,
        scenes::matt,
        "path/bounce.wgsl",
        "at.number >= lighting.roulette_from",
        "at.number > lighting.roulette_from",
    ),
    (
        "hidden_light_added",
        Radiance,
        scenes::matt,
        "path/direct_light.wgsl#any",
        "pending.rgb * pending.w",
        "pending.rgb",
    ),
    (
        "light_added_twice",
        Accumulate,
        scenes::matt,
        "path/accumulate.wgsl",
        "with_sample(sums, radiance_so_far(index),",
        "with_sample(sums, radiance_so_far(index) + vec4f(load(index, PENDING).rgb * load(index, PENDING).w, 0.0),",
    ),
    (
        "luminance_of_other_weights",
        Accumulate,
        scenes::matt,
        "math/luminance.wgsl",
        "vec3f(0.2126, 0.7152, 0.0722)",
        "vec3f(0.2990, 0.5870, 0.1140)",
    ),
    (
        "last_workgroup_forgotten",
        Extend,
        scenes::matt,
        "path/advance.wgsl",
        "+ 63u) / 64u;",
        ") / 64u;",
    ),
    (
        "half_of_a_list_forgotten",
        Occlude,
        scenes::matt,
        "path/schedule.wgsl#queue",
        "if (ordinal >= atomicLoad(&queue.counts[dispatch.list])) {",
        "if (ordinal >= atomicLoad(&queue.counts[dispatch.list]) / select(1u, 2u, dispatch.list == LIST_OF_LIGHT)) {",
    ),
    (
        "paths_that_pass_are_dropped",
        Extend,
        scenes::opacity,
        "path/scatter.wgsl",
        "if (has(next.flags, PATH_ALIVE)) {",
        "if (has(next.flags, PATH_ALIVE) && next.density > 0.0) {",
    ),
    (
        "light_not_listed",
        Occlude,
        scenes::matt,
        "path/scatter.wgsl",
        "if (needs_shadow_ray(next.light)) {",
        "if (needs_shadow_ray(next.light) && (index & 15u) != 3u) {",
    ),
    (
        "list_of_another_surface",
        Extend,
        scenes::matt,
        "path/queue.wgsl",
        "return dispatch.surface & 1u;",
        "return 0u;",
    ),
    (
        "pixel_of_another_row",
        Start,
        scenes::matt,
        "path/address.wgsl",
        "index - row * size.x, row - in_flight * size.y)",
        "index - row * size.x, row - in_flight * size.y + 1u)",
    ),
];
