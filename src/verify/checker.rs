//! The checker of recordings of a scene, pixel by pixel and stage by stage. A pixel whose ray was not recorded is legal
//! if it is legal for some ray that a device may compute for the pixel.

use glam::DVec3;

use crate::geometry::math::wide;
use crate::image::{Image, NO_ID};
use crate::parallel::{map_parts, ranges};
use crate::recording::{NO_HIT, PlainRender, Recording, TracedPixel, TracedRay, pixel_at};
use crate::scene::{Scene, SceneError, Shape};
use crate::verify::bias::Deviations;
use crate::verify::camera::{AnyRay, CameraModel, EnteredRay};
use crate::verify::certificate::{
    AXES, CHUNK, Certificate, KEPT, Mismatch, Verdict, Violation, channel_name, legal_is, shape_name,
};
use crate::verify::cone::LegalConeHits;
use crate::verify::hit::{Candidates, LegalHits};
use crate::verify::normals::LegalNormals;
use crate::verify::rounding::{Interval, PAD, U};
use crate::verify::sphere::{Line, Slack, SphereTest, exactly, legal_color, legal_depth};
use crate::verify::uploaded::check_recording;

/// Judges recordings of a scene.
#[derive(Debug)]
pub struct Checker<'a> {
    pub(super) scene: &'a Scene,
    pub(super) candidates: Candidates,
}

/// Above this many pixels, only every `ONE_IN`-th pixel is measured for biases.
const ALL_MEASURED: usize = 1 << 16;
const ONE_IN: usize = 8;

impl<'a> Checker<'a> {
    /// The largest number of bytes that the checker needs for a scene: 20 for each sphere and 36 for each cone, and up to
    /// 20 for boxes.
    #[must_use]
    pub fn bytes_for(scene: &Scene) -> u64 {
        40 * scene.spheres().len() as u64 + 56 * scene.cones().len() as u64
    }

    /// Prepares a scene, in at most [`Self::bytes_for`] bytes.
    ///
    /// # Errors
    /// Returns an error if there is not enough memory.
    pub fn new(scene: &'a Scene) -> Result<Self, SceneError> {
        Ok(Self { scene, candidates: Candidates::new(scene.spheres(), scene.cones())? })
    }

    /// Every answer that a conforming device may give for a ray with exactly these numbers, in the scene's frame. The
    /// length of the direction must be about one.
    #[must_use]
    pub fn legal_hits(&self, origin: [f32; 3], direction: [f32; 3]) -> LegalHits {
        let mut legal = LegalHits::default();
        legal.find(&self.candidates, &Line::new(origin, direction));
        legal
    }

    /// Judges every pixel of a recording.
    #[must_use]
    pub fn certify(&self, recording: &Recording) -> Certificate {
        let Recording { camera, uploaded, film, .. } = recording;
        let size = [film.width(), film.height()];
        let mut certificate = Certificate {
            size,
            upload: check_recording(self.scene, &self.candidates, recording).err(),
            ..Certificate::default()
        };
        if certificate.upload.is_some() {
            return certificate;
        }
        let check = PixelCheck { checker: self, model: CameraModel::new(camera.kind, uploaded, film), recording };
        let is_compared = recording.rendered != PlainRender::None;
        certificate.rendered_otherwise = is_compared.then_some(0);
        let pixels = ranges(recording.pixels.len(), CHUNK);
        for part in map_parts(pixels, |range| judge(&check, range, size[0])) {
            certificate.verdicts.extend(part.verdicts);
            if let Some(count) = &mut certificate.rendered_otherwise {
                *count += part.rendered_otherwise.unwrap_or_default();
            }
            let room = KEPT.saturating_sub(certificate.violations.len());
            certificate.violations.extend(part.violations.into_iter().take(room));
            certificate.worst_depth = certificate.worst_depth.max(part.worst_depth);
            certificate.worst_normal = certificate.worst_normal.max(part.worst_normal);
            certificate.deviations.join(&part.deviations);
        }
        certificate
    }
}

fn judge(check: &PixelCheck<'_>, range: std::ops::Range<usize>, width: u32) -> Certificate {
    let mut part = Certificate::default();
    let mut legal = LegalHits::default();
    let one_in = if check.recording.pixels.len() > ALL_MEASURED { ONE_IN } else { 1 };
    for index in range {
        let pixel = pixel_at(index, width);
        let measured = (index % one_in == 0).then_some(&mut part.deviations);
        let judged = check.judge(index, pixel, &mut legal, measured);
        let rendered = check.judge_rendered(index, pixel, &mut legal);
        *part.rendered_otherwise.get_or_insert_default() += usize::from(rendered.is_some());
        let judged = judged.and_then(|judged| rendered.unwrap_or(Ok(())).map(|()| judged));
        let verdict = match judged {
            Ok(judged) => {
                part.worst_depth = part.worst_depth.max(judged.depth);
                part.worst_normal = part.worst_normal.max(judged.normal);
                judged.verdict
            }
            Err(Mismatch { stage, message }) => {
                if part.violations.len() < KEPT {
                    part.violations.push(Violation { pixel, stage, message });
                }
                Verdict::Violation
            }
        };
        part.verdicts.push(verdict);
    }
    part
}

pub(super) struct PixelCheck<'a> {
    checker: &'a Checker<'a>,
    model: CameraModel,
    recording: &'a Recording,
}

/// The result for a legal pixel.
pub(super) struct PixelResult {
    pub(super) verdict: Verdict,
    /// The deviation of the distance from the middle of its legal interval, relative to half the width of the interval.
    pub(super) depth: f64,
    /// The deviation of the normal from the exact normal, relative to its bound.
    pub(super) normal: f64,
}

/// The ray with which a hit is shaded, and the maximum difference of the device's ray.
struct ShadingRay {
    line: Line,
    slack: Slack,
    direction: [Interval; 3],
}

impl From<AnyRay> for ShadingRay {
    fn from(AnyRay { line, slack, direction, .. }: AnyRay) -> Self {
        Self { line, slack, direction }
    }
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
    /// The layers of a pixel. A picture that is judged has all of them.
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
    /// Judges a pixel. The error is the first stage with an illegal result. `legal` is memory that is reused. The
    /// deviations of a decided hit are added to `measured`.
    pub(super) fn judge(
        &self,
        index: usize,
        pixel: [u32; 2],
        legal: &mut LegalHits,
        measured: Option<&mut Deviations>,
    ) -> Result<PixelResult, Mismatch> {
        let TracedPixel { ray, t, id, shading_ray } = self.recording.pixels[index];
        let layers = Layers::of(&self.recording.image, index);
        let illegal = |legal: &LegalHits| Mismatch::new("hit", legal.message(id, t));
        let camera_ray = self.model.ray(pixel);
        let Some(ray) = ray else {
            let exact = camera_ray.entered(&self.model, camera_ray.line.direction);
            if !exact.may_miss_box {
                let message = "no ray was traced, although it hits the scene's box";
                return Err(Mismatch::new("cull", message));
            }
            legal.clear();
            if id != NO_ID {
                return Err(illegal(legal));
            }
            self.check_miss(&layers, t)?;
            return Ok(PixelResult { verdict: Verdict::Decided, depth: 0.0, normal: 0.0 });
        };
        let line = Line::new(ray.origin, ray.direction);
        let entered = camera_ray.entered(&self.model, line.direction);
        check_ray(&entered, &ray)?;

        legal.clear();
        if entered.may_hit_box {
            legal.find(&self.checker.candidates, &line);
            legal.miss |= entered.may_miss_box;
        }
        let verdict = Verdict::of(legal);
        if id == NO_ID {
            if !legal.miss {
                return Err(illegal(legal));
            }
            self.check_miss(&layers, t)?;
            return Ok(PixelResult { verdict, depth: 0.0, normal: 0.0 });
        }
        if !legal.allows(id, t.into()) {
            return Err(illegal(legal));
        }
        let side = legal.of(id).and_then(|hit| hit.crossing_at(t.into()));
        let depth = side.map_or(0.0, |crossing| crossing.fraction(t.into()));
        let depths = legal_depth(ray.distance, t);
        let shading = match shading_ray {
            Some(ray) => {
                let line = Line::new(ray.origin, ray.direction);
                check_ray(&camera_ray.entered(&self.model, line.direction), &ray)?;
                ShadingRay { line, slack: Slack::default(), direction: ray.direction.map(exactly) }
            }
            None => ShadingRay::from(camera_ray.any(&self.model)),
        };
        if layers.id != id {
            return Err(self.wrong_id(layers.id, id));
        }
        if !depths.contains(layers.depth.into()) {
            return Err(Mismatch::value("depth", layers.depth, depths));
        }
        let normal = self.check_shading(&layers, &shading)?;
        // The exact numbers of a cone are not in the middle of their bounds.
        let is_sphere = self.checker.candidates.first_cone.is_none_or(|first| id < first);
        if let Some(measured) = measured.filter(|_| verdict == Verdict::Decided && is_sphere) {
            for (what, found, legal) in entered.numbers(&ray) {
                measured.measure("camera", what, found, legal);
            }
            if let Some(crossing) = side {
                measured.measure("trace", "the distance of a hit", t.into(), crossing);
            }
            self.measure_shading(&layers, &shading, measured);
        }
        Ok(PixelResult { verdict, depth, normal })
    }

    fn check_miss(&self, layers: &Layers, t: f32) -> Result<(), Mismatch> {
        if t.to_bits() != NO_HIT.to_bits() {
            return Err(Mismatch::new("hit", format!("a miss at {t:?}; legal is {NO_HIT:?}")));
        }
        self.check_layers_of_miss(layers)
    }

    pub(super) fn check_layers_of_miss(&self, layers: &Layers) -> Result<(), Mismatch> {
        if layers.id != NO_ID {
            return Err(self.wrong_id(layers.id, NO_ID));
        }
        let infinity = Interval { low: f64::INFINITY, high: f64::INFINITY };
        if layers.depth != f32::INFINITY {
            return Err(Mismatch::value("depth", layers.depth, infinity));
        }
        if layers.normal.iter().any(|component| component.abs() > 0.0 || component.is_nan()) {
            return Err(wrong_normal(layers.normal, DVec3::ZERO, 0.0));
        }
        let background = self.recording.primary.background.to_array();
        check_color(layers.color, background.map(exactly))
    }

    fn wrong_id(&self, found: u32, traced: u32) -> Mismatch {
        let first_cone = self.checker.candidates.first_cone;
        let name = |id| if id == NO_ID { "a miss".to_owned() } else { shape_name(first_cone, id) };
        Mismatch::new("id", format!("the picture has {}; {} was found", name(found), name(traced)))
    }

    /// Judges normal and colour of a hit. Returns the deviation of the normal from the exact
    /// normal, relative to its bound.
    fn check_shading(&self, layers: &Layers, ray: &ShadingRay) -> Result<f64, Mismatch> {
        let (scene, id) = (self.checker.scene, layers.id);
        let normals = LegalNormals::new(&ray.line, scene.shared_shapes().shape(id), ray.slack);
        let normal = wide(layers.normal);
        let fraction = normals.fraction(normal);
        if !(fraction <= 1.0 && normals.is_unit(normal)) {
            let (exact, error) = normals.crossings().next().unwrap_or_default();
            return Err(wrong_normal(layers.normal, exact, error));
        }
        let color = scene.color(id).to_array();
        let shading = self.recording.primary.shading;
        check_color(layers.color, legal_color(shading, color, (normal, 0.0), ray.direction))?;
        Ok(fraction)
    }

    /// Adds the deviations of a legal normal and colour.
    fn measure_shading(&self, layers: &Layers, ray: &ShadingRay, measured: &mut Deviations) {
        let (scene, id) = (self.checker.scene, layers.id);
        let normal = wide(layers.normal);
        let normals = LegalNormals::new(&ray.line, scene.shared_shapes().shape(id), ray.slack);
        if let Some((exact, error)) = normals.only() {
            for axis in 0..3 {
                let legal = Interval::around(exact[axis], error);
                measured.measure("shade", "the normal", normal[axis], legal);
            }
        }
        let shading = self.recording.primary.shading;
        let color = scene.color(id).to_array();
        let legal = legal_color(shading, color, (normal, 0.0), ray.direction);
        for (found, legal) in layers.color.into_iter().zip(legal) {
            measured.measure("shade", "the color", found.into(), legal);
        }
    }

    /// Judges a pixel of the picture without recording; `None` if there is no such picture, or if the pixel equals the
    /// recorded one.
    pub(super) fn judge_rendered(
        &self,
        index: usize,
        pixel: [u32; 2],
        legal: &mut LegalHits,
    ) -> Option<Result<(), Mismatch>> {
        let PlainRender::Other(image) = &self.recording.rendered else {
            return None;
        };
        let layers = Layers::of(image, index);
        if layers == Layers::of(&self.recording.image, index) {
            return None;
        }
        let judged = self.judge_any(&layers, pixel, legal);
        Some(judged.map_err(|illegal| Mismatch::new("render", format!("{}: {}", illegal.stage, illegal.message))))
    }

    fn judge_any(&self, layers: &Layers, pixel: [u32; 2], legal: &mut LegalHits) -> Result<(), Mismatch> {
        let ray = self.model.ray(pixel).any(&self.model);
        ray.find(&self.checker.candidates, legal);
        legal.start_from(&ray);
        let Layers { id, depth, .. } = *layers;
        if id == NO_ID && legal.miss {
            return self.check_layers_of_miss(layers);
        }
        if id == NO_ID || !legal.allows(id, depth.into()) {
            return Err(Mismatch::new("hit", legal.message(id, depth)));
        }
        if let Some(legal) = self.legal_depth(&ray, id)
            && !legal.contains(depth.into())
        {
            return Err(Mismatch::value("depth", depth, legal));
        }
        self.check_shading(layers, &ray.into()).map(|_| ())
    }

    /// The legal depths of a shape, if the ray certainly hits one particular side. These bounds are tighter, because
    /// they do not depend on where the ray enters the scene's box.
    fn legal_depth(&self, ray: &AnyRay, id: u32) -> Option<Interval> {
        let sphere = match self.checker.scene.shared_shapes().shape(id) {
            Shape::Sphere(sphere) => sphere,
            Shape::Cone(cone) => {
                let is_decided = LegalConeHits::of(&ray.line, ray.slack, &cone).is_decided();
                let closer = LegalConeHits::of(&ray.line, ray.slack_of_distance, &cone);
                let sides = [true, false].map(|is_near| closer.distances(is_near));
                return sides.into_iter().flatten().next().filter(|_| is_decided).map(|side| ray.depths(side));
            }
        };
        let roots = SphereTest::new(&ray.line, sphere, ray.slack)?.roots();
        let test = SphereTest::new(&ray.line, sphere, ray.slack_of_distance)?.as_the_kernel();
        let closer = test.roots();
        let side = match ((roots.near, roots.far), (closer.near, closer.far)) {
            ((Some(_), None), (Some(side), None)) | ((None, Some(_)), (None, Some(side))) => side,
            _ => return None,
        };
        Some(ray.depths(side))
    }
}

fn check_ray(entered: &EnteredRay, ray: &TracedRay) -> Result<(), Mismatch> {
    for (axis, name) in AXES.iter().enumerate() {
        let (found, legal) = (ray.direction[axis], entered.direction[axis]);
        legal_is("camera", format_args!("the direction's {name}"), found, legal)?;
    }
    entered.check_start(ray)
}

fn check_color(found: [f32; 3], legal: [Interval; 3]) -> Result<(), Mismatch> {
    (0..3).try_for_each(|channel| legal_is("color", channel_name(channel), found[channel], legal[channel]))
}

fn wrong_normal(found: [f32; 3], exact: DVec3, error: f64) -> Mismatch {
    let DVec3 { x, y, z } = exact;
    let message =
        format!("{found:?}; legal is what is within {error:.3e} of [{x:.9}, {y:.9}, {z:.9}] and of unit length");
    Mismatch::new("normal", message)
}

impl AnyRay {
    /// Distances from the camera, which the device computes with one sum.
    pub(super) fn depths(&self, Interval { low, high }: Interval) -> Interval {
        let (near, far) = (low + self.distance.low, high + self.distance.high);
        Interval { low: near - PAD * U * near.abs(), high: far + PAD * U * far.abs() }
    }
}

impl LegalHits {
    /// Converts distances along the line to distances from the camera.
    fn start_from(&mut self, ray: &AnyRay) {
        let moved = |side| ray.depths(side);
        for hit in &mut self.spheres {
            (hit.near, hit.far) = (hit.near.map(moved), hit.far.map(moved));
        }
        self.limit = moved(Interval { low: self.limit, high: self.limit }).high;
    }
}
