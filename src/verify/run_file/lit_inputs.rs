//! What a device was given for a lit picture, and what was requested, as arrays.

use std::collections::BTreeMap;
use std::io;
use std::sync::Arc;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::container::{Array, Container, contradiction, sink_into};
use super::error::{RunFileError, hex};
use crate::image::color::LinearRgb;
use crate::light::SkyLight;
use crate::light::environment::Environment;
use crate::render::RenderSettings;
use crate::text::shortened;
use crate::verify::lit::recording::{LitInputs, UploadedLighting, UploadedSky};
use crate::verify::recording::UploadedView;

/// The metadata key of the digest of what was requested.
const REQUEST: &str = "request_sha256";

/// The metadata keys of what was requested, and of what the device was given, as JSON.
const SETTINGS: &str = "requested";
const GIVEN: &str = "given";

/// The arrays of what was requested, of which some may be absent.
const REQUESTED: [&str; 9] = [
    "camera",
    "color_index",
    "color_rgba8",
    "palette",
    "scene_origin",
    "sky_texels",
    "spheres",
    "surface_index",
    "surfaces",
];

/// What was requested, as JSON. The image of a sky is in arrays.
#[derive(Serialize, Deserialize)]
struct Requested {
    settings: RenderSettings,
    sky_image: Option<SkyImage>,
}

/// How the image of a sky is used.
#[derive(Serialize, Deserialize)]
struct SkyImage {
    strength: f32,
    rotation: f64,
}

/// What the device was given, as JSON.
#[derive(Serialize, Deserialize)]
struct Given {
    max_surfaces: u32,
    lighting: UploadedLighting,
}

/// The arrays that are computed from a [`LitInputs`].
pub(super) struct LitArrays<'a> {
    given: &'a LitInputs,
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
        Self { given, view: view_numbers(&given.uploaded), sky }
    }

    /// Adds the arrays and texts to those of a file.
    pub(super) fn add_to<'b>(
        &'b self,
        arrays: &mut Vec<Array<'b>>,
        texts: &mut BTreeMap<String, String>,
    ) -> io::Result<()> {
        let LitInputs { settings, uploaded, occluders, lighting, tables, emitters, .. } =
            self.given;
        let mut settings = settings.clone();
        let sky_image = match settings.sky.light {
            SkyLight::Image { strength, rotation, .. } => {
                settings.sky.light = SkyLight::Constant(LinearRgb::BLACK);
                Some(SkyImage { strength, rotation })
            }
            SkyLight::Constant(_) | SkyLight::Gradient { .. } => None,
        };
        let requested = Requested { settings, sky_image };
        let max_surfaces = self.given.max_surfaces;
        let given = Given { max_surfaces, lighting: lighting.clone() };
        texts.insert(SETTINGS.to_owned(), serde_json::to_string(&requested)?);
        texts.insert(GIVEN.to_owned(), serde_json::to_string(&given)?);
        arrays.extend([
            Array::new("lit_view", &[7], &self.view, |vector| *vector),
            Array::new("lit_advance", &[1], std::slice::from_ref(&uploaded.advance), |x| [*x]),
            Array::new("occluders", &[2], occluders, |corner| *corner),
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
    for key in ["camera", "y_axis", SETTINGS] {
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
    let Requested { mut settings, sky_image } = json(file, SETTINGS)?;
    if let Some(SkyImage { strength, rotation }) = sky_image {
        settings.sky.light = SkyLight::Image { environment: sky(file)?, strength, rotation };
    }
    let Given { max_surfaces, lighting } = json(file, GIVEN)?;
    let words = |name| file.items::<u32, 4>(name, &[length(name)?]);
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
        max_surfaces,
        lighting,
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

/// A text that is JSON.
fn json<T: DeserializeOwned>(file: &Container<'_>, key: &str) -> Result<T, RunFileError> {
    serde_json::from_str(file.text(key)?).map_err(|error| {
        contradiction(format!("the text `{key}`: {}", shortened(&error.to_string())))
    })
}
