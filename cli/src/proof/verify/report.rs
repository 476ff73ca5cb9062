//! The report of `pinhole verify`, as JSON and as text.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::proof::scene_report::SceneReport;
use crate::render::device::AdapterReport;
use crate::terminal::text::in_quotes;
use pinhole::internals::text::{one_line, whole_line};
use pinhole::verify::denoised::DenoiseCertificate;
use pinhole::verify::finished::{FinishedCertificate, PixelVerdict};
use pinhole::verify::run_file::Run;
use pinhole::verify::{
    Certificate, Checker, Deviations, LitCertificate, LitOpen, LitShare, LitViolation, Outcome, Recording, StageCounts,
    UploadError, Verdict, Violation,
};

/// The light of a picture, and what was found of it.
pub(crate) struct JudgedLight {
    /// The certificate of samples, stage by stage, unless nothing is random.
    pub(crate) stages: Option<LitCertificate>,
    /// The certificate of the denoiser, if the scene asks for it.
    pub(crate) denoiser: Option<DenoiseCertificate>,
    /// The verdicts about the picture that `render` makes.
    pub(crate) rendered: FinishedCertificate,
    /// The picture to show.
    pub(crate) shown: FinalPicture,
}

/// A lit picture as people see it. It is not judged.
pub(crate) struct FinalPicture {
    /// The pixels in sRGB with 8 bits, row by row from the top, as exposure and tone curve make them.
    pub(crate) srgb: Vec<[u8; 3]>,
    /// The number of samples of each pixel.
    pub(crate) samples: u32,
    /// The number of samples that the scene asks for.
    pub(crate) wanted: u32,
}

/// The JSON document.
#[derive(Serialize)]
pub(crate) struct Report<'a> {
    pub(crate) version: String,
    pub(crate) adapter: Adapter<'a>,
    /// The keys whose values a run file says of itself, so that nothing proves them.
    hearsay: [&'static str; 4],
    pub(crate) scene: SceneReport,
    pub(crate) picture: Picture,
    pub(crate) counts: BTreeMap<&'static str, usize>,
    pub(crate) decided_fraction: f64,
    pub(crate) worst_depth: f64,
    pub(crate) worst_normal: f64,
    /// Number of pixels in which `render` gives other values than the recording; `None` if it is not known.
    pub(crate) rendered_otherwise: Option<usize>,
    pub(crate) upload: &'a Option<UploadError>,
    pub(crate) violations: &'a [Violation],
    /// The check of the light paths, for a scene with the integrator `path`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) paths: Option<LightReport<'a>>,
    /// The check of the light of a studio, for a scene with the integrator `studio`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) studio: Option<LightReport<'a>>,
    /// The check of the denoiser, for a scene whose picture is denoised.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) denoiser: Option<DenoiserReport<'a>>,
    /// The check of the picture that `render` makes, for a scene with light.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) rendered: Option<RenderedReport>,
    /// Quantities whose results lie to one side of the middle of their bounds: notes, not violations.
    pub(crate) biased: Vec<String>,
    pub(crate) outcome: Outcome,
    pub(crate) legal: bool,
    pub(crate) command: String,
    #[serde(skip)]
    certificate: &'a Certificate,
    pub(crate) open: Vec<OpenPixel>,
}

#[derive(Serialize)]
pub(crate) struct Adapter<'a> {
    #[serde(flatten)]
    pub(crate) adapter: AdapterReport,
    pub(crate) limits: &'a BTreeMap<String, u64>,
}

#[derive(Serialize)]
pub(crate) struct Picture {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) camera: &'static str,
    pub(crate) y_axis: &'static str,
    pub(crate) shading: &'static str,
    pub(crate) structure: String,
}

impl<'a> Report<'a> {
    pub(crate) fn new(run: &'a Run, certificate: &'a Certificate, judged: Option<&'a JudgedLight>) -> Self {
        let Run { scene, recording, provenance } = run;
        let count = |verdict: &Verdict| (verdict.name(), certificate.count(*verdict));
        let light = judged.and_then(|judged| judged.stages.as_ref());
        let denoiser = judged.and_then(|judged| judged.denoiser.as_ref());
        let rendered = judged.map(RenderedReport::new);
        let of_light = light.map_or(Outcome::Proved, LitCertificate::outcome);
        let of_denoiser = denoiser.map_or(Outcome::Proved, DenoiseCertificate::outcome);
        let of_rendered = rendered.as_ref().map_or(Outcome::Proved, |rendered| rendered.outcome);
        let outcome = certificate.outcome().max(of_light).max(of_denoiser).max(of_rendered);
        Self {
            version: one_line(&provenance.version),
            adapter: Adapter { adapter: AdapterReport::of_run(provenance), limits: &provenance.limits },
            hearsay: ["adapter", "command", "picture.structure", "version"],
            scene: SceneReport::new(scene),
            picture: Picture {
                width: recording.film.width(),
                height: recording.film.height(),
                camera: recording.camera.kind.name(),
                y_axis: recording.film.y_axis().name(),
                shading: recording.primary.shading.name(),
                structure: one_line(&provenance.structure),
            },
            counts: Verdict::ALL.iter().map(count).collect(),
            decided_fraction: certificate.decided_fraction(),
            worst_depth: certificate.worst_depth,
            worst_normal: certificate.worst_normal,
            rendered_otherwise: certificate.rendered_otherwise,
            upload: &certificate.upload,
            violations: listed(&certificate.violations),
            paths: light.filter(|light| !light.is_studio).map(LightReport::new),
            studio: light.filter(|light| light.is_studio).map(LightReport::new),
            denoiser: denoiser.map(|found| DenoiserReport { certificate: found, outcome: found.outcome() }),
            rendered,
            biased: [Some(&certificate.deviations), light.map(|light| &light.deviations)]
                .into_iter()
                .flatten()
                .flat_map(Deviations::biased)
                .map(ToString::to_string)
                .collect(),
            outcome,
            legal: outcome == Outcome::Proved,
            command: whole_line(&provenance.command),
            certificate,
            open: Vec::new(),
        }
    }

    /// The check of light, if there is one.
    pub(crate) fn light(&self) -> Option<&LightReport<'a>> {
        self.paths.as_ref().or(self.studio.as_ref())
    }

    pub(crate) fn verdict(&self) -> String {
        match (self.legal, self.upload, self.certificate.count(Verdict::Violation)) {
            (true, ..) => match self.light() {
                Some(light) => format!(
                    "legal: every pixel by one ray, and {}, are as a conforming device may have made them",
                    light.judged.words()
                ),
                None => "legal: every pixel is as a conforming device may have made it".to_owned(),
            },
            (false, ..) if self.outcome == Outcome::Undecided => {
                "undecided: no violation was found, but too many answers could be others".to_owned()
            }
            (false, Some(_), _) => "NOT legal: the data on the device are not those of this scene and view".to_owned(),
            (false, None, 0) if self.light().is_none_or(LightReport::is_without_fault) => {
                let is_denoiser = self.denoiser.as_ref().is_some_and(|found| found.outcome == Outcome::Violated);
                let what = if is_denoiser { "denoised picture" } else { "picture that `render` gives" };
                format!("NOT legal: violations in the {what}")
            }
            (false, None, 0) if self.studio.is_some() => "NOT legal: violations in the light of the studio".to_owned(),
            (false, None, 0) => "NOT legal: violations in the light paths".to_owned(),
            (false, None, 1) => "NOT legal: 1 violation".to_owned(),
            (false, None, count) => format!("NOT legal: {count} violations"),
        }
    }

    /// Returns the report as text. Entries from a run file are on lines of their own.
    pub(crate) fn table(&self) -> String {
        let Picture { width, height, camera, structure, .. } = &self.picture;
        let adapter = one_line(&self.adapter.adapter.line());
        let light = self.light().map_or(String::new(), LightReport::lines);
        let denoiser = self.denoiser.as_ref().map_or(String::new(), DenoiserReport::line);
        let rendered = self.rendered.as_ref().map_or(String::new(), RenderedReport::line);
        format!(
            "adapter: {adapter} (hearsay)\n{}\n\
             picture: {width}x{height}, {camera} camera\n\
             structure: {structure}\n{}\n{light}{denoiser}{rendered}{}\n",
            self.scene.line(),
            self.certificate,
            self.verdict()
        )
    }
}

/// Returns the command line of this program, quoted for a shell.
pub(crate) fn command_line() -> String {
    let arguments = std::env::args_os().skip(1);
    let arguments = arguments.map(|word| in_quotes(&whole_line(&word.to_string_lossy())));
    std::iter::once("pinhole".to_owned()).chain(arguments).collect::<Vec<_>>().join(" ")
}

/// Maximum number of open searches in the table.
const LINES: usize = 3;

/// The object `paths` or `studio` of the JSON document.
#[derive(Serialize)]
pub(crate) struct LightReport<'a> {
    /// Number of paths, or of samples of a studio.
    #[serde(skip_serializing_if = "Option::is_none")]
    paths: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    samples: Option<u64>,
    stages: BTreeMap<&'static str, StageCounts>,
    /// First column and row, width and height of the parts of the film in which samples were checked.
    rectangles: &'a [[u32; 4]],
    judged: JudgedShare,
    upload: &'a Option<UploadError>,
    violation_count: u64,
    violations: &'a [LitViolation],
    outcome: Outcome,
    legal: bool,
    #[serde(skip)]
    certificate: &'a LitCertificate,
    /// The first stages with several legal results, and stages for which the check is weak.
    open: &'a [LitOpen],
}

impl<'a> LightReport<'a> {
    fn new(certificate: &'a LitCertificate) -> Self {
        let LitCertificate { paths, is_studio, violation_count, .. } = *certificate;
        let share = certificate.share();
        Self {
            paths: (!is_studio).then_some(paths),
            samples: is_studio.then_some(paths),
            stages: certificate.named().into_iter().collect(),
            rectangles: &certificate.rectangles,
            judged: JudgedShare { share, fraction: share.fraction() },
            upload: &certificate.upload,
            violation_count,
            violations: listed(&certificate.violations),
            outcome: certificate.outcome(),
            legal: certificate.is_legal(),
            certificate,
            open: &certificate.open,
        }
    }

    /// Lines about the counts, and about the first open searches.
    fn lines(&self) -> String {
        let open = self.open.iter().filter(|open| !open.legal.is_empty());
        let lines = open.take(LINES).map(|open| format!("open: {open}\n"));
        std::iter::once(format!("{}\n", self.certificate)).chain(lines).collect()
    }

    /// Whether no fault is known.
    fn is_without_fault(&self) -> bool {
        self.violation_count == 0 && self.upload.is_none()
    }
}

/// The share of the picture that was judged.
#[derive(Serialize)]
struct JudgedShare {
    #[serde(flatten)]
    share: LitShare,
    fraction: f64,
}

impl JudgedShare {
    fn words(&self) -> String {
        let LitShare { samples, of_samples, pixels, of_pixels, .. } = self.share;
        // The share is rounded down, so that 100 % means all pixels.
        let percent = (self.fraction * 1e6).floor() / 1e4;
        format!("{percent} % of the samples of its light ({samples} of {of_samples} in {pixels} of {of_pixels} pixels)")
    }
}

/// Maximum number of violations in the JSON document.
const LISTED: usize = 100;

fn listed<T>(violations: &[T]) -> &[T] {
    &violations[..violations.len().min(LISTED)]
}

/// Maximum number of pixels with each verdict.
const SHOWN: usize = 3;

/// A pixel with several legal answers.
#[derive(Serialize)]
pub(crate) struct OpenPixel {
    pub(crate) pixel: [u32; 2],
    pub(crate) verdict: Verdict,
    /// Description of the answer found and of the legal ones.
    pub(crate) message: String,
}

/// The first ties and silhouettes.
pub(crate) fn open_pixels(checker: &Checker<'_>, recording: &Recording, certificate: &Certificate) -> Vec<OpenPixel> {
    let width = recording.film.width() as usize;
    let of = |verdict| {
        let all = certificate.verdicts.iter().enumerate();
        let indices = all.filter(move |(_, of)| **of == verdict).map(|(index, _)| index);
        indices.take(SHOWN).filter_map(move |index| {
            let pixel = recording.pixels.get(index)?;
            let ray = pixel.ray?;
            let legal = checker.legal_hits(ray.origin, ray.direction);
            let message = legal.message(pixel.id, pixel.t);
            // The sides of a film are u32.
            let pixel = [(index % width) as u32, (index / width) as u32];
            Some(OpenPixel { pixel, verdict, message })
        })
    };
    of(Verdict::Tie).chain(of(Verdict::Silhouette)).collect()
}

/// The object `denoiser` of the JSON document.
#[derive(Serialize)]
pub(crate) struct DenoiserReport<'a> {
    #[serde(flatten)]
    certificate: &'a DenoiseCertificate,
    outcome: Outcome,
}

impl DenoiserReport<'_> {
    fn line(&self) -> String {
        let DenoiseCertificate { pixels, undecided, violation_count, .. } = self.certificate;
        let legal = pixels - undecided - violation_count;
        format!("denoiser: {pixels} pixels: {legal} legal, {undecided} undecided, {violation_count} violations\n")
    }
}

/// The object `rendered` of the JSON document.
#[derive(Serialize)]
pub(crate) struct RenderedReport {
    samples: u32,
    of_samples: u32,
    /// The number of pixels with each verdict.
    pixels: BTreeMap<&'static str, usize>,
    violation: Option<String>,
    outcome: Outcome,
}

impl RenderedReport {
    fn new(JudgedLight { rendered, shown, .. }: &JudgedLight) -> Self {
        Self {
            samples: shown.samples,
            of_samples: shown.wanted,
            pixels: PixelVerdict::ALL.iter().map(|verdict| (verdict.name(), rendered.count(*verdict))).collect(),
            violation: rendered.violations.first().map(ToString::to_string),
            outcome: rendered.outcome_of_device(),
        }
    }

    fn line(&self) -> String {
        let Self { samples, of_samples, pixels, .. } = self;
        let count = |verdict: &PixelVerdict| format!("{} {}", pixels[verdict.name()], verdict.name());
        let counts: Vec<_> = PixelVerdict::ALL.iter().map(count).collect();
        format!("picture of render, {samples} of {of_samples} samples: pixels: {}\n", counts.join(", "))
    }
}
