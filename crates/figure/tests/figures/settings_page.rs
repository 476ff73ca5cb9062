//! `docs/reference/settings.md`: all keys of scene files, with the doc comments of the structs that have them, and all
//! flags.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

use pinhole::camera::PinholeCamera;
use pinhole_figure::scene_file::{IntegratorKind, SceneFile, Settled};
use pinhole_figure::settings::{
    self,
    flags::{FLAGS, Group},
};

const FILES: &str = "crates/figure/src/scene_file/document.rs";
const SHAPES: &str = "crates/figure/src/scene_file/shapes.rs";
const CONES: &str = "crates/figure/src/scene_file/cones.rs";
const DATA: &str = "crates/figure/src/scene_file/data.rs";
const MAPPING: &str = "crates/figure/src/color_by/mapping.rs";
const PLAN: &str = "crates/figure/src/annotate/plan.rs";
const CAMERAS: &str = "src/camera/parameters.rs";
const LIGHTS: &str = "crates/figure/src/scene_file/lighting/lights.rs";
const SKY: &str = "crates/figure/src/scene_file/lighting/sky.rs";
const INTEGRATOR: &str = "src/render/integrator.rs";
const MATERIAL: &str = "src/scene/material.rs";
const CAMERA_PATH: &str = "crates/figure/src/scene_file/camera_path.rs";

/// The tables of a scene file, each with the file and the structs that have its keys.
const TABLES: [(&str, &str, &[&str]); 37] = [
    ("", FILES, &["Document"]),
    ("elements.NAME", DATA, &["ElementTable"]),
    ("box", DATA, &["BoxTable"]),
    ("bonds", DATA, &["BondsTable"]),
    ("arrows", DATA, &["ArrowsTable"]),
    ("show", "crates/figure/src/scene_file/show.rs", &["ShowTable"]),
    ("color_by", "crates/figure/src/color_by/mod.rs", &["ColorBy"]),
    ("radius_by", MAPPING, &["RadiusBy"]),
    ("opacity_by", "crates/figure/src/scene_file/mapping.rs", &["ColumnTable"]),
    ("emission_by", MAPPING, &["EmissionBy"]),
    ("spheres", SHAPES, &["SphereTable"]),
    ("cylinders", CONES, &["CylinderTable"]),
    ("cones", CONES, &["ConeTable"]),
    ("tubes", "crates/figure/src/scene_file/tubes.rs", &["TubeTable"]),
    ("film", FILES, &["FilmTable"]),
    ("output", FILES, &["OutputTable"]),
    ("camera.pinhole", CAMERAS, &["PinholeParameters"]),
    ("camera.orthographic", CAMERAS, &["OrthographicParameters"]),
    ("camera.thin-lens", CAMERAS, &["ThinLensParameters"]),
    ("camera.panorama", CAMERAS, &["PanoramaParameters"]),
    ("camera.fisheye", CAMERAS, &["FisheyeParameters"]),
    ("camera.KIND.stereo", CAMERAS, &["StereoParameters"]),
    ("camera_path", CAMERA_PATH, &["CameraPathTable", "KeyTable"]),
    ("legend", PLAN, &["LegendPlan"]),
    ("scale_bar", PLAN, &["ScaleBarPlan"]),
    ("axes", PLAN, &["AxesPlan"]),
    ("labels", "crates/figure/src/annotate/mod.rs", &["Label"]),
    ("text", PLAN, &["TextPlan"]),
    ("sampling", "src/render/mod.rs", &["Sampling"]),
    ("studio", INTEGRATOR, &["Studio"]),
    ("studio.occlusion", INTEGRATOR, &["Occlusion"]),
    ("studio.outline", "src/image/outline.rs", &["Outline"]),
    ("studio.depth_cue", "crates/figure/src/scene_file/lighting/studio.rs", &["DepthCuePlan"]),
    ("path", INTEGRATOR, &["PathTracing"]),
    ("lights, sun", LIGHTS, &["LightTable", "DirectionalTable"]),
    ("sky, ground", SKY, &["SkyTable", "GroundTable"]),
    ("materials.NAME", MATERIAL, &["Material", "SurfaceProperties"]),
];

/// A key, as the source says it.
struct Key {
    /// The kind of the table, if the key belongs to one kind alone.
    kind: Option<String>,
    name: String,
    value: String,
    meaning: String,
}

/// The keys of a struct or of the kinds of an enum, from the text of a file.
fn keys_of(source: &str, name: &str) -> Vec<Key> {
    let is_start = |line: &&str| {
        let mut words = line.split_whitespace().skip_while(|word| !["struct", "enum"].contains(word));
        !line.starts_with(' ') && words.nth(1) == Some(name)
    };
    let lines = source.lines().skip_while(|line| !is_start(line)).skip(1);
    let (mut keys, mut docs, mut renamed, mut kind) = (Vec::new(), Vec::new(), None, None);
    let mut is_skipped = false;
    for line in lines.take_while(|line| *line != "}").map(str::trim) {
        if let Some(doc) = line.strip_prefix("/// ") {
            docs.push(doc);
        } else if line.starts_with('#') {
            is_skipped |= line.contains("serde(skip)") || line.contains("flatten");
            renamed = renamed.or(line.split_once("rename = \"").and_then(|(_, rest)| rest.split('"').next()));
        } else if let Some(variant) = line.strip_suffix(" {") {
            (kind, docs) = (Some(kebab(variant)), Vec::new());
        } else if line == "}," {
            kind = None;
        } else if let Some((key, value)) = line.trim_end_matches(',').split_once(": ") {
            let key = key.rsplit(' ').next().unwrap();
            if !is_skipped {
                let name = renamed.take().unwrap_or(key).to_owned();
                let (kind, meaning) = (kind.clone(), docs.join(" "));
                keys.push(Key { kind, name, value: shown(value).to_owned(), meaning });
            }
            (docs, renamed, is_skipped) = (Vec::new(), None, false);
        } else {
            docs.clear();
        }
    }
    keys
}

fn kebab(name: &str) -> String {
    let word = |(index, c): (usize, char)| match c.is_uppercase() && index > 0 {
        true => format!("-{}", c.to_lowercase()),
        false => c.to_lowercase().to_string(),
    };
    name.char_indices().map(word).collect()
}

/// What a value of a Rust type is in TOML.
fn shown(value: &str) -> &str {
    let kinds = [
        ("BTreeMap<String, Vec", "lists of texts by name"),
        ("BTreeMap<", "tables by name"),
        ("Materials", "tables by name"),
        ("ByColumn<", "text or table"),
        ("Occlusion", "table"),
        ("DepthCue", "table"),
        ("Outline", "table"),
        ("List<3>", "[x, y, z]"),
        ("List<2>", "[x, y]"),
        ("Pair", "[first, second]"),
        ("Vec<String>", "texts"),
        ("LinearRgb", "colour"),
        ("[u8; 3]", "colour"),
        ("String", "text"),
        ("f64", "number"),
        ("f32", "number"),
        ("u32", "whole number"),
        ("usize", "whole number"),
        ("bool", "true or false"),
        ("Table<", "table"),
        ("CameraParameters", "table"),
        ("StereoParameters", "table"),
        ("Value>", "true, false, or a table"),
        ("Limits", "two numbers or percentiles"),
        ("Position", "name, or [x, y]"),
    ];
    kinds.iter().find(|(rust, _)| value.contains(rust)).map_or("name", |(_, toml)| toml)
}

/// The values of a scene in which nothing is said, for both integrators with light.
fn defaults() -> Vec<toml::Table> {
    let texts = ["path", "studio"].map(|integrator| {
        let text = format!("integrator = \"{integrator}\"\n[studio]\nocclusion = {{}}\noutline = {{}}\n");
        let file = SceneFile::parse(&text).unwrap();
        let scene = pinhole::Scene::new(&[]).unwrap();
        let subject = pinhole::Sphere::new([0.0; 3], 1.0, pinhole::LinearRgb::WHITE);
        let subject = pinhole::Scene::new(&[subject]).unwrap();
        let camera = PinholeCamera::framing_from_the_front(subject.subject(), 1.0).unwrap();
        let kind = if integrator == "path" { IntegratorKind::Path } else { IntegratorKind::Studio };
        let settings = file.settings(kind, &scene, &camera, None).unwrap();
        let camera = file.camera_parameters();
        file.settled(Settled { camera, settings: &settings, sky_image: None, data: None, cone_files: Vec::new() })
    });
    texts.iter().map(|text| text.parse().unwrap()).collect()
}

fn default_of(tables: &[toml::Table], path: &str) -> Option<String> {
    let found = tables.iter().find_map(|table| {
        let mut names = path.split('.');
        let first = table.get(names.next()?)?;
        names.try_fold(first, |value, name| value.get(name))
    })?;
    let is_list = |list: &Vec<toml::Value>| list.iter().all(toml::Value::is_float);
    let is_value = !found.is_table() && found.as_array().is_none_or(is_list) && path != "integrator";
    is_value.then(|| format!("`{found}`"))
}

/// `docs/reference/settings.md`, which `PINHOLE_UPDATE_SNAPSHOTS=1` rewrites.
#[test]
fn the_page_of_settings_is_as_it_is_made() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut page = "# All settings and their flags\n\n\
        <!-- Made by `PINHOLE_UPDATE_SNAPSHOTS=1 cargo test -p pinhole-figure settings`. -->\n\n\
        These are the keys of a [scene file](scene-file.md), which flags, `--set KEY=VALUE` and arguments in Python give \
        as well. Lengths are in scene units. A colour is a CSS name, `\"#rrggbb\"` or a linear triple `[r, g, b]`. Where \
        no default is given, the meaning says what happens without the key, or nothing does. The position, direction and \
        enlargement of `[camera.pinhole]` are also keys of the other cameras.\n"
        .to_owned();
    let defaults = defaults();
    let mut tables = Vec::new();
    for (table, file, names) in TABLES {
        let source = std::fs::read_to_string(root.join(file)).unwrap();
        let title = if table.is_empty() { "At the top of the file" } else { table };
        write!(page, "\n## {title}\n\n| key | value | default | flag | meaning |\n|---|---|---|---|---|\n").unwrap();
        let of_source = names.iter().flat_map(|name| keys_of(&source, name));
        let of_source: BTreeSet<String> = of_source.map(|key| key.name).collect();
        let path = table.replace("KIND", "pinhole");
        let known = path.split(", ").flat_map(settings::keys_of).filter(|key| *key != "kind" || table.is_empty());
        let known: BTreeSet<String> = known
            .chain(
                // The list of the keys of a path is part of its table here.
                if table == "camera_path" { settings::keys_of("camera_path.keys") } else { Vec::new() },
            )
            .map(str::to_owned)
            .collect();
        assert_eq!(of_source, known, "{table}");
        for name in names {
            let keys = keys_of(&source, name);
            for Key { kind, name, value, meaning } in keys {
                let path = if table.is_empty() { name.clone() } else { format!("{table}.{name}") };
                let is_same = |key: &str| match path.strip_prefix("camera.") {
                    Some(rest) => key.strip_prefix("camera.*.") == rest.split_once('.').map(|(_, key)| key),
                    None => key == path,
                };
                let flag = FLAGS.iter().find(|flag| is_same(flag.key));
                let default = default_of(&defaults, &path).unwrap_or_default();
                let meaning = match (meaning.is_empty(), flag) {
                    // The keys of the pose are those of each camera.
                    (true, _) if table.starts_with("camera.") && table != "camera.pinhole" => {
                        continue;
                    }
                    (true, Some(flag)) => flag.help.to_owned(),
                    _ => meaning,
                };
                assert!(!meaning.is_empty(), "{file}: `{path}` has no doc comment");
                let kind = kind.map_or(String::new(), |kind| format!("Kind `{kind}`: "));
                let meaning = meaning.replace("[`", "`").replace("`]", "`").replace('|', "\\|");
                let meaning = meaning.replace("`None` for", "Leave it out for");
                let flag = flag.map_or(String::new(), |flag| format!("`{}`", flag.flag));
                writeln!(page, "| `{name}` | {value} | {default} | {flag} | {kind}{meaning} |").unwrap();
                if table.is_empty() && value.contains("table") {
                    tables.push(name);
                }
            }
        }
    }
    // A new table gets a part of its own, but not one whose keys are names that the user chooses.
    for table in tables.into_iter().filter(|table| table != "selections") {
        let is_named = |title: &str| title.split(", ").any(|title| title.split('.').next() == Some(&table));
        assert!(TABLES.iter().any(|(title, ..)| is_named(title)), "TABLES lacks {table}");
    }
    write_flags(&mut page);
    let path = root.join("docs/reference/settings.md");
    if std::env::var_os("PINHOLE_UPDATE_SNAPSHOTS").is_some_and(|value| value == "1") {
        std::fs::write(&path, &page).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(found, page, "PINHOLE_UPDATE_SNAPSHOTS=1 rewrites the page");
}

/// Writes the tables of flags, with the key of each.
fn write_flags(page: &mut String) {
    page.push_str(
        "\n## Flags and the keys that they give\n\n\
        A flag of `pinhole render` takes precedence over the file, and the file over its style. `--set KEY=VALUE` reaches \
        every key and takes precedence over all else. In keys of the camera, `*` is the kind of the camera.\n",
    );
    let mut group = None;
    for flag in FLAGS {
        if group.replace(flag.group) != Some(flag.group) {
            let title = match flag.group {
                Group::Input => "Input",
                Group::Camera => "Camera",
                Group::Structure => "Selection, cell, bonds and arrows",
                Group::Color => "Colours, radii and opacities from data",
                Group::Annotation => "Annotations",
                Group::Look => "Light and style",
                Group::Output => "Output",
            };
            write!(page, "\n### {title}\n\n| flag | key | |\n|---|---|---|\n").unwrap();
        }
        let key = if flag.key.is_empty() { "any" } else { flag.key };
        let value = match flag.alone {
            None => format!(" {}", flag.shown),
            Some(_) => format!("[={}]", flag.shown),
        };
        let help = flag.help.replace('|', "\\|").replace('<', "&lt;").replace("[_", "\\[_");
        writeln!(page, "| `{}{value}` | `{key}` | {help} |", flag.flag).unwrap();
    }
}
