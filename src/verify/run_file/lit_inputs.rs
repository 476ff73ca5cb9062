//! What a device was given for a lit picture, and what was requested, as arrays.

use std::collections::BTreeMap;
use std::io;
use std::sync::Arc;

use sha2::{Digest, Sha256};

use super::container::{Container, contradiction, sink_into};
use super::numbers::Array;
use super::settings::{self, LightNumbers};
use super::{RunFileError, hex};
use crate::light::SkyLight;
use crate::light::environment::Environment;
use crate::verify::lit::{LitInputs, UploadedLighting, UploadedSky};
use crate::verify::recording::UploadedView;

/// The metadata key of the digest of what was requested.
const REQUEST: &str = "request_sha256";

/// The arrays of what was requested, of which some may be absent.
const REQUESTED: [&str; 11] = [
    "camera",
    "color_index",
    "color_rgba8",
    "lights",
    "palette",
    "scene_origin",
    "settings",
    "sky_texels",
    "spheres",
    "surface_index",
    "surfaces",
];

/// The number of words of [`lighting_words`].
const WORDS: usize = 45;

/// The arrays that are computed from a [`LitInputs`].
pub(super) struct LitArrays<'a> {
    given: &'a LitInputs,
    settings: Vec<f64>,
    lights: Vec<LightNumbers>,
    lighting: [u32; WORDS],
    view: [[f32; 3]; 7],
    /// The image of the sky, and whether the device had another.
    sky: Option<(&'a Environment, &'a UploadedSky, bool)>,
}

impl<'a> LitArrays<'a> {
    pub(super) fn new(given: &'a LitInputs) -> Self {
        let sky = match (&given.settings.sky.light, &given.sky) {
            (SkyLight::Image { environment, .. }, Some(sky)) => {
                let shares = environment.rows().iter().chain(environment.columns());
                let is_other = sky.texels != environment.texels() || !sky.shares.iter().eq(shares);
                Some((&**environment, sky, is_other))
            }
            _ => None,
        };
        Self {
            given,
            settings: settings::numbers(&given.settings),
            lights: given.settings.lights.iter().map(settings::light_numbers).collect(),
            lighting: lighting_words(&given.lighting),
            view: view_numbers(&given.uploaded),
            sky,
        }
    }

    /// Adds the arrays and texts to those of a file.
    pub(super) fn add_to<'b>(
        &'b self,
        arrays: &mut Vec<Array<'b>>,
        texts: &mut BTreeMap<String, String>,
    ) -> io::Result<()> {
        let LitInputs { uploaded, occluders, lighting, tables, emitters, max_surfaces, .. } =
            self.given;
        texts.insert("max_surfaces".to_owned(), max_surfaces.to_string());
        arrays.extend([
            Array::new("settings", &[self.settings.len()], &self.settings, |number| [*number]),
            Array::new("lights", &[self.lights.len()], &self.lights, |light| *light),
            Array::new("lit_view", &[7], &self.view, |vector| *vector),
            Array::new("lit_advance", &[1], std::slice::from_ref(&uploaded.advance), |x| [*x]),
            Array::new("occluders", &[2], occluders, |corner| *corner),
            Array::new("lighting", &[WORDS], &self.lighting, |word| [*word]),
            Array::new("filter", &[lighting.filter_table.len()], &lighting.filter_table, |x| [*x]),
            Array::new("tables", &[tables.len()], tables, |four| *four),
            Array::new("emitters", &[emitters.len()], emitters, |four| *four),
        ]);
        if let Some((environment, uploaded, is_other)) = self.sky {
            let shape = [environment.height(), environment.width()].map(|side| side as usize);
            arrays.push(Array::new("sky_texels", &shape, environment.texels(), |texel| *texel));
            if is_other {
                let UploadedSky { texels, shares } = uploaded;
                arrays.extend([
                    Array::new("sky_uploaded", &[texels.len()], texels, |texel| *texel),
                    Array::new("sky_shares", &[shares.len()], shares, |share| [*share]),
                ]);
            }
        }
        let emit = |name: &str, digest: &mut Sha256| {
            let array = arrays.iter().find(|array| array.name == name);
            array
                .map(|array| array.emit(&mut sink_into(digest)))
                .transpose()
                .map(|found| found.is_some())
        };
        let digest = request(texts, emit)?;
        texts.insert(REQUEST.to_owned(), digest);
        Ok(())
    }
}

/// The digest of what was requested. `emit` adds the bytes of an array, and says whether there is one.
fn request<E>(
    texts: &BTreeMap<String, String>,
    emit: impl Fn(&str, &mut Sha256) -> Result<bool, E>,
) -> Result<String, E> {
    let mut all = Sha256::new();
    for key in ["camera", "y_axis"] {
        all.update(texts.get(key).map(String::as_bytes).unwrap_or_default());
        all.update([0]);
    }
    for name in REQUESTED {
        let mut one = Sha256::new();
        if emit(name, &mut one)? {
            all.update(name);
            all.update(one.finalize());
        }
    }
    Ok(hex(all))
}

/// The vectors of a view as they are stored.
pub(super) fn view_numbers(view: &UploadedView) -> [[f32; 3]; 7] {
    let UploadedView { origin, advance: _, right, up, forward, numbers, scene_min, scene_max } =
        *view;
    [origin, right, up, forward, numbers, scene_min, scene_max]
}

/// Reads a view from the arrays with these names.
pub(super) fn view(
    file: &Container<'_>,
    [view, advance]: [&str; 2],
) -> Result<UploadedView, RunFileError> {
    let [origin, right, up, forward, numbers, scene_min, scene_max] = file.fixed(view)?;
    let advance = file.numbers::<f32>(advance, &[1])?.first().copied().unwrap_or_default();
    Ok(UploadedView { origin, advance, right, up, forward, numbers, scene_min, scene_max })
}

/// Reads what a device was given; the rectangle is that of no sample yet. `picture` has the requested camera and film.
pub(super) fn read(
    file: &Container<'_>,
    picture: &crate::verify::Recording,
) -> Result<LitInputs, RunFileError> {
    let texts = file.texts().map(|(key, text)| (key.clone(), text.clone())).collect();
    let emit = |name: &str, digest: &mut Sha256| {
        let has = file.has(name);
        if has {
            file.emit(name, &mut sink_into(digest))?;
        }
        Ok::<_, RunFileError>(has)
    };
    if request(&texts, emit)? != file.text(REQUEST)? {
        return Err(contradiction(
            "the light is not that of this scene and these settings: `request_sha256` is not their digest",
        ));
    }
    let length = |name| file.shape(name).map(|shape| shape.first().copied().unwrap_or_default());
    let [settings, lights] = ["settings", "lights"].map(length);
    let settings = file.numbers::<f64>("settings", &[settings?])?;
    let lights = file.items::<f64, 9>("lights", &[lights?])?;
    let settings = settings::settings(&settings, &lights, || sky(file))?;
    let words = |name| file.items::<u32, 4>(name, &[length(name)?]);
    let filter_table = file.numbers("filter", &[length("filter")?])?;
    let uploaded_sky = match &settings.sky.light {
        SkyLight::Image { environment, .. } => Some(if file.has("sky_uploaded") {
            UploadedSky {
                texels: file.items("sky_uploaded", &[length("sky_uploaded")?])?,
                shares: file.numbers("sky_shares", &[length("sky_shares")?])?,
            }
        } else {
            let shares = environment.rows().iter().chain(environment.columns());
            UploadedSky { texels: environment.texels().to_vec(), shares: shares.copied().collect() }
        }),
        _ => None,
    };
    Ok(LitInputs {
        camera: picture.camera,
        uploaded: view(file, ["lit_view", "lit_advance"])?,
        occluders: file.fixed("occluders")?,
        film: picture.film,
        origin: [0; 2],
        size: [0; 2],
        settings,
        max_surfaces: file.whole("max_surfaces")?,
        lighting: lighting(
            file.fixed::<u32, 1, WORDS>("lighting")?.map(|[word]| word),
            filter_table,
        ),
        tables: words("tables")?,
        emitters: words("emitters")?,
        sky: uploaded_sky,
    })
}

fn sky(file: &Container<'_>) -> Result<Arc<Environment>, RunFileError> {
    let [height, width, _] = *file.shape("sky_texels")? else {
        return Err(contradiction("the array `sky_texels` does not have the shape (H, W, 3)"));
    };
    let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
    let texels = file.items("sky_texels", &[height, width])?;
    let environment = Environment::new(side(width), side(height), texels);
    environment.map(Arc::new).map_err(|error| contradiction(format!("the sky: {error}")))
}

/// The parameters as bits, in the order of their fields.
fn lighting_words(lighting: &UploadedLighting) -> [u32; WORDS] {
    let UploadedLighting {
        background,
        flags,
        light_count,
        zenith,
        horizon,
        nadir,
        roulette_from,
        source_count,
        light_sampling,
        ground_normal,
        ground_point,
        ground_color,
        seed,
        emitter_count,
        material_first,
        environment_size,
        environment_rotation,
        environment_strength,
        ambient,
        cue_color,
        cue_near,
        cue_scale,
        occlusion_radius,
        occlusion_samples,
        lamp_sources,
        filter_table: _,
    } = lighting;
    let mut words = Vec::with_capacity(WORDS);
    let bits = |numbers: &[f32]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    words.extend(bits(background));
    words.extend([*flags, *light_count]);
    words.extend([zenith, horizon, nadir].into_iter().flat_map(|color| bits(color)));
    words.extend([*roulette_from, *source_count, *light_sampling]);
    words.extend([ground_normal, ground_point, ground_color].into_iter().flat_map(|v| bits(v)));
    words.extend([*seed, *emitter_count, *material_first]);
    words.extend(environment_size);
    words.extend(bits(environment_rotation));
    words.extend(bits(&[*environment_strength]));
    words.extend([ambient, cue_color].into_iter().flat_map(|color| bits(color)));
    words.extend(bits(&[*cue_near, *cue_scale, *occlusion_radius]));
    words.extend([*occlusion_samples, *lamp_sources]);
    std::array::from_fn(|index| words.get(index).copied().unwrap_or_default())
}

/// The inverse of [`lighting_words`].
fn lighting(words: [u32; WORDS], filter_table: Vec<f32>) -> UploadedLighting {
    let mut all = words.into_iter();
    let mut word = || all.next().unwrap_or_default();
    let mut lighting = UploadedLighting { filter_table, ..UploadedLighting::default() };
    let number = f32::from_bits;
    lighting.background = std::array::from_fn(|_| number(word()));
    (lighting.flags, lighting.light_count) = (word(), word());
    for color in [&mut lighting.zenith, &mut lighting.horizon, &mut lighting.nadir] {
        *color = std::array::from_fn(|_| number(word()));
    }
    (lighting.roulette_from, lighting.source_count) = (word(), word());
    lighting.light_sampling = word();
    let UploadedLighting { ground_normal, ground_point, ground_color, .. } = &mut lighting;
    for vector in [ground_normal, ground_point, ground_color] {
        *vector = std::array::from_fn(|_| number(word()));
    }
    (lighting.seed, lighting.emitter_count) = (word(), word());
    lighting.material_first = word();
    lighting.environment_size = [word(), word()];
    lighting.environment_rotation = [number(word()), number(word())];
    lighting.environment_strength = number(word());
    for color in [&mut lighting.ambient, &mut lighting.cue_color] {
        *color = std::array::from_fn(|_| number(word()));
    }
    (lighting.cue_near, lighting.cue_scale) = (number(word()), number(word()));
    lighting.occlusion_radius = number(word());
    (lighting.occlusion_samples, lighting.lamp_sources) = (word(), word());
    lighting
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_become_the_same_words_again() {
        let words = std::array::from_fn(|index| 0x3f80_0000 + index as u32);
        assert_eq!(lighting_words(&lighting(words, Vec::new())), words);
    }
}
