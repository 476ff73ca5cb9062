//! Reading of run files.

use std::io::{Cursor, Read, Seek};

use glam::DVec3;

use crate::camera::film::{Film, YAxis};
use crate::camera::{CameraKind, CameraVectors};
use crate::image::Image;
use crate::image::color::LinearRgb;
use crate::parallel::try_map;
use crate::render::{PrimarySettings, Shading};
use crate::scene::material::{Material, SurfaceProperties};
use crate::scene::{Appearance, Colors, ConeInFrame, Scene};
use crate::text::shortened;
use crate::verify::run_file::container::{Container, Flag, contradiction};
use crate::verify::run_file::{LIMIT, Provenance, Run, RunFileError, scene_sha256};
use crate::verify::{PlainRender, Recording, RequestedCamera, TracedPixel, TracedRay, UploadedView};

/// Reads a run file in memory.
///
/// # Errors
/// Returns an error if the bytes are not a run file, have another version, or were altered, or if scene, film, camera
/// or settings are not valid.
pub fn read(bytes: &[u8]) -> Result<Run, RunFileError> {
    read_from(&mut Cursor::new(bytes))
}

/// Reads a run file. All of it is read once for its digest, before the arrays are read.
///
/// # Errors
/// Returns the same errors as [`read`], and an error if the file cannot be read.
pub fn read_from<S: Read + Seek>(source: &mut S) -> Result<Run, RunFileError> {
    let file = &Container::open(source)?;
    Ok(Run { scene: scene(file)?, recording: recording(file)?, provenance: provenance(file)? })
}

fn scene(file: &Container<'_>) -> Result<Scene, RunFileError> {
    let [origin] = file.fixed::<f64, 3, 1>("scene_origin")?;
    let spheres = file.list::<f32, 4>("spheres")?;
    let cones = if file.has("cones") { file.list::<f32, 8>("cones")? } else { Vec::new() };
    let count = spheres.len() + cones.len();
    let colors = colors(file, count)?;
    let appearance = with_surfaces(file, colors.into(), count)?;
    let cones: Vec<ConeInFrame> = bytemuck::cast_vec(cones);
    let scene = Scene::from_frame(DVec3::from(origin), (spheres, cones), appearance)
        .map_err(|error| contradiction(format!("the scene: {error}")))?;
    if file.text("scene_sha256")? != scene_sha256(&scene) {
        return Err(contradiction("`scene_sha256` is not the digest of the shapes"));
    }
    Ok(scene)
}

fn colors(file: &Container<'_>, shapes: usize) -> Result<Colors, RunFileError> {
    if file.has("color_rgba8") {
        return Ok(Colors::Rgba8(file.items::<u8, 4>("color_rgba8", &[shapes])?));
    }
    let palette: Vec<_> =
        file.list::<f32, 3>("palette")?.into_iter().map(|rgb| color("palette", rgb)).collect::<Result<_, _>>()?;
    match palette.first() {
        Some(color) if !file.has("color_index") => Ok(Colors::One(*color)),
        None => Ok(Colors::Palette { palette, indices: Vec::new() }),
        Some(_) => Ok(Colors::Palette { palette, indices: file.numbers("color_index", &[shapes])? }),
    }
}

fn recording(file: &Container<'_>) -> Result<Recording, RunFileError> {
    let film = film(file)?;
    let shape = [film.height() as usize, film.width() as usize];
    let [background] = file.fixed::<f32, 3, 1>("background")?;
    let primary = PrimarySettings {
        shading: named(file, "shading", &[Shading::Flat, Shading::Headlight], Shading::name)?,
        background: color("background", background)?,
        // Alpha is not among the layers of a run file.
        is_transparent: false,
    };
    Ok(Recording {
        camera: camera(file)?,
        uploaded: view(file)?,
        film,
        primary,
        pixels: pixels(file, &shape)?,
        image: image(file, &film, ["color", "depth", "normal", "id"])?,
        rendered: rendered(file, &film)?,
    })
}

fn view(file: &Container<'_>) -> Result<UploadedView, RunFileError> {
    let [origin, right, up, forward, numbers, scene_min, scene_max] = file.fixed("view")?;
    let advance = file.numbers::<f32>("advance", &[1])?.first().copied().unwrap_or_default();
    Ok(UploadedView { origin, advance, right, up, forward, numbers, scene_min, scene_max })
}

fn image(file: &Container<'_>, film: &Film, [color, depth, normal, id]: [&str; 4]) -> Result<Image, RunFileError> {
    let shape = [film.height() as usize, film.width() as usize];
    Image::from_layers(
        [film.width(), film.height()],
        file.items(color, &shape)?,
        file.numbers(depth, &shape)?,
        file.items(normal, &shape)?,
        file.numbers(id, &shape)?,
    )
    .ok_or_else(|| contradiction("the layers have different sizes"))
}

fn rendered(file: &Container<'_>, film: &Film) -> Result<PlainRender, RunFileError> {
    const LAYERS: [&str; 4] = ["rendered_color", "rendered_depth", "rendered_normal", "rendered_id"];
    let Ok(text) = file.text("rendered") else { return Ok(PlainRender::None) };
    match text {
        "same" => Ok(PlainRender::Same),
        "other" => image(file, film, LAYERS).map(Box::new).map(PlainRender::Other),
        other => Err(contradiction(format!("`rendered` is `{}`; it must be `same` or `other`", shortened(other)))),
    }
}

fn film(file: &Container<'_>) -> Result<Film, RunFileError> {
    let [height, width, _] = *file.shape("color")? else {
        return Err(contradiction("the array `color` does not have the shape (H, W, 3)"));
    };
    let side = |side: usize| u32::try_from(side).unwrap_or(u32::MAX);
    let film = Film::new(side(width), side(height)).map_err(|error| contradiction(format!("the picture: {error}")))?;
    Ok(film.with_y_axis(named(file, "y_axis", &[YAxis::Up, YAxis::Down], YAxis::name)?))
}

fn camera(file: &Container<'_>) -> Result<RequestedCamera, RunFileError> {
    let vectors = CameraVectors::checked(file.fixed::<f64, 3, 5>("camera")?.map(DVec3::from))
        .map_err(|error| contradiction(format!("the camera: {error}")))?;
    Ok(RequestedCamera { kind: named(file, "camera", CameraKind::ALL, CameraKind::name)?, vectors })
}

fn pixels(file: &Container<'_>, shape: &[usize]) -> Result<Vec<TracedPixel>, RunFileError> {
    let traced = rays(file, shape, "traced", "ray")?;
    let shaded = rays(file, shape, "shaded", "shading")?;
    let (t, ids) = (file.numbers("hit_t", shape)?, file.numbers("hit_id", shape)?);
    all(t.len(), |index| TracedPixel { ray: traced[index], t: t[index], id: ids[index], shading_ray: shaded[index] })
}

/// The ray of each pixel, if `flag` says that there is one.
fn rays(file: &Container<'_>, shape: &[usize], flag: &str, rays: &str) -> Result<Vec<Option<TracedRay>>, RunFileError> {
    let exist = file.numbers::<Flag>(flag, shape)?;
    if let Some(index) = exist.iter().position(|exists| exists.0 > 1) {
        return Err(contradiction(format!("the array `{flag}` has a value other than 0 and 1 at index {index}")));
    }
    let origins = file.items(&format!("{rays}_origin"), shape)?;
    let directions = file.items(&format!("{rays}_direction"), shape)?;
    let distances = file.numbers(&format!("{rays}_distance"), shape)?;
    all(exist.len(), |index| {
        let (origin, direction, distance) = (origins[index], directions[index], distances[index]);
        (exist[index].0 == 1).then_some(TracedRay { origin, direction, distance })
    })
}

/// Calls `of` for every pixel, and returns all results.
fn all<T: Send>(count: usize, of: impl Fn(usize) -> T + Sync) -> Result<Vec<T>, RunFileError> {
    let bytes = (count * size_of::<T>()) as u64;
    try_map(count, of).map_err(|_| RunFileError::Memory { name: "pixels".to_owned(), bytes })
}

fn provenance(file: &Container<'_>) -> Result<Provenance, RunFileError> {
    let limits = file.texts().filter_map(|(key, value)| {
        Some(match (key.strip_prefix(LIMIT)?, value.parse()) {
            (name, Ok(limit)) => Ok((name.to_owned(), limit)),
            (name, Err(_)) => Err(contradiction(format!("the limit `{name}` is not a valid number"))),
        })
    });
    let limits = limits.collect::<Result<_, _>>()?;
    let mut provenance = Provenance { limits, ..Provenance::default() };
    for (key, text) in provenance.texts() {
        file.text(key)?.clone_into(text);
    }
    Ok(provenance)
}

fn color(name: &str, rgb: [f32; 3]) -> Result<LinearRgb, RunFileError> {
    LinearRgb::new(rgb).map_err(|error| contradiction(format!("the array `{name}`: {error}")))
}

/// The element of `all` whose name is the text with this key.
fn named<T: Copy>(file: &Container<'_>, key: &str, all: &[T], name: fn(T) -> &'static str) -> Result<T, RunFileError> {
    let text = file.text(key)?;
    all.iter()
        .copied()
        .find(|one| name(*one) == text)
        .ok_or_else(|| contradiction(format!("there is no {key} `{}`", shortened(text))))
}

/// The inverse of [`SurfaceProperties::bits`]; `None` if there is no such kind.
fn surface([kind, a, b, c, opacity]: [f32; 5]) -> Option<SurfaceProperties> {
    let material = match kind.to_bits() {
        0 => Material::Lambert { specular: a, roughness: b },
        bits if bits == 1_f32.to_bits() => Material::Conductor { roughness: a },
        bits if bits == 2_f32.to_bits() => {
            let attenuation_distance = (c.to_bits() != 0).then_some(c);
            Material::Dielectric { ior: a, roughness: b, attenuation_distance }
        }
        bits if bits == 3_f32.to_bits() => Material::Emissive { strength: a },
        _ => return None,
    };
    Some(SurfaceProperties { material, opacity })
}

/// Adds the surfaces of a file with this number of shapes. If the file has none, they are the default.
fn with_surfaces(file: &Container<'_>, appearance: Appearance, shapes: usize) -> Result<Appearance, RunFileError> {
    if !file.has("surfaces") {
        return Ok(appearance);
    }
    let numbers = file.list::<f32, 5>("surfaces")?;
    let surfaces = (0..).zip(numbers).map(|(index, numbers): (usize, _)| {
        let no = |error: String| contradiction(format!("the surface {index}: {error}"));
        let surface = surface(numbers).ok_or_else(|| no("there is no such material".to_owned()))?;
        surface.check().map_err(|error| no(error.to_string()))?;
        Ok(surface)
    });
    let surfaces: Vec<_> = surfaces.collect::<Result<_, RunFileError>>()?;
    if file.has("surface_index") {
        let indices = file.numbers("surface_index", &[shapes])?;
        return Ok(appearance.with_surfaces(surfaces, indices));
    }
    match surfaces[..] {
        [surface] => Ok(appearance.with_surface(surface)),
        _ => Err(contradiction("there are several surfaces, but no array `surface_index`")),
    }
}
