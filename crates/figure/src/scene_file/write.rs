//! Writes scene files: film, camera, settings and spheres as TOML text with every value settled.

use std::fmt::Write as _;

use toml::Value;

use super::data::Data;
use super::span::name_of;
use crate::annotate::{AnnotationPlan, LegendPlan, Position, ScaleBarPlan};
use crate::color_by::{ColorBy, Limit, Limits, MISSING, Mapping};
use crate::settings::quoted;
use pinhole::camera::CameraParameters;
use pinhole::camera::film::Film;
use pinhole::image::color::LinearRgb;
use pinhole::image::encoding::Encoding;
use pinhole::internals::exact::degrees;
use pinhole::light::{Ground, Light, LightKind, Sky, SkyLight};
use pinhole::render::{Integrator, RenderSettings, Sampling, Studio};
use pinhole::scene::material::{Material, SurfaceProperties};
use pinhole::scene::sphere::Sphere;
use pinhole_data::added::BondLength;

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
            let lights = name_of(&path.light_sampling);
            out(format!(
                "\n[path]\nmax_depth = {}\nroulette_from = {}\nlight_sampling = \"{lights}\"",
                path.max_depth, path.roulette_from
            ));
            out(sky(&settings.sky, contents.sky_image.as_deref()));
        }
    }
    for element in contents.data.iter().flat_map(|data| &data.elements) {
        let base = contents.data.as_ref().map(|data| data.surface).unwrap_or_default();
        out(format!("\n[elements.{}]", quoted(&element.name)));
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

fn inline(value: &Value) -> String {
    let joined = |parts: Vec<String>| parts.join(", ");
    match value {
        Value::Float(number) => format!("{number:?}"),
        Value::Integer(number) => number.to_string(),
        Value::Boolean(is) => is.to_string(),
        Value::String(text) => quoted(text),
        Value::Datetime(time) => time.to_string(),
        Value::Array(list) => format!("[{}]", joined(list.iter().map(inline).collect())),
        Value::Table(table) => {
            let keys = table.iter().map(|(key, value)| format!("{key} = {}", inline(value)));
            format!("{{ {} }}", joined(keys.collect()))
        }
    }
}

fn output(encoding: &Encoding) -> String {
    let (exposure, tone) = (encoding.exposure(), encoding.tone.name());
    let (bits, transparent) = (encoding.bits.count(), encoding.transparent);
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
    let Studio { ambient, shadows, max_surfaces, .. } = studio;
    let mut text = format!(
        "\n[studio]\nambient = {}\nshadows = {shadows}\nmax_surfaces = {max_surfaces}",
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
        let degrees = degrees::of(outline.angle.into(), |found| {
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
    let at = name_of(&light.frame);
    match light.kind {
        LightKind::Head { strength } => format!("kind = \"head\", color = {}", color(strength)),
        LightKind::Directional { toward, strength, angular_radius } => format!(
            "kind = \"directional\", at = \"{at}\", toward = {}, color = {}, angular_radius = {:?}",
            vector(toward),
            color(strength),
            degrees::of(angular_radius, |found| found.to_bits() == angular_radius.to_bits())
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
            quoted(image.unwrap_or_default()),
            degrees::of(*rotation, |found| found.to_bits() == rotation.to_bits())
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

/// A colour: in 8-bit sRGB if that is exact, and as a linear triple otherwise.
fn color(color: LinearRgb) -> String {
    let [r, g, b] = color.to_srgb8();
    if LinearRgb::from_srgb8([r, g, b]) == color {
        return format!("\"#{r:02x}{g:02x}{b:02x}\"");
    }
    format!("{:?}", color.to_array())
}

fn strings(list: &[String]) -> String {
    let quoted: Vec<String> = list.iter().map(|one| quoted(one)).collect();
    format!("[{}]", quoted.join(", "))
}

/// Surface properties that have a name in the file.
#[derive(Default)]
struct Surfaces(Vec<SurfaceProperties>);

impl Surfaces {
    /// The key for surface properties, unless they are those that hold without one.
    fn key(&mut self, surface: SurfaceProperties, base: SurfaceProperties) -> Option<String> {
        if surface == base {
            return None;
        }
        let known = self.0.iter().position(|one| *one == surface);
        let index = known.unwrap_or_else(|| {
            self.0.push(surface);
            self.0.len() - 1
        });
        Some(format!("material = \"surface-{index}\""))
    }

    fn tables(&self) -> Vec<String> {
        let table = |(index, surface): (usize, &SurfaceProperties)| {
            let opacity = surface.opacity;
            let keys = match surface.material {
                Material::Lambert { specular, roughness } => {
                    format!(
                        "kind = \"lambert\"\nspecular = {specular:?}\nroughness = {roughness:?}"
                    )
                }
                Material::Conductor { roughness } => {
                    format!("kind = \"conductor\"\nroughness = {roughness:?}")
                }
                Material::Dielectric { ior, roughness, attenuation_distance } => {
                    let attenuation = attenuation_distance
                        .map_or(String::new(), |far| format!("\nattenuation_distance = {far:?}"));
                    format!(
                        "kind = \"dielectric\"\nior = {ior:?}\nroughness = {roughness:?}{attenuation}"
                    )
                }
                Material::Emissive { strength } => {
                    format!("kind = \"emissive\"\nstrength = {strength:?}")
                }
            };
            format!("\n[materials.surface-{index}]\n{keys}\nopacity = {opacity:?}")
        };
        self.0.iter().enumerate().map(table).collect()
    }
}

fn data_keys(data: &Data, surfaces: &mut Surfaces) -> Vec<String> {
    let mut lines = vec![format!("data = {}", quoted(&data.file))];
    lines.extend(data.format.as_ref().map(|name| format!("format = {}", quoted(name))));
    lines.extend(data.frame.map(|frame| format!("frame = {frame}")));
    lines.extend(data.topology.as_ref().map(|file| format!("topology = {}", quoted(file))));
    if !data.columns.is_empty() {
        lines.push(format!("columns = {}", strings(&data.columns)));
    }
    lines.extend(data.radius.map(|radius| format!("radius = {radius:?}")));
    if data.radius_scale.to_bits() != 1.0_f64.to_bits() {
        lines.push(format!("radius_scale = {:?}", data.radius_scale));
    }
    lines.extend(data.color.map(|one| format!("color = {}", color(one))));
    lines.extend(surfaces.key(data.surface, SurfaceProperties::default()));
    if !data.elements_by.is_empty() {
        lines.push(format!("elements_by = {}", strings(&data.elements_by)));
    }
    if !data.leave_out.is_empty() {
        let columns = data.leave_out.iter();
        let columns = columns.map(|(name, list)| format!("{} = {}", quoted(name), strings(list)));
        lines.push(format!("leave_out = {{ {} }}", columns.collect::<Vec<_>>().join(", ")));
    }
    lines.extend(
        data.select.as_ref().map(|select| format!("select = {}", quoted(&select.to_string()))),
    );
    mapping_keys(&data.mapping, &mut lines);
    lines.extend(data.additions.cell.as_ref().map(|cell| match cell.width {
        Some(width) => format!("box = {{ width = {width:?} }}"),
        None => "box = true".to_owned(),
    }));
    lines.extend(data.additions.bonds.as_ref().map(|bonds| match bonds.length {
        BondLength::Covalent(factor) => format!("bonds = {factor:?}"),
        BondLength::Below(length) => format!("bonds = {{ length = {length:?} }}"),
    }));
    lines
}

fn mapping_keys(mapping: &Mapping, lines: &mut Vec<String>) {
    let Mapping { color, radius, opacity, emission } = mapping;
    lines.extend(color.as_ref().map(color_by));
    let with_factor = |key: &str, column: &str, factor: f64| {
        format!("{key} = {{ column = {}, factor = {factor:?} }}", quoted(column))
    };
    lines.extend(radius.as_ref().map(|by| with_factor("radius_by", &by.column, by.factor)));
    lines.extend(opacity.as_ref().map(|column| format!("opacity_by = {}", quoted(column))));
    lines.extend(emission.as_ref().map(|by| with_factor("emission_by", &by.column, by.factor)));
}

fn color_by(by: &ColorBy) -> String {
    // Categories are given only between the frames of a movie.
    let ColorBy { column, map, is_reversed, limits, is_log, missing, categories: _ } = by;
    let mut keys = vec![format!("column = {}", quoted(column))];
    keys.extend(map.map(|map| {
        let ending = if map.is_reversed() { "_r" } else { "" };
        format!("map = \"{}{ending}\"", map.name())
    }));
    if *is_reversed {
        keys.push("reverse = true".to_owned());
    }
    if *limits != Limits::default() {
        let limit = |limit| match limit {
            Limit::Automatic => "\"\"".to_owned(),
            Limit::Value(value) => format!("{value:?}"),
            Limit::Percentile(percent) => format!("\"{percent:?}%\""),
        };
        keys.push(format!("range = [{}, {}]", limit(limits.low), limit(limits.high)));
    }
    if *is_log {
        keys.push("log = true".to_owned());
    }
    if *missing != MISSING {
        keys.push(format!("missing = {}", color(LinearRgb::from_srgb8(*missing))));
    }
    format!("color_by = {{ {} }}", keys.join(", "))
}

fn annotations(plan: &AnnotationPlan) -> Vec<String> {
    let AnnotationPlan { legend, scale_bar, labels, text_scale, color: text_color, panel } = plan;
    let at = |at: Option<Position>| at.map(|at| format!("position = {}", position(at)));
    let table = |header: &str, keys: Vec<Option<String>>| {
        let lines = [Some(format!("\n{header}"))].into_iter().chain(keys).flatten();
        lines.collect::<Vec<_>>().join("\n")
    };
    let mut tables = Vec::new();
    tables.extend(legend.as_ref().map(|LegendPlan { title, position }| {
        let title = title.as_ref().map(|title| format!("title = {}", quoted(title)));
        table("[legend]", vec![title, at(*position)])
    }));
    tables.extend(scale_bar.as_ref().map(|ScaleBarPlan { length, unit, position }| {
        let length = length.map(|length| format!("length = {length:?}"));
        let unit = (!unit.is_empty()).then(|| format!("unit = {}", quoted(unit)));
        table("[scale_bar]", vec![length, unit, at(*position)])
    }));
    tables.extend(labels.iter().map(|label| {
        let text = format!("text = {}", quoted(&label.text));
        table("[[labels]]", vec![Some(text), at(Some(label.position))])
    }));
    let text = vec![
        text_scale.map(|scale| format!("scale = {scale:?}")),
        text_color.map(|one| format!("color = {}", color(LinearRgb::from_srgb8(one)))),
        panel.map(|panel| format!("panel = \"{}\"", name_of(&panel))),
    ];
    if text.iter().any(Option::is_some) {
        tables.push(table("[text]", text));
    }
    tables
}

fn position(position: Position) -> String {
    match position {
        Position::Anchor(anchor) => format!("\"{}\"", anchor.name()),
        Position::At([x, y]) => format!("[{x:?}, {y:?}]"),
    }
}
