//! The check of one pixel, stage by stage.

use super::bias::{Deviations, deviation};
use super::camera::{CameraModel, EnteredRay};
use super::candidates::Candidates;
use super::certificate::Verdict;
use super::hit::LegalHits;
use super::line::Line;
use super::recording::{NO_HIT, Recording, TracedPixel, TracedRay};
use super::rounding::{Interval, unit_error};
use super::shading::{LegalNormals, exactly, legal_color, legal_depth};
use super::sphere::Slack;
use super::violation::ViolationKind;
use crate::geometry::math::wide;
use crate::image::{Image, NO_ID};
use crate::scene::Scene;

/// The data with which pixels are judged.
pub(super) struct PixelCheck<'a> {
    pub(super) scene: &'a Scene,
    pub(super) candidates: &'a Candidates,
    pub(super) model: CameraModel,
    pub(super) recording: &'a Recording,
}

/// The result for a legal pixel.
pub(super) struct Judged {
    pub(super) verdict: Verdict,
    /// The deviation of the distance from the middle of its legal interval, relative to half the width of the interval.
    pub(super) depth: f64,
    /// The deviation of the normal from the exact one, relative to its bound.
    pub(super) normal: f64,
}

/// The ray with which a hit is shaded, and how far the device's may be from it.
struct Shaded {
    line: Line,
    slack: Slack,
    direction: [Interval; 3],
}

/// The layers of a pixel.
#[derive(PartialEq)]
pub(super) struct Layers {
    color: [f32; 3],
    pub(super) depth: f32,
    pub(super) normal: [f32; 3],
    pub(super) id: u32,
}

impl Layers {
    /// The layers of a pixel; a picture that is judged has all of them.
    pub(super) fn of(image: &Image, index: usize) -> Self {
        Self {
            color: image.color()[index],
            depth: image.depth().map_or(f32::NAN, |layer| layer[index]),
            normal: image.normal().map_or([f32::NAN; 3], |layer| layer[index]),
            id: image.id().map_or(NO_ID, |layer| layer[index]),
        }
    }
}

impl PixelCheck<'_> {
    /// Judges a pixel; the error is the first stage with an illegal result. `legal` is memory that is reused. The
    /// deviations of a decided hit are added to `measured`.
    pub(super) fn judge(
        &self,
        index: usize,
        pixel: [u32; 2],
        legal: &mut LegalHits,
        measured: Option<&mut Deviations>,
    ) -> Result<Judged, ViolationKind> {
        let TracedPixel { ray, t, id, shading_ray } = self.recording.pixels[index];
        let layers = Layers::of(&self.recording.image, index);
        let camera_ray = self.model.ray(pixel);
        let Some(ray) = ray else {
            let exact = camera_ray.entered(&self.model, camera_ray.line.direction);
            if !exact.may_miss_box {
                return Err(ViolationKind::NotTraced);
            }
            legal.clear();
            if id != NO_ID {
                return Err(ViolationKind::Hit { id, t, legal: legal.clone() });
            }
            self.check_miss(&layers, t)?;
            return Ok(Judged { verdict: Verdict::Decided, depth: 0.0, normal: 0.0 });
        };
        let line = Line::new(ray.origin, ray.direction);
        let entered = camera_ray.entered(&self.model, line.direction);
        check_ray(&entered, &ray)?;

        legal.clear();
        if entered.may_hit_box {
            legal.find(self.candidates, &line);
            legal.miss |= entered.may_miss_box;
        }
        let verdict = match (legal.count(), legal.miss) {
            (1, _) => Verdict::Decided,
            (_, true) => Verdict::Silhouette,
            (_, false) => Verdict::Tie,
        };
        let illegal = |legal: &LegalHits| ViolationKind::Hit { id, t, legal: legal.clone() };
        if id == NO_ID {
            if !legal.miss {
                return Err(illegal(legal));
            }
            self.check_miss(&layers, t)?;
            return Ok(Judged { verdict, depth: 0.0, normal: 0.0 });
        }
        if !legal.allows(id, t.into()) {
            return Err(illegal(legal));
        }
        let side = legal.of(id).and_then(|hit| hit.crossing_at(t.into()));
        let depth = side.map_or(0.0, |crossing| crossing.fraction(t.into()));
        let depths = legal_depth(ray.distance, t);
        // Without the ray of shading, it is known only as well as the ray that it must have had.
        let mut shading = Shaded { line, slack: entered.slack(), direction: entered.direction };
        if let Some(ray) = shading_ray {
            let line = Line::new(ray.origin, ray.direction);
            check_ray(&camera_ray.entered(&self.model, line.direction), &ray)?;
            let direction = ray.direction.map(exactly);
            shading = Shaded { line, slack: Slack::default(), direction };
        }
        let normal = self.check_hit(&layers, depths, id, &shading)?;
        if let Some(measured) = measured.filter(|_| verdict == Verdict::Decided) {
            for (what, found, legal) in entered.numbers(&ray) {
                measured.add_if("camera", what, deviation(found, legal));
            }
            let t = side.and_then(|crossing| deviation(t.into(), crossing));
            measured.add_if("trace", "the distance of a hit", t);
            self.measure_shading(&layers, &shading, measured);
        }
        Ok(Judged { verdict, depth, normal })
    }

    fn check_miss(&self, layers: &Layers, t: f32) -> Result<(), ViolationKind> {
        if t.to_bits() != NO_HIT.to_bits() {
            return Err(ViolationKind::MissDistance { found: t });
        }
        self.check_layers_of_miss(layers)
    }

    pub(super) fn check_layers_of_miss(&self, layers: &Layers) -> Result<(), ViolationKind> {
        if layers.id != NO_ID {
            return Err(ViolationKind::Id { found: layers.id, traced: NO_ID });
        }
        let infinity = Interval { low: f64::INFINITY, high: f64::INFINITY };
        if layers.depth != f32::INFINITY {
            return Err(ViolationKind::Depth { found: layers.depth, legal: infinity });
        }
        if layers.normal.iter().any(|component| component.abs() > 0.0 || component.is_nan()) {
            let (found, exact) = (layers.normal, [0.0; 3]);
            return Err(ViolationKind::Normal { found, exact, error: 0.0 });
        }
        let background = self.recording.primary.background.to_array();
        check_color(layers.color, background.map(exactly))
    }

    /// Judges the layers of a hit. Returns the deviation of the normal from the exact one, relative to its bound.
    fn check_hit(
        &self,
        layers: &Layers,
        depths: Interval,
        id: u32,
        shading: &Shaded,
    ) -> Result<f64, ViolationKind> {
        if layers.id != id {
            return Err(ViolationKind::Id { found: layers.id, traced: id });
        }
        if !depths.contains(layers.depth.into()) {
            return Err(ViolationKind::Depth { found: layers.depth, legal: depths });
        }
        self.check_shading(layers, &shading.line, shading.slack, shading.direction)
    }

    /// Judges normal and colour of a hit. Returns the deviation of the normal from the exact one, relative to its
    /// bound.
    pub(super) fn check_shading(
        &self,
        layers: &Layers,
        line: &Line,
        slack: Slack,
        direction: [Interval; 3],
    ) -> Result<f64, ViolationKind> {
        let (scene, id) = (self.scene, layers.id);
        let sphere = scene.spheres()[id as usize];
        let normals = LegalNormals::new(line, sphere, slack);
        let normal = wide(layers.normal);
        let fraction = normals.fraction(normal);
        let is_unit = (normal.length() - 1.0).abs() <= unit_error(sphere[3].into());
        if !(fraction <= 1.0 && is_unit) {
            let (exact, error) = normals.crossings().next().unwrap_or_default();
            let (found, exact) = (layers.normal, exact.to_array());
            return Err(ViolationKind::Normal { found, exact, error });
        }
        let color = scene.color(id).to_array();
        let shading = self.recording.primary.shading;
        check_color(layers.color, legal_color(shading, color, normal, direction))?;
        Ok(fraction)
    }
}

impl PixelCheck<'_> {
    /// Adds the deviations of a legal normal and colour.
    fn measure_shading(&self, layers: &Layers, ray: &Shaded, measured: &mut Deviations) {
        let (scene, id) = (self.scene, layers.id);
        let normal = wide(layers.normal);
        let normals = LegalNormals::new(&ray.line, scene.spheres()[id as usize], ray.slack);
        if let Some((exact, error)) = normals.only() {
            for axis in 0..3 {
                let legal = Interval::around(exact[axis], error);
                measured.add_if("shade", "the normal", deviation(normal[axis], legal));
            }
        }
        let shading = self.recording.primary.shading;
        let legal = legal_color(shading, scene.color(id).to_array(), normal, ray.direction);
        for (found, legal) in layers.color.into_iter().zip(legal) {
            measured.add_if("shade", "the color", deviation(found.into(), legal));
        }
    }
}

fn check_ray(entered: &EnteredRay, ray: &TracedRay) -> Result<(), ViolationKind> {
    for axis in 0..3 {
        let (found, legal) = (ray.direction[axis], entered.direction[axis]);
        if !legal.contains(found.into()) {
            return Err(ViolationKind::Direction { axis, found, legal });
        }
    }
    entered.check_start(ray)
}

fn check_color(found: [f32; 3], legal: [Interval; 3]) -> Result<(), ViolationKind> {
    match (0..3).find(|channel| !legal[*channel].contains(found[*channel].into())) {
        None => Ok(()),
        Some(channel) => {
            let (found, legal) = (found[channel], legal[channel]);
            Err(ViolationKind::Color { channel, found, legal })
        }
    }
}
