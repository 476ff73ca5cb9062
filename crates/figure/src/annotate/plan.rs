//! The annotations that a user wants, before the scene is known.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::key_arrow::KeyArrow;
use super::scale_bar::{ScaleBar, ScaleBarError, pixels_per_unit};
use super::{Annotation, Annotations, Axes, Label, Legend, Panel, Position, missing_characters};
use crate::color_by::ColorKey;
use crate::color_by::number::short;
use pinhole::camera::View;
use pinhole::camera::film::{Film, YAxis};
use pinhole::geometry::subject::Subject;
use pinhole::image::color::LinearRgb;
use pinhole_data::added::ArrowKey;

/// The annotations that a user wants, from a scene file or flags.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AnnotationPlan {
    /// A legend.
    pub legend: Option<LegendPlan>,
    /// A scale bar.
    pub scale_bar: Option<ScaleBarPlan>,
    /// The directions of x, y and z.
    pub axes: Option<AxesPlan>,
    /// Labels.
    pub labels: Vec<Label>,
    /// The vector that arrows show, for which a legend needs room.
    pub arrows: Option<String>,
    /// The look of all text.
    pub text: TextPlan,
}

/// The look of text that a user wants.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct TextPlan {
    /// The size of the text, as a factor of 1/36 of the picture's height: 0.2 to 10.
    pub scale: Option<f32>,
    /// The colour of text and lines; by default black or white, whichever can be read.
    pub color: Option<LinearRgb>,
    /// Whether a translucent panel lies behind annotations; by default where the picture behind is mixed.
    pub panel: Option<Panel>,
}

/// A legend that a user wants.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct LegendPlan {
    /// The title; by default the name of the column.
    pub title: Option<String>,
    /// The position; by default the middle of the right side.
    pub position: Option<Position>,
}

/// A scale bar that a user wants.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ScaleBarPlan {
    /// The length in scene units; by default a round number that suits the picture.
    pub length: Option<f64>,
    /// The unit; it may be empty.
    pub unit: String,
    /// The position; by default the bottom left corner.
    pub position: Option<Position>,
}

/// The directions of x, y and z that a user wants.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct AxesPlan {
    /// The position; by default the bottom left corner.
    pub position: Option<Position>,
}

/// The reason why annotations are impossible.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AnnotationError {
    /// A legend is wanted, but colours do not come from a column.
    #[error("a legend shows what colors or arrows mean, but no column gives colors; color the spheres by a column")]
    NoKey,
    /// A scale bar is impossible.
    #[error(transparent)]
    ScaleBar(#[from] ScaleBarError),
}

impl AnnotationPlan {
    /// Returns true if there is nothing to draw.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.legend.is_none() && self.scale_bar.is_none() && self.axes.is_none() && self.labels.is_empty()
    }

    /// Returns the labels and the legend of colours, which do not depend on the camera.
    fn without_camera(&self, key: Option<&ColorKey>) -> Annotations {
        let color = self.text.color.map(LinearRgb::to_srgb8);
        let mut drawn = Annotations { color, ..Annotations::default() };
        drawn.text_scale = self.text.scale.unwrap_or(drawn.text_scale);
        drawn.panel = self.text.panel.unwrap_or(drawn.panel);
        drawn.items = self.labels.iter().cloned().map(Annotation::Label).collect();
        if let (Some(LegendPlan { title, position }), Some(key)) = (&self.legend, key) {
            let mut legend = Legend::new(key.clone());
            legend.title.clone_from(title);
            legend.position = position.unwrap_or(legend.position);
            drawn = drawn.with(Annotation::Legend(legend));
        }
        drawn
    }

    /// The parts of a film that a camera must leave free so that no sphere lies under the legend, for
    /// [`Subject::with_free_sides`]. All are 0 if there is no legend, no key, or no room.
    #[must_use]
    pub fn free_sides(&self, key: Option<&ColorKey>, film: Film) -> [f64; 4] {
        let mut drawn = self.without_camera(key);
        if let (Some(legend), Some(vector)) = (&self.legend, &self.arrows) {
            let mut arrow = KeyArrow::longest(vector, film.width());
            arrow.position = legend.position.unwrap_or(arrow.position);
            drawn = drawn.with(Annotation::KeyArrow(arrow));
        }
        let size = [film.width(), film.height()];
        let [left, right, bottom, top] = drawn.room_of_legend(size, Subject::MOST_FREE);
        match film.y_axis() {
            YAxis::Up => [left, right, bottom, top],
            YAxis::Down => [left, right, top, bottom],
        }
    }

    /// Returns the annotations of a picture, and notes for the user. `key` explains the colours, if a column gives
    /// them, and `arrows` the arrows. A scale bar and the arrow of a legend are true at the depth of `middle`, the middle
    /// of the scene.
    ///
    /// # Errors
    /// Returns an error if there is nothing for a legend to explain, or a scale bar has no meaning or does not fit.
    pub fn annotations(
        &self,
        key: Option<&ColorKey>,
        arrows: Option<&ArrowKey>,
        view: &View<'_>,
        middle: DVec3,
    ) -> Result<(Annotations, Vec<String>), AnnotationError> {
        let mut notes = Vec::new();
        let mut drawn = self.without_camera(key);
        if let Some(legend) = &self.legend {
            if key.is_none() && arrows.is_none() {
                return Err(AnnotationError::NoKey);
            }
            let width = view.film.width();
            let arrow = |key| Ok::<_, ScaleBarError>(KeyArrow::new(key, pixels_per_unit(view, middle)?, width));
            match arrows.map(arrow).transpose() {
                Ok(Some(Some(mut arrow))) => {
                    arrow.position = legend.position.unwrap_or(arrow.position);
                    drawn = drawn.with(Annotation::KeyArrow(arrow));
                }
                Ok(_) => {}
                Err(error) => notes.push(format!("the legend has no arrow: {error}")),
            }
        }
        if let Some(ScaleBarPlan { length, unit, position }) = &self.scale_bar {
            let scale = pixels_per_unit(view, middle)?;
            let mut bar = ScaleBar::new(scale, *length, unit.clone(), view.film.width())?;
            bar.position = position.unwrap_or(bar.position);
            if view.camera.kind() != pinhole::camera::CameraKind::Orthographic {
                let depth = (middle - view.camera.vectors().origin).length();
                notes.push(format!(
                    "the scale bar of {} is true at the distance of the middle of the scene, {}; the orthographic \
                     camera has one scale everywhere",
                    bar.text(),
                    short(depth)
                ));
            }
            drawn = drawn.with(Annotation::ScaleBar(bar));
        }
        if let Some(AxesPlan { position }) = &self.axes {
            let mut axes = Axes::new(view);
            axes.position = position.unwrap_or(axes.position);
            drawn = drawn.with(Annotation::Axes(axes));
        }
        let lacking = missing_characters(&drawn.texts().collect::<String>());
        if !lacking.is_empty() {
            let lacking = lacking.into_iter().map(String::from).collect::<Vec<_>>().join(" ");
            notes.push(format!(
                "the font of annotations lacks {}, drawn as boxes; it has Latin, Greek and Cyrillic letters",
                pinhole::internals::text::one_line(&lacking)
            ));
        }
        Ok((drawn, notes))
    }
}
