//! Which integrator makes the picture: the one that a flag, the file or a style names, or that tables and flags need.

use serde::{Deserialize, Serialize};

use crate::scene_file::span::{SceneFileError, unknown};
use crate::settings::layers::Joined;
use pinhole::render::Integrator;

/// The integrators that a scene file can name. The integrator computes the colour of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum IntegratorKind {
    /// Primary rays: a pixel shows what its ray meets first, without lights.
    #[default]
    Primary,
    /// Studio light: light goes directly from the lights to the surfaces.
    Studio,
    /// Path tracing: light is followed as surfaces scatter it.
    Path,
}

impl IntegratorKind {
    const NAMES: [(&str, Self); 3] = [("primary", Self::Primary), ("studio", Self::Studio), ("path", Self::Path)];

    /// The kind of an integrator.
    pub(crate) fn of(integrator: &Integrator) -> Self {
        match integrator {
            Integrator::Primary(_) => Self::Primary,
            Integrator::Studio(_) => Self::Studio,
            Integrator::Path(_) => Self::Path,
        }
    }

    /// The name in scene files and flags.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, kind)| *kind == self).map_or("", |(name, _)| name)
    }
}

/// What the layers say about the integrator.
#[derive(Debug)]
pub(crate) struct IntegratorChoice {
    /// The integrator that a flag names.
    by_flag: Option<IntegratorKind>,
    /// The integrator that the file or the style names, or that tables, materials or opacities need.
    pub(crate) by_scene: Option<IntegratorKind>,
    /// Whether flags add occlusion, which needs a studio.
    needs_studio: bool,
    /// Flags that need light, with the table that they change.
    flags: Vec<(&'static str, &'static str)>,
}

/// Tables that only some integrators read, with the name of the integrator if there is only one.
const TABLES: [(&str, Option<IntegratorKind>); 4] = [
    ("sampling", None),
    ("studio", Some(IntegratorKind::Studio)),
    ("path", Some(IntegratorKind::Path)),
    ("sky", Some(IntegratorKind::Path)),
];

impl IntegratorChoice {
    /// `has_materials` says whether any surface is not matt and opaque.
    pub(crate) fn read(layers: &Joined<'_>, has_materials: bool) -> Result<Self, SceneFileError> {
        let lines = &layers.places.lines;
        let named = |name: Option<(&str, usize)>| {
            let known = IntegratorKind::NAMES;
            let kind = |(name, at): (&str, usize)| {
                let found = known.iter().find(|(known, _)| *known == name);
                found
                    .map(|(_, kind)| *kind)
                    .ok_or_else(|| lines.span(at).error(unknown("name", name, &known.map(|(name, _)| name))))
            };
            name.map(kind).transpose()
        };
        let of_file = named(layers.in_file.text("integrator"))?;
        let of_style = named(layers.in_style.text("integrator"))?;
        let is_light = |flag: &(String, &'static str)| {
            let (key, flag) = flag;
            let (table, _) = key.split_once('.')?;
            let table = TABLES.iter().find(|(name, _)| *name == table)?.0;
            let switches_off = key == "sampling.denoise" && layers.in_flags.is_off(key);
            (!switches_off).then_some((*flag, table))
        };
        Ok(Self {
            by_flag: named(layers.in_flags.text("integrator"))?,
            by_scene: needed(layers, of_file, has_materials)?.or(of_style),
            needs_studio: layers.in_flags.has("studio.occlusion"),
            flags: layers.flags().iter().filter_map(is_light).collect(),
        })
    }

    /// The integrator of the picture. If nothing asks for one, there is no light.
    pub(crate) fn kind(&self) -> IntegratorKind {
        let by_occlusion = self.needs_studio.then_some(IntegratorKind::Studio);
        self.by_flag.or(self.by_scene).or(by_occlusion).unwrap_or_default()
    }

    /// Refuses flags that do not apply to pictures by an integrator. Returns whether flags ask for smooth edges of a
    /// picture without light.
    pub(crate) fn check_flags(&self, kind: IntegratorKind) -> Result<bool, SceneFileError> {
        let refused = |flag: &'static str, only: &str, remedy: &str| SceneFileError {
            line: 1,
            column: 1,
            message: format!(
                "{flag} applies only to {only}, but this picture is made by `{}`; remove {flag} or choose {remedy}",
                kind.name()
            ),
            flag: Some(flag),
        };
        if kind == IntegratorKind::Primary {
            return match self.flags.first() {
                Some((flag, _)) if self.by_flag.or(self.by_scene).is_some() => {
                    Err(refused(flag, "the integrators `studio` and `path`", "another --integrator or --style"))
                }
                first => Ok(first.is_some()),
            };
        }
        for (flag, table) in &self.flags {
            let only = TABLES.iter().find(|(name, _)| name == table).and_then(|(_, only)| *only);
            if let Some(only) = only.filter(|only| *only != kind) {
                let name = only.name();
                let remedy = format!("--integrator {name}");
                return Err(refused(flag, &format!("the integrator `{name}`"), &remedy));
            }
        }
        Ok(false)
    }
}

/// The integrator that the file names, or else the one that its tables and materials need.
fn needed(
    layers: &Joined<'_>,
    named: Option<IntegratorKind>,
    has_materials: bool,
) -> Result<Option<IntegratorKind>, SceneFileError> {
    let lines = &layers.places.lines;
    let first = |tables: &[(&'static str, &'static str)]| {
        tables.iter().find_map(|(key, shown)| Some((*shown, layers.in_file.start(key)?)))
    };
    let of_paths = first(&[("path", "[path]"), ("sky", "[sky]")]);
    let of_studio = first(&[("studio", "[studio]")]);
    let of_both =
        first(&[("sampling", "[sampling]"), ("lights", "[[lights]]"), ("sun", "[sun]"), ("ground", "[ground]")]);
    let of_any = of_paths.or(of_studio).or(of_both);
    if let (Some(IntegratorKind::Primary), Some((table, start))) = (named, of_any) {
        return Err(lines.span(start).error(format!(
            "`{table}` applies only to pictures with light, but `integrator = \"primary\"` makes a picture without \
             light; remove one of them"
        )));
    }
    let kind = match (named, of_paths, of_studio) {
        (Some(kind), ..) => Some(kind),
        (None, Some((table, start)), Some(_)) => {
            return Err(lines.span(start).error(format!(
                "`{table}` applies to the integrator `path` and `[studio]` to the integrator `studio`; choose one \
                 with `integrator = \"path\"` or `integrator = \"studio\"`"
            )));
        }
        (None, Some(_), None) => Some(IntegratorKind::Path),
        (None, None, Some(_)) => Some(IntegratorKind::Studio),
        (None, None, None) => (has_materials || of_both.is_some()).then_some(IntegratorKind::Studio),
    };
    match (kind, layers.in_file.start("shading")) {
        (Some(IntegratorKind::Studio | IntegratorKind::Path), Some(start)) => Err(lines
            .span(start)
            .error("`shading` applies only to pictures without light, but this file asks for light; remove `shading`")),
        _ => Ok(kind),
    }
}
