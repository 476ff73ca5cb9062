//! Writes scene files: film, camera, settings and spheres as TOML text with every value settled.

use std::fmt::Write as _;

use toml::Value;

use super::data::Data;
use super::write_annotations::annotations;
use super::write_data::data_keys;
use super::write_surfaces::Surfaces;
use super::write_values::{color, degrees_of, string};
use crate::annotate::AnnotationPlan;
use crate::camera::CameraParameters;
use crate::camera::film::Film;
use crate::image::encoding::Encoding;
use crate::light::{Ground, Light, LightFrame, LightKind, Sky, SkyLight};
use crate::render::{Integrator, LightSampling, RenderSettings, Sampling, Studio};
use crate::scene::material::SurfaceProperties;
use crate::scene::sphere::Sphere;

/// Everything that a scene file can say.
#[derive(Clone, Debug)]
pub struct Contents<'a> {
    /// Size of the picture, and the direction of its y axis.
    pub film: Film,
    /// How the picture is encoded.
    pub encoding: Encoding,
    /// What is drawn over the picture.
    pub annotations: AnnotationPlan,
    /// The camera. Without a position, it would frame the scene again.
    pub camera: CameraParameters,
    /// All settings for rendering.
    pub settings: &'a RenderSettings,
    /// The path of the image of the sky, relative to the file, if the sky is one.
    pub sky_image: Option<String>,
    /// The data and its keys; the path is relative to the file.
    pub data: Option<Data>,
    /// The spheres of the file itself, which come before those of its data.
    pub spheres: Vec<Sphere>,
}

/// Writes a scene file. [`SceneFile::parse`](super::SceneFile::parse) reads the same values from it.
#[must_use]
pub fn write(contents: &Contents<'_>) -> String {
    let settings = contents.settings;
    let mut surfaces = Surfaces::default();
    let mut text = String::new();
    let mut out = |line: String| {
        text += &line;
        text.push('\n');
    };
    out(format!("integrator = \"{}\"", settings.integrator.name()));
    if let Integrator::Primary(shading) = settings.integrator {
        out(format!("shading = \"{}\"", shading.name()));
    }
    out(format!("background = {}", color(settings.background)));
    if let Some(data) = &contents.data {
        data_keys(data, &mut surfaces).into_iter().for_each(&mut out);
    }
    if !contents.spheres.is_empty() {
        out("spheres = [".to_owned());
        for sphere in &contents.spheres {
            let [x, y, z] = sphere.center;
            let surface = surfaces.key(sphere.surface, SurfaceProperties::default());
            let surface = surface.map_or(String::new(), |key| format!(", {key}"));
            let (radius, color) = (sphere.radius, color(sphere.color));
            out(format!(
                "    {{ center = [{x:?}, {y:?}, {z:?}], radius = {radius:?}, color = {color}{surface} }},"
            ));
        }
        out("]".to_owned());
    }
    if !settings.integrator.is_primary() {
        out("lights = [".to_owned());
        settings.lights.iter().for_each(|one| out(format!("    {{ {} }},", light(one))));
        out("]".to_owned());
    }
    let (width, height) = (contents.film.width(), contents.film.height());
    let y = contents.film.y_axis().name();
    out(format!("\n[film]\nwidth = {width}\nheight = {height}\ny = \"{y}\""));
    out(camera(&contents.camera));
    out(output(&contents.encoding));
    annotations(&contents.annotations).into_iter().for_each(&mut out);
    if !settings.integrator.is_primary() {
        out(sampling(&settings.sampling, settings.is_denoised));
        settings.ground.iter().for_each(|one| out(ground(one)));
    }
    match &settings.integrator {
        Integrator::Primary(_) => {}
        Integrator::Studio(one) => out(studio(one)),
        Integrator::Path(path) => {
            let lights = match path.light_sampling {
                LightSampling::Chance => "chance",
                LightSampling::Direct => "direct",
                LightSampling::Multiple => "multiple",
            };
            out(format!(
                "\n[path]\nmax_depth = {}\nroulette_from = {}\nlight_sampling = \"{lights}\"",
                path.max_depth, path.roulette_from
            ));
            out(sky(&settings.sky, contents.sky_image.as_deref()));
        }
    }
    for element in contents.data.iter().flat_map(|data| &data.elements) {
        let base = contents.data.as_ref().map(|data| data.surface).unwrap_or_default();
        out(format!("\n[elements.{}]", string(&element.name)));
        element.radius.iter().for_each(|radius| out(format!("radius = {radius:?}")));
        element.color.iter().for_each(|one| out(format!("color = {}", color(*one))));
        surfaces.key(element.surface, base).into_iter().for_each(&mut out);
    }
    surfaces.tables().into_iter().for_each(out);
    text
}

fn camera(parameters: &CameraParameters) -> String {
    // Parameters are numbers, lists and one table, which can always be written.
    let table = toml::Table::try_from(parameters).unwrap_or_default();
    let mut text = String::new();
    for (kind, keys) in &table {
        let _ = write!(text, "\n[camera.{kind}]");
        for (key, value) in keys.as_table().into_iter().flatten() {
            let _ = write!(text, "\n{key} = {}", inline(value));
        }
    }
    text
}

/// A value on one line.
fn inline(value: &Value) -> String {
    let joined = |parts: Vec<String>| parts.join(", ");
    match value {
        Value::Float(number) => format!("{number:?}"),
        Value::Integer(number) => number.to_string(),
        Value::Boolean(is) => is.to_string(),
        Value::String(text) => string(text),
        Value::Datetime(time) => time.to_string(),
        Value::Array(list) => format!("[{}]", joined(list.iter().map(inline).collect())),
        Value::Table(table) => {
            let keys = table.iter().map(|(key, value)| format!("{key} = {}", inline(value)));
            format!("{{ {} }}", joined(keys.collect()))
        }
    }
}

fn output(encoding: &Encoding) -> String {
    let (exposure, tone) = (encoding.exposure(), encoding.tone().name());
    let (bits, transparent) = (encoding.bits().count(), encoding.transparent());
    let dpi = encoding.dots_per_inch().map_or(String::new(), |dpi| format!("\ndpi = {dpi:?}"));
    format!(
        "\n[output]\nexposure = {exposure:?}\ntone = \"{tone}\"\nbits = {bits}\ntransparent = {transparent}{dpi}"
    )
}

fn sampling(sampling: &Sampling, denoise: bool) -> String {
    let Sampling { samples, seed, filter } = sampling;
    let filter = filter.name();
    format!(
        "\n[sampling]\nsamples = {samples}\nseed = {seed}\nfilter = \"{filter}\"\ndenoise = {denoise}"
    )
}

fn studio(studio: &Studio) -> String {
    let Studio { ambient, has_shadows, max_surfaces, .. } = studio;
    let mut text = format!(
        "\n[studio]\nambient = {}\nshadows = {has_shadows}\nmax_surfaces = {max_surfaces}",
        color(*ambient)
    );
    if let Some(occlusion) = &studio.occlusion {
        let _ = write!(text, "\n\n[studio.occlusion]\nsamples = {}", occlusion.samples);
        if let Some(radius) = occlusion.radius {
            let _ = write!(text, "\nradius = {radius:?}");
        }
    }
    if let Some(outline) = &studio.outline {
        let (width, depth) = (outline.width, outline.depth);
        let degrees = degrees_of(outline.angle.into(), |found| {
            (found as f32).to_bits() == outline.angle.to_bits()
        });
        let _ = write!(
            text,
            "\n\n[studio.outline]\nwidth = {width:?}\ncolor = {}\ndepth = {depth:?}\nangle = {degrees:?}",
            color(outline.color)
        );
    }
    if let Some(cue) = &studio.depth_cue {
        let (near, far) = (cue.near, cue.far);
        let _ = write!(
            text,
            "\n\n[studio.depth_cue]\nnear = {near:?}\nfar = {far:?}\ncolor = {}",
            color(cue.color)
        );
    }
    text
}

fn light(light: &Light) -> String {
    let vector = |v: glam::DVec3| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z);
    let at = match light.frame {
        LightFrame::World => "world",
        LightFrame::Camera => "camera",
    };
    match light.kind {
        LightKind::Head { strength } => format!("kind = \"head\", color = {}", color(strength)),
        LightKind::Directional { toward, strength, angular_radius } => format!(
            "kind = \"directional\", at = \"{at}\", toward = {}, color = {}, angular_radius = {:?}",
            vector(toward),
            color(strength),
            degrees_of(angular_radius, |found| found.to_bits() == angular_radius.to_bits())
        ),
        LightKind::Point { position, intensity } => format!(
            "kind = \"point\", at = \"{at}\", position = {}, color = {}",
            vector(position),
            color(intensity)
        ),
        LightKind::Sphere { center, radius, radiance } => format!(
            "kind = \"sphere\", at = \"{at}\", position = {}, radius = {radius:?}, color = {}",
            vector(center),
            color(radiance)
        ),
    }
}

fn sky(sky: &Sky, image: Option<&str>) -> String {
    let light = match &sky.light {
        SkyLight::Constant(one) => format!("kind = \"constant\"\ncolor = {}", color(*one)),
        SkyLight::Gradient { zenith, horizon, nadir } => {
            let [zenith, horizon, nadir] = [zenith, horizon, nadir].map(|one| color(*one));
            format!("kind = \"gradient\"\nzenith = {zenith}\nhorizon = {horizon}\nnadir = {nadir}")
        }
        SkyLight::Image { strength, rotation, .. } => format!(
            "kind = \"image\"\nimage = {}\nstrength = {strength:?}\nrotation = {:?}",
            string(image.unwrap_or_default()),
            degrees_of(*rotation, |found| found.to_bits() == rotation.to_bits())
        ),
    };
    format!("\n[sky]\n{light}\nvisible = {}", sky.is_visible)
}

fn ground(ground: &Ground) -> String {
    let [point, normal] = [ground.point, ground.normal].map(|v| v.to_array());
    let (color, catcher) = (color(ground.color), ground.is_shadow_catcher);
    format!(
        "\n[ground]\npoint = {point:?}\nnormal = {normal:?}\ncolor = {color}\nshadow_catcher = {catcher}"
    )
}
