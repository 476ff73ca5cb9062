//! The check of uploaded data for lit pictures: whether the numbers on the device, and its tables of lights, emitters,
//! materials and energies, match the requested scene and settings.

use std::cmp::Ordering;

use glam::{DVec3, Vec4};

use crate::geometry::math::{unit, wide};
use crate::image::color::{LinearRgb, luminance};
use crate::light::energy::EnergyTables;
use crate::light::environment::Environment;
use crate::light::{LightKind, SkyLight, codes};
use crate::recording::lit::{LitInputs, UploadedLighting, flag};
use crate::recording::{NO_HIT, UploadError};
use crate::render::{DepthCue, Integrator, LightSampling, Occlusion, PathTracing, Studio};
use crate::scene::Scene;
use crate::scene::material::{Material, SurfaceProperties};
use crate::verify::hit::Candidates;
use crate::verify::lit::sampling::ENERGIES;
use crate::verify::rounding::{FLUSH, U, are_near, is_near};
use crate::verify::uploaded::{LEAST_MARGIN, check_view};

/// Compares the recording with the scene and the settings.
pub(crate) fn check(scene: &Scene, candidates: &Candidates, inputs: &LitInputs) -> Result<(), UploadError> {
    check_view(scene, candidates, &inputs.camera, &inputs.uploaded)?;
    check_lighting(scene, inputs)?;
    check_tables(scene, inputs)
}

fn wrong(what: &str) -> UploadError {
    UploadError(format!("{what} on the device differs from the settings"))
}

fn wrong_entry(what: &str, index: usize) -> UploadError {
    UploadError(format!("{what} {index} on the device differs from the scene and the settings"))
}

fn is_color(found: [f32; 3], asked: LinearRgb) -> bool {
    are_near(found, asked.to_array().map(f64::from))
}

/// Compares a point in the scene's frame with a point in world space.
fn is_point(found: [f32; 3], asked: DVec3, scene: &Scene) -> bool {
    let exact = asked - scene.origin();
    // The second term is the rounding error of f64 if large numbers cancel.
    let error = 2.0 * U * exact.abs() + 4.0 * f64::EPSILON * (asked.abs() + scene.origin().abs()) + FLUSH;
    (wide(found) - exact).abs().cmple(error).all()
}

fn check_lighting(scene: &Scene, inputs: &LitInputs) -> Result<(), UploadError> {
    let LitInputs { settings, lighting, .. } = inputs;
    match &settings.integrator {
        Integrator::Primary(_) => return Err(wrong("the integrator")),
        Integrator::Path(path) => check_path(path, inputs)?,
        Integrator::Studio(studio) => {
            check_studio(studio, scene, inputs)?;
            check_occluders(scene, inputs)?;
        }
    }
    let flags = |is_set: bool, flag: u32| if is_set { flag } else { 0 };
    let expected_flags = flags(settings.is_transparent, flag::TRANSPARENT)
        | flags(settings.sky.is_visible, flag::SKY_SEEN)
        | flags(settings.ground.is_some(), flag::GROUND)
        | flags(settings.ground.is_some_and(|ground| ground.is_shadow_catcher), flag::CATCHER)
        | flags(settings.studio_parameters().is_some_and(|studio| studio.shadows), flag::SHADOWS);
    let is_ground = settings.ground.as_ref().is_none_or(|ground| {
        let normal = unit(ground.normal).unwrap_or_default().to_array();
        is_point(lighting.ground_point, ground.point, scene)
            && are_near(lighting.ground_normal, normal)
            && is_color(lighting.ground_color, ground.color)
    });
    let filter = settings.sampling.filter.offset_table();
    let all = [
        ("the background", is_color(lighting.background, settings.background)),
        ("the set of flags", lighting.flags == expected_flags),
        ("the seed", lighting.seed == settings.sampling.seed),
        ("the ground", is_ground),
        ("the pixel filter", lighting.filter_table[..] == filter[..]),
        ("the sky", is_sky(inputs)),
    ];
    first_wrong(&all)
}

/// Returns an error with the name of the first parameter that is wrong. Each has a name, and whether it is right.
fn first_wrong(all: &[(&'static str, bool)]) -> Result<(), UploadError> {
    match all.iter().find(|(_, is_right)| !is_right) {
        None => Ok(()),
        Some((what, _)) => Err(wrong(what)),
    }
}

fn check_path(path: &PathTracing, inputs: &LitInputs) -> Result<(), UploadError> {
    let lighting = &inputs.lighting;
    first_wrong(&[
        ("the start of roulette", lighting.roulette_from == path.roulette_from),
        ("how lights are sampled", lighting.light_sampling == path.light_sampling.code()),
        ("the depth of paths", inputs.max_surfaces == path.max_depth),
    ])
}

fn check_studio(studio: &Studio, scene: &Scene, inputs: &LitInputs) -> Result<(), UploadError> {
    let LitInputs { lighting, .. } = inputs;
    let is_occlusion = match &studio.occlusion {
        None => lighting.occlusion_samples == 0,
        Some(Occlusion { radius, samples, .. }) => {
            lighting.occlusion_samples == *samples
                && is_near(lighting.occlusion_radius, radius.unwrap_or(NO_HIT.into()))
        }
    };
    let is_cue = match &studio.depth_cue {
        None => lighting.cue_scale == 0.0,
        Some(DepthCue { near, far, color }) => {
            is_color(lighting.cue_color, *color)
                && is_near(lighting.cue_near, *near)
                && is_near(lighting.cue_scale, 1.0 / (far - near))
        }
    };
    // No surface is seen behind an opaque one.
    let max_surfaces = if scene.is_opaque() { 1 } else { studio.max_surfaces };
    first_wrong(&[
        ("the ambient light", is_color(lighting.ambient, studio.ambient)),
        ("the ambient occlusion", is_occlusion),
        ("the depth cue", is_cue),
        ("the number of surfaces behind each other", inputs.max_surfaces == max_surfaces),
    ])
}

/// Checks that the box to which the origins of shadow rays are moved contains the shapes that cast shadows.
fn check_occluders(scene: &Scene, inputs: &LitInputs) -> Result<(), UploadError> {
    let [low, high] = inputs.occluders.map(wide);
    let margin = LEAST_MARGIN * (high - low).length();
    let holds = |[first, last]: [DVec3; 2]| (low + margin).cmple(first).all() && (high - margin).cmpge(last).all();
    let are_held = scene.opaque_ids().all(|id| holds(scene.shared_shapes().shape(id).corners()));
    first_wrong(&[("the box of the shapes that cast shadows", are_held)])
}

fn is_sky(LitInputs { settings, lighting, sky, .. }: &LitInputs) -> bool {
    let ends = [lighting.zenith, lighting.horizon, lighting.nadir];
    let are = |colors: [[f32; 3]; 3]| ends.into_iter().zip(colors).all(|(a, b)| are_near(a, b.map(f64::from)));
    match &settings.sky.light {
        SkyLight::Constant(radiance) => sky.is_none() && are([radiance.to_array(); 3]),
        SkyLight::Gradient { zenith, horizon, nadir } => {
            sky.is_none() && are([zenith, horizon, nadir].map(|end| end.to_array()))
        }
        SkyLight::Image { environment, strength, rotation } => {
            let shares = environment.rows().iter().chain(environment.columns());
            lighting.environment_size == [environment.width(), environment.height()]
                && are_near(lighting.environment_rotation, Environment::rotation(*rotation).map(f64::from))
                && is_near(lighting.environment_strength, (*strength).into())
                && sky.as_ref().is_some_and(|sky| sky.texels == environment.texels() && sky.shares.iter().eq(shares))
        }
    }
}

struct Tables<'a> {
    words: &'a [[u32; 4]],
    lighting: &'a UploadedLighting,
}

impl Tables<'_> {
    fn words(&self, at: u32) -> [u32; 4] {
        self.words.get(at as usize).copied().unwrap_or([u32::MAX; 4])
    }

    fn numbers(&self, at: u32) -> [f32; 4] {
        self.words(at).map(f32::from_bits)
    }

    fn vector(&self, at: u32) -> [f32; 3] {
        let [x, y, z, _] = self.numbers(at);
        [x, y, z]
    }
}

fn check_tables(scene: &Scene, inputs: &LitInputs) -> Result<(), UploadError> {
    let tables = Tables { words: &inputs.tables, lighting: &inputs.lighting };
    let lamps = check_lights(&tables, scene, inputs)?;
    let emitters = check_emitters(scene, inputs)?;
    check_materials(&tables, scene)?;
    let is_image = uses_light_sampling(inputs) && inputs.settings.sky.light.has_lit_image();
    let sources = lamps + u32::from(emitters > 0) + u32::from(is_image);
    let UploadedLighting { source_count, lamp_sources, emitter_count, .. } = inputs.lighting;
    let is_count = [source_count, lamp_sources, emitter_count] == [sources, lamps, emitters];
    first_wrong(&[("the number of light sources", is_count)])
}

fn uses_light_sampling(inputs: &LitInputs) -> bool {
    matches!(&inputs.settings.integrator, Integrator::Path(path) if path.light_sampling != LightSampling::Chance)
}

/// Checks the table of lights, and returns the number of lights among which light sampling chooses.
fn check_lights(tables: &Tables<'_>, scene: &Scene, inputs: &LitInputs) -> Result<u32, UploadError> {
    let vectors = &inputs.camera.vectors;
    let mut lamps = 0_u32;
    // A studio samples every light.
    let is_chosen = matches!(inputs.settings.integrator, Integrator::Path(_));
    let lights = inputs.settings.lights.iter().filter_map(|light| light.in_view(vectors));
    let mut count = 0;
    for (light, index) in lights.zip(0_u32..) {
        count = index + 1;
        let [position, power] = [tables.vector(3 * index), tables.vector(3 * index + 1)];
        let size = tables.numbers(3 * index + 1)[3];
        let is_kind = tables.words(3 * index)[3] == codes::of_light(&light);
        let near = |color: LinearRgb| is_color(power, color);
        let is_at = |point: DVec3| is_point(position, point, scene);
        let (is_right, is_lamp) = match light {
            LightKind::Head { strength } => (is_kind && near(strength), false),
            LightKind::Directional { toward, strength, angular_radius } => {
                let k = 1.0 - angular_radius.cos();
                // The difference cancels here, but not on the device.
                let is_size = (f64::from(size) - k).abs() <= 2e-7 * k + 4.0 * f64::EPSILON;
                let is_right = is_kind && near(strength) && are_near(position, toward.to_array()) && is_size;
                (is_right, angular_radius == 0.0 || uses_light_sampling(inputs))
            }
            LightKind::Point { position, intensity } => (is_kind && near(intensity) && is_at(position), true),
            LightKind::Sphere { center, radius, radiance } => {
                let is_right = is_kind && near(radiance) && is_at(center) && is_near(size, radius);
                (is_right, true)
            }
        };
        let is_lamp = is_lamp && is_chosen;
        // The indices of the sampled lights are stored one after the other in the third words of the first entries.
        let is_found = !is_lamp || tables.words(3 * lamps + 2)[0] == index;
        lamps += u32::from(is_lamp);
        if !(is_right && is_found) {
            return Err(wrong_entry("light", index as usize));
        }
    }
    first_wrong(&[("the number of lights", tables.lighting.light_count == count)]).map(|()| lamps)
}

/// Checks the table of emissive spheres, and returns the number of spheres among which light sampling chooses.
fn check_emitters(scene: &Scene, inputs: &LitInputs) -> Result<u32, UploadError> {
    if !uses_light_sampling(inputs) {
        return Ok(0);
    }
    let radiance = |id: u32| {
        let surface = scene.surface(id);
        let strength = match surface.material {
            Material::Emissive { strength } => f64::from(strength) * f64::from(surface.opacity),
            _ => 0.0,
        };
        scene.color(id).to_array().map(|c| f64::from(c) * strength)
    };
    let weight = |id: u32| {
        let [r, g, b] = radiance(id);
        let size = f64::from(scene.spheres()[id as usize][3]);
        luminance([r, g, b]) * size * size
    };
    let mut ids: Vec<u32> = (0..scene.len() as u32).filter(|id| weight(*id) > 0.0).collect();
    keep_first_of_equals(&mut ids, scene.spheres());
    let total: f64 = ids.iter().map(|id| weight(*id)).sum();
    let all = 2_f64.powi(32);
    // Each emitter has one certain pick, and its share of the others. Picks are whole numbers. The sum of all weights
    // before an emitter is rounded once for each term.
    let others = all - ids.len() as f64;
    let slack = 3.0 + 4.0 * f64::EPSILON * all * (ids.len() as f64 + 16.0);
    let mut before = 0.0;
    for (index, id) in ids.iter().enumerate() {
        let words = |at: usize| inputs.emitters.get(3 * index + at).copied().unwrap_or([u32::MAX; 4]);
        let [found_id, last, probability, _] = words(1);
        let end = f64::from(last) + 1.0;
        let probability = f32::from_bits(probability);
        let sphere = words(0).map(f32::from_bits);
        let [r, g, b, _] = words(2).map(f32::from_bits);
        let is_right = found_id == *id
            && Vec4::from(sphere) == Vec4::from(scene.spheres()[*id as usize])
            && are_near([r, g, b], radiance(*id))
            && end > before
            && (end - before - 1.0 - weight(*id) / total * others).abs() <= slack
            && is_near(probability, (end - before) / all)
            && (index + 1 < ids.len() || last == u32::MAX);
        if !is_right {
            return Err(wrong_entry("emitter", index));
        }
        before = end;
    }
    Ok(ids.len() as u32)
}

/// Keeps the ids of spheres that no earlier sphere of the scene equals. Rays hit only the first of equal spheres, so
/// only this one is sampled.
fn keep_first_of_equals(ids: &mut Vec<u32>, spheres: &[[f32; 4]]) {
    // Compared by value, because the sign of a zero does not matter. No component is NaN.
    let order = |a: &[f32; 4], b: &[f32; 4]| a.partial_cmp(b).unwrap_or(Ordering::Equal);
    let sphere = |id: u32| &spheres[id as usize];
    ids.sort_by(|a, b| order(sphere(*a), sphere(*b)));
    ids.dedup_by(|later, first| order(sphere(*later), sphere(*first)).is_eq());
    let mut is_hidden = vec![false; ids.len()];
    for (id, at) in (0_u32..).zip(spheres) {
        if let Ok(at) = ids.binary_search_by(|other| order(sphere(*other), at)) {
            is_hidden[at] |= id < ids[at];
        }
    }
    let mut hidden = is_hidden.into_iter();
    ids.retain(|_| !hidden.next().unwrap_or_default());
    ids.sort_unstable();
}

/// Checks the material of the ground, which is the first one, and the materials of the spheres.
fn check_materials(tables: &Tables<'_>, scene: &Scene) -> Result<(), UploadError> {
    let rows = scene.checked_appearance().material_rows();
    let surfaces: Vec<SurfaceProperties> = rows.iter().map(|row| row.surface).collect();
    let energies = EnergyTables::of(&surfaces);
    let ground = SurfaceProperties::default();
    let records = std::iter::once((&ground, [1.0; 3], None))
        .chain(rows.iter().zip(&energies.starts).map(|(row, start)| (&row.surface, row.color.to_array(), *start)));
    for (index, (surface, color, start)) in records.enumerate() {
        let at = tables.lighting.material_first.saturating_add(2 * index as u32);
        let [kind, _, _, first] = tables.words(at);
        let [_, parameter, alpha, _] = tables.numbers(at);
        let [x, y, z, opacity] = tables.numbers(at.saturating_add(1));
        let absorption = [x, y, z];
        let (expected, roughness, absorbed) = match surface.material {
            Material::Lambert { specular, roughness } => (specular, roughness, [0.0; 3]),
            Material::Conductor { roughness } => (1.0, roughness, [0.0; 3]),
            Material::Dielectric { ior, roughness, attenuation_distance } => {
                let absorbed = attenuation_distance
                    .map_or([0.0; 3], |distance| color.map(|c| -f64::from(c).max(1e-4).ln() / f64::from(distance)));
                (ior, roughness, absorbed)
            }
            Material::Emissive { strength } => (strength, 0.0, [0.0; 3]),
        };
        let expected_alpha = f64::from(roughness) * f64::from(roughness);
        let is_right = kind == codes::of_material(&surface.material)
            && is_near(parameter, expected.into())
            && is_near(alpha, expected_alpha)
            && are_near(absorption, absorbed)
            && is_near(opacity, surface.opacity.into())
            && start.is_none_or(|start| has_energies(tables, first, &energies, start, surface));
        if !is_right {
            return Err(wrong_entry("material", index));
        }
    }
    Ok(())
}

/// Whether the energy tables of a material are at its index.
fn has_energies(
    tables: &Tables<'_>,
    first: u32,
    energies: &EnergyTables,
    start: u32,
    surface: &SurfaceProperties,
) -> bool {
    let count = match surface.material {
        Material::Dielectric { .. } => 2 * ENERGIES,
        _ => ENERGIES,
    };
    (0..count).all(|entry| {
        let found = tables.numbers(first.saturating_add(entry / 4))[(entry % 4) as usize];
        let asked = energies.entries.get((start + entry) as usize);
        asked.is_some_and(|asked| found.to_bits() == asked.to_bits())
    })
}
