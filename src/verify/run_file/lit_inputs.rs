//! The request and the inputs of the device for a lit picture, as arrays.

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
use crate::recording::UploadedView;
use crate::recording::lit::{LitInputs, UploadedLighting, UploadedSky};
use crate::render::RenderSettings;
use crate::text::shortened;

/// The metadata key of the digest of the request.
const REQUEST: &str = "request_sha256";

/// The metadata keys of the request and of the inputs of the device, as JSON.
const SETTINGS: &str = "requested";
const GIVEN: &str = "given";

/// The arrays of the request, of which some may be absent.
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

/// The request, as JSON. The image of a sky is in arrays.
#[derive(Serialize, Deserialize)]
struct LitRequest {
    settings: RenderSettings,
    sky_image: Option<SkyImage>,
}

/// The use of the image of a sky.
#[derive(Serialize, Deserialize)]
struct SkyImage {
    strength: f32,
    rotation: f64,
}

/// The inputs of the device, as JSON.
#[derive(Serialize, Deserialize)]
struct DeviceInputs {
    max_surfaces: u32,
    lighting: UploadedLighting,
}

/// Adds the arrays and texts of a device's inputs to the arrays and texts of a file.
pub(super) fn add<'a>(
    given: &'a LitInputs,
    arrays: &mut Vec<Array<'a>>,
    texts: &mut BTreeMap<String, String>,
) -> io::Result<()> {
    let LitInputs { settings, occluders, lighting, tables, emitters, .. } = given;
    let mut requested = LitRequest { settings: settings.clone(), sky_image: None };
    if let SkyLight::Image { strength, rotation, .. } = settings.sky.light {
        requested.settings.sky.light = SkyLight::Constant(LinearRgb::BLACK);
        requested.sky_image = Some(SkyImage { strength, rotation });
    }
    let on_device = DeviceInputs { max_surfaces: given.max_surfaces, lighting: lighting.clone() };
    texts.insert(SETTINGS.to_owned(), serde_json::to_string(&requested)?);
    texts.insert(GIVEN.to_owned(), serde_json::to_string(&on_device)?);
    arrays.extend(view_arrays(&given.uploaded, ["lit_view", "lit_advance"]));
    arrays.extend([
        Array::list("occluders", occluders, |corner| *corner),
        Array::list("tables", tables, |four| *four),
        Array::list("emitters", emitters, |four| *four),
    ]);
    if let (SkyLight::Image { environment, .. }, Some(UploadedSky { texels, shares })) =
        (&settings.sky.light, &given.sky)
    {
        let shape = [environment.height(), environment.width()].map(|side| side as usize);
        arrays.push(Array::new("sky_texels", &shape, environment.texels(), |texel| *texel));
        let tables = environment.rows().iter().chain(environment.columns());
        if texels != environment.texels() || !shares.iter().eq(tables) {
            arrays.extend([
                Array::list("sky_uploaded", texels, |texel| *texel),
                Array::list("sky_shares", shares, |share| [*share]),
            ]);
        }
    }
    let emit = |name: &str, digest: &mut Sha256| {
        let array = arrays.iter().find(|array| array.name == name);
        array.map(|array| array.emit(&mut sink_into(digest))).transpose().map(|found| found.is_some())
    };
    let digest = request(texts, emit)?;
    texts.insert(REQUEST.to_owned(), digest);
    Ok(())
}

/// The digest of the request. `emit` adds the bytes of an array, and returns whether it exists.
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

pub(super) fn view_arrays<'a>(view: &UploadedView, [name, advance]: [&'static str; 2]) -> [Array<'a>; 2] {
    let UploadedView { origin, right, up, forward, numbers, scene_min, scene_max, .. } = *view;
    let vectors = vec![origin, right, up, forward, numbers, scene_min, scene_max];
    [Array::list(name, vectors, |vector| *vector), Array::list(advance, vec![view.advance], |advance| [*advance])]
}

pub(super) fn view(file: &Container<'_>, [view, advance]: [&str; 2]) -> Result<UploadedView, RunFileError> {
    let [origin, right, up, forward, numbers, scene_min, scene_max] = file.fixed(view)?;
    let advance = file.numbers::<f32>(advance, &[1])?.first().copied().unwrap_or_default();
    Ok(UploadedView { origin, advance, right, up, forward, numbers, scene_min, scene_max })
}

/// Reads the inputs of a device, as yet without the rectangle of a sample. `picture` has the requested camera and film.
pub(super) fn read(file: &Container<'_>, picture: &crate::verify::Recording) -> Result<LitInputs, RunFileError> {
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
    let LitRequest { mut settings, sky_image } = json(file, SETTINGS)?;
    if let Some(SkyImage { strength, rotation }) = sky_image {
        settings.sky.light = SkyLight::Image { environment: sky(file)?, strength, rotation };
    }
    let DeviceInputs { max_surfaces, lighting } = json(file, GIVEN)?;
    let uploaded_sky = match &settings.sky.light {
        SkyLight::Image { environment, .. } => Some(if file.has("sky_uploaded") {
            UploadedSky {
                texels: file.list("sky_uploaded")?,
                shares: file.list::<f32, 1>("sky_shares")?.into_flattened(),
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
        tables: file.list("tables")?,
        emitters: file.list("emitters")?,
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

fn json<T: DeserializeOwned>(file: &Container<'_>, key: &str) -> Result<T, RunFileError> {
    serde_json::from_str(file.text(key)?)
        .map_err(|error| contradiction(format!("the text `{key}`: {}", shortened(&error.to_string()))))
}
