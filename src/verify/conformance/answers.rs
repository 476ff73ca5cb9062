//! The answers of a renderer, their rays, whether they can be judged, and findings about them.

use std::fmt;

use glam::DVec3;

use crate::camera::View;
use crate::geometry::ray::Ray;
use crate::image::NO_ID;
use crate::recording::pixel_at;
use crate::scene::Scene;
use crate::verify::certificate::Outcome;

/// The unit of k: 2⁻²⁴, half the distance from 1 to the next f32.
pub const EPSILON: f64 = 1.0 / (1 << 24) as f64;

/// The largest k that an honest f32 renderer needs for ids and depths, for rays that it is given.
pub const OF_GIVEN_RAYS: f64 = 24.0;

/// Added to the limit if the renderer made the rays by itself.
pub const FOR_CAMERAS: f64 = 16.0;

/// Added to the limit if normals are judged.
pub const FOR_NORMALS: f64 = 8.0;

/// The part of the distance of a ray's start from the origin of coordinates that is added to the size of a sphere.
pub(super) const OF_COORDINATES: f64 = 1.0 / 8.0;

/// The largest deviation of a ray's direction from unit length: 2⁻²⁰.
pub(super) const LENGTH_ERROR: f64 = 1.0 / (1 << 20) as f64;

/// The answers of a renderer, row by row from the top.
#[derive(Clone, Copy, Debug, Default)]
pub struct Answers<'a> {
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// The sphere of each pixel, as an index in input order; [`NO_ID`] for a miss.
    pub ids: &'a [u32],
    /// The depth of each pixel, in scene units. Depths of misses are ignored.
    pub depths: Option<&'a [f64]>,
    /// The kind of depths.
    pub depth_kind: DepthKind,
    /// The unit normal of each pixel in world space, which points away from the sphere's
    /// centre. Normals of misses are ignored.
    pub normals: Option<&'a [[f64; 3]]>,
}

/// The kind of depths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthKind {
    /// Distances from the ray's start, along the ray.
    #[default]
    Distance,
    /// Distances from the camera's plane, as a z-buffer has them once it is made linear.
    AlongAxis,
}

/// The rays of a picture.
#[derive(Clone, Copy, Debug)]
pub enum Rays<'a> {
    /// The rays through the centres of pixels, exactly. The renderer made them by itself.
    View(View<'a>),
    /// These rays in world space, row by row from the top. The renderer was given the same numbers. Directions are of
    /// unit length up to 2⁻²⁰.
    Given(&'a [Ray]),
}

/// Why answers cannot be judged.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
#[non_exhaustive]
pub struct ConformanceError {
    /// The field that is not valid, if the error is in a field.
    pub field: Option<Field>,
    message: String,
}

/// A field of answers, or the rays, with a number that is not valid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Field {
    /// The ids of spheres.
    Ids,
    /// The depths of hits.
    Depths,
    /// The normals of hits.
    Normals,
    /// The rays.
    Rays,
    /// The kind of depths.
    DepthKind,
}

pub(super) fn refused(field: Option<Field>, message: String) -> ConformanceError {
    ConformanceError { field, message }
}

impl Answers<'_> {
    pub(super) fn pixel(&self, index: usize) -> [u32; 2] {
        pixel_at(index, self.size[0])
    }

    /// The largest k that an honest f32 renderer needs: see the [module](super).
    pub(super) fn limit(&self, rays: Rays<'_>) -> f64 {
        let for_camera = if matches!(rays, Rays::View(_)) { FOR_CAMERAS } else { 0.0 };
        let for_normals = if self.normals.is_some() { FOR_NORMALS } else { 0.0 };
        OF_GIVEN_RAYS + for_camera + for_normals
    }

    /// Checks whether the answers can be judged. Every number is checked.
    pub(super) fn check(&self, scene: &Scene, rays: Rays<'_>) -> Result<(), ConformanceError> {
        let size = self.size;
        let count = u64::from(size[0]) * u64::from(size[1]);
        let [width, height] = size;
        let has = |what, found: usize| {
            if found as u64 == count {
                return Ok(());
            }
            let message = format!("there are {found} {what} for a picture of {width}x{height} pixels");
            Err(refused(None, message))
        };
        has("ids", self.ids.len())?;
        self.depths.map_or(Ok(()), |depths| has("depths", depths.len()))?;
        self.normals.map_or(Ok(()), |normals| has("normals", normals.len()))?;
        match rays {
            Rays::View(view) => {
                let (across, down) = (view.film.width(), view.film.height());
                if [across, down] != size {
                    let message = format!(
                        "the picture is {width}x{height} pixels, but the view is {across}x{down}; render and certify the \
                         same size"
                    );
                    return Err(refused(None, message));
                }
            }
            Rays::Given(rays) => {
                has("rays", rays.len())?;
                (0..).zip(rays).try_for_each(|(index, ray)| self.check_ray(index, ray))?;
            }
        }
        if self.depths.is_some() && self.depth_kind == DepthKind::AlongAxis && rays.axis().is_none() {
            let message = "depths along an axis need a camera with a plane (pinhole, orthographic or thin-lens)";
            return Err(refused(Some(Field::DepthKind), message.to_owned()));
        }
        self.check_numbers(scene)
    }

    /// The error for an invalid number of a pixel.
    fn wrong(&self, field: Field, index: usize, what: &str, message: &str) -> ConformanceError {
        let [column, row] = self.pixel(index);
        refused(Some(field), format!("the {what} at pixel ({column}, {row}) {message}"))
    }

    fn check_ray(&self, index: usize, Ray { origin, direction }: &Ray) -> Result<(), ConformanceError> {
        let length = direction.length();
        if !origin.is_finite() {
            let found = origin.to_array();
            let message = format!("starts at {found:?}; coordinates must be finite");
            return Err(self.wrong(Field::Rays, index, "ray", &message));
        }
        if (length - 1.0).abs() <= LENGTH_ERROR {
            return Ok(());
        }
        let message = format!(
            "has the length {length}, but must have unit length within 1e-6; divide directions by their lengths"
        );
        Err(self.wrong(Field::Rays, index, "direction of the ray", &message))
    }

    fn check_numbers(&self, scene: &Scene) -> Result<(), ConformanceError> {
        for (index, id) in self.ids.iter().enumerate().filter(|(_, id)| **id != NO_ID) {
            if *id as usize >= scene.shape_count() {
                let (spheres, cones) = (scene.len(), scene.cones().len());
                let plural = |count| if count == 1 { "" } else { "s" };
                let too = if cones == 0 { String::new() } else { format!(" and {cones} cone{}", plural(cones)) };
                let after = if cones == 0 { "" } else { ", and cones and cylinders after spheres" };
                let message = format!(
                    "is {id}, but the scene has {spheres} sphere{}{too}; ids count them from 0 in the order of the \
                     input{after}",
                    plural(spheres)
                );
                return Err(self.wrong(Field::Ids, index, "id", &message));
            }
            if let Some(depths) = self.depths
                && !(depths[index].is_finite() && depths[index] >= 0.0)
            {
                let message = format!(
                    "is {}, but its id is that of a sphere; the depth of a hit must be finite and at least 0",
                    depths[index]
                );
                return Err(self.wrong(Field::Depths, index, "depth", &message));
            }
            if let Some(normals) = self.normals
                && !DVec3::from(normals[index]).is_finite()
            {
                let message = format!("is {:?}; it must be finite", normals[index]);
                return Err(self.wrong(Field::Normals, index, "normal", &message));
            }
        }
        Ok(())
    }
}

impl Rays<'_> {
    /// The unit vector along which a camera with a plane measures depth.
    pub(super) fn axis(self) -> Option<DVec3> {
        let Self::View(view) = self else { return None };
        let vectors = view.camera.vectors();
        let axis = vectors.up.cross(vectors.right).normalize_or_zero();
        let along = if axis.dot(vectors.forward) < 0.0 { -axis } else { axis };
        view.camera.kind().is_linear().then_some(along)
    }
}

/// The largest number of pixels with an explanation.
pub(super) const KEPT: usize = 100;

/// Exponents of two of the first and the last limit of the histogram.
const FIRST: i32 = -4;
const LAST: i32 = 24;

/// The judgement of a renderer's answers, pixel by pixel: the result of
/// [`Checker::certify_answers`](crate::verify::Checker::certify_answers).
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Conformance {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The limit of k.
    pub at_most: f64,
    /// The outcome of every pixel, row by row from the top. A pixel is proved if its answer is the only one that is
    /// legal within the limit, undecided if other answers are legal too, and violated if it needs a larger k.
    pub outcomes: Vec<Outcome>,
    /// The least k of every pixel; infinity if no k makes the pixel legal.
    pub least: Vec<f32>,
    /// The pixels that need the largest k, the worst first; at most a hundred.
    pub worst: Vec<Finding>,
}

/// Why a pixel needs its k.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Finding {
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// The sphere that the renderer found; [`NO_ID`] for a miss.
    pub id: u32,
    /// The depth that the renderer found, as it was given.
    pub depth: Option<f64>,
    /// The outcome of the pixel.
    pub outcome: Outcome,
    /// The least k.
    pub least: f64,
    /// The least k as a length in scene units: how far a sphere must be moved.
    pub margin: f64,
    /// The reason for this k.
    pub reason: Reason,
    /// The sphere that the exact ray hits, and its distance.
    pub exact: Option<(u32, f64)>,
    /// The number of spheres; later ids are those of cones.
    pub(super) spheres: u32,
}

/// The defect of an answer if the ray is not changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Reason {
    /// The ray does not hit the sphere.
    Missed,
    /// The sphere is hit at another distance.
    Depth,
    /// The sphere has another normal there.
    Normal,
    /// This sphere is hit first, or is hit although the answer is a miss.
    Hidden(u32),
    /// The camera has no ray there.
    NoRay,
}

impl Reason {
    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Missed => "missed",
            Self::Depth => "depth",
            Self::Normal => "normal",
            Self::Hidden(_) => "hidden",
            Self::NoRay => "no-ray",
        }
    }
}

impl Conformance {
    /// The number of pixels with an outcome.
    #[must_use]
    pub fn count(&self, outcome: Outcome) -> usize {
        self.outcomes.iter().filter(|of_pixel| **of_pixel == outcome).count()
    }

    /// The fraction of pixels for which only one answer is legal within the limit, and the renderer gave it.
    #[must_use]
    pub fn decided_fraction(&self) -> f64 {
        self.count(Outcome::Proved) as f64 / self.outcomes.len().max(1) as f64
    }

    /// The outcome of the picture.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let violated = self.count(Outcome::Violated) > 0;
        Outcome::of(violated, self.count(Outcome::Undecided) as u64, self.outcomes.len() as u64)
    }

    /// The largest k that a pixel needs; 0 without pixels.
    #[must_use]
    pub fn largest(&self) -> f64 {
        self.least.iter().copied().fold(0.0, f32::max).into()
    }

    /// The number of pixels by k. The limits are powers of two from 1/16 on, each with the number of pixels whose k is
    /// at most this limit and above the previous one. The last limit is the first one that is not below the largest k.
    /// It is infinite if that is above 2²⁴.
    #[must_use]
    pub fn histogram(&self) -> Vec<(f64, usize)> {
        let limits = (FIRST..=LAST).map(|exponent| 2_f64.powi(exponent)).chain([f64::INFINITY]);
        let mut bins: Vec<(f64, usize)> = limits.map(|limit| (limit, 0)).collect();
        for least in &self.least {
            let bin = bins.partition_point(|(limit, _)| *limit < f64::from(*least));
            bins[bin].1 += 1;
        }
        let used = bins.iter().rposition(|(_, count)| *count > 0).map_or(0, |last| last + 1);
        bins.truncate(used);
        bins
    }
}

impl fmt::Display for Conformance {
    /// Writes a table, the histogram, and the worst pixel.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pixels = self.outcomes.len().max(1) as f64;
        let mut row =
            |name: &str, count: usize| writeln!(f, "{name:<16}{count:>12}  {:8.4} %", 100.0 * count as f64 / pixels);
        for outcome in Outcome::ALL {
            row(outcome.name(), self.count(*outcome))?;
        }
        for (limit, count) in self.histogram() {
            row(&format!("k up to {}", limit_in_words(limit)), count)?;
        }
        write!(f, "{:<16}{:>12.4}  of {}", "largest k", self.largest(), self.at_most)?;
        match self.worst.first() {
            Some(worst) => write!(f, "\nworst: {worst}"),
            None => Ok(()),
        }
    }
}

fn limit_in_words(limit: f64) -> String {
    if limit < 1.0 { format!("1/{}", 1.0 / limit) } else { limit.to_string() }
}

impl fmt::Display for Finding {
    /// Writes the finding on one line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ([i, j], id) = (self.pixel, self.id);
        let shape = |id| format!("{} {id}", if id < self.spheres { "sphere" } else { "cone" });
        write!(f, "pixel ({i}, {j}): ")?;
        match self.depth {
            _ if id == NO_ID => f.write_str("a miss")?,
            Some(depth) => write!(f, "{} at {depth}", shape(id))?,
            None => f.write_str(&shape(id))?,
        }
        write!(f, " needs k = {:.4}", self.least)?;
        if self.margin.is_finite() {
            write!(f, ", which moves it by {:.3e}", self.margin)?;
        }
        match self.reason {
            Reason::Missed => f.write_str(": the ray misses it")?,
            Reason::Depth => f.write_str(": it is hit elsewhere")?,
            Reason::Normal => f.write_str(": its normal is another")?,
            Reason::Hidden(other) => write!(f, ": {} is hit", shape(other))?,
            Reason::NoRay => return f.write_str(": the camera has no ray there"),
        }
        match self.exact {
            Some((id, t)) => write!(f, "; the exact ray hits {} at {t:.9e}", shape(id)),
            None => f.write_str("; the exact ray misses everything"),
        }
    }
}
