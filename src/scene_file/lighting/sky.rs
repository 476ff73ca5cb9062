//! Reads the table `[sky]`.

use std::sync::Arc;

use serde::Deserialize;
use toml::Spanned;

use crate::exact::Table;
use crate::image::color::LinearRgb;
use crate::light::environment::Environment;
use crate::light::{Sky, SkyLight};
use crate::scene_file::span::{
    Keys, Lines, Number, SceneFileError, WithSpan, range_of, refuse_foreign,
};
use crate::scene_file::value::{ColorValue, scaled};

/// The kinds of skies that a file can name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    Constant,
    Gradient,
    Image,
}

impl Kind {
    const fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Gradient => "gradient",
            Self::Image => "image",
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene_file) struct SkyTable {
    kind: Kind,
    color: Option<Spanned<ColorValue>>,
    zenith: Option<Spanned<ColorValue>>,
    horizon: Option<Spanned<ColorValue>>,
    nadir: Option<Spanned<ColorValue>>,
    image: Option<Spanned<String>>,
    rotation: Option<Number>,
    strength: Option<Number>,
    visible: Option<bool>,
}

/// The sky as the file gives it; its image is not loaded yet.
#[derive(Debug)]
pub(in crate::scene_file) struct SkyPlan {
    light: SkyPlanLight,
    is_visible: bool,
}

#[derive(Debug)]
enum SkyPlanLight {
    Known(SkyLight),
    Image { file: WithSpan<String>, strength: f32, rotation: f64 },
}

impl SkyPlan {
    pub(super) fn read(
        table: Spanned<Table<SkyTable>>,
        lines: &Lines<'_>,
    ) -> Result<Self, SceneFileError> {
        let span = lines.span(table.span().start);
        let table = table.into_inner().0;
        let kind = table.kind;
        refuse_foreign(
            lines,
            kind.name(),
            &[
                ("color", range_of(&table.color), kind == Kind::Constant),
                ("zenith", range_of(&table.zenith), kind == Kind::Gradient),
                ("horizon", range_of(&table.horizon), kind == Kind::Gradient),
                ("nadir", range_of(&table.nadir), kind == Kind::Gradient),
                ("image", range_of(&table.image), kind == Kind::Image),
                ("rotation", range_of(&table.rotation), kind == Kind::Image),
            ],
        )?;
        let numbers = vec![("rotation", table.rotation), ("strength", table.strength)];
        let keys = Keys { lines, numbers, table: span };
        let strength = keys.within("strength", [0.0, 1e6], "from 0 to 1e6")?.unwrap_or(1.0);
        let color = |value: Option<Spanned<ColorValue>>, default: f32| {
            let color = value.map_or(LinearRgb::gray(default), |color| color.into_inner().0);
            scaled(color, strength, "the sky").map_err(|error| span.error(error))
        };
        // The defaults of the gradient are those of the sky without a scene file.
        let light = match kind {
            Kind::Constant => SkyPlanLight::Known(SkyLight::Constant(color(table.color, 1.0)?)),
            Kind::Gradient => SkyPlanLight::Known(SkyLight::Gradient {
                zenith: color(table.zenith, 1.0)?,
                horizon: color(table.horizon, 0.8)?,
                nadir: color(table.nadir, 0.4)?,
            }),
            Kind::Image => {
                let range = "from -36000 to 36000 degrees";
                let degrees = keys.within("rotation", [-36e3, 36e3], range)?.unwrap_or(0.0);
                let file = table.image.ok_or_else(|| {
                    span.error("a sky of the kind `image` needs a file; add `image = \"FILE.hdr\"`, or .exr")
                })?;
                SkyPlanLight::Image {
                    file: lines.spanned(file),
                    strength: strength as f32,
                    rotation: degrees.to_radians(),
                }
            }
        };
        Ok(Self { light, is_visible: table.visible.unwrap_or(true) })
    }

    pub(in crate::scene_file) fn image(&self) -> Option<&str> {
        match &self.light {
            SkyPlanLight::Image { file, .. } => Some(&file.value),
            SkyPlanLight::Known(_) => None,
        }
    }

    pub(in crate::scene_file) fn sky(
        &self,
        image: Option<Environment>,
    ) -> Result<Sky, SceneFileError> {
        let light = match &self.light {
            SkyPlanLight::Known(light) => light.clone(),
            SkyPlanLight::Image { file, strength, rotation } => SkyLight::Image {
                environment: Arc::new(image.ok_or_else(|| {
                    file.span.error("the settings need this image of the sky, which was not given")
                })?),
                strength: *strength,
                rotation: *rotation,
            },
        };
        Ok(Sky { light, is_visible: self.is_visible })
    }
}
