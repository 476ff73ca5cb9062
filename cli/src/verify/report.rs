//! The report of `pinhole verify`, as JSON and as text.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use serde::Serialize;

use crate::device::AdapterReport;
use crate::text::in_quotes;
use pinhole::image::Image;
use pinhole::internals::text::one_line;
use pinhole::verify::denoised::{self, DenoiseCertificate};
use pinhole::verify::run_file::{Run, scene_sha256};
use pinhole::verify::{
    Certificate, Checker, Deviations, LitCertificate, LitOpen, LitShare, LitViolation, Outcome,
    Recording, StageCounts, Verdict, Violation,
};

/// The JSON document.
#[derive(Serialize)]
pub(crate) struct Report {
    pub(crate) version: String,
    pub(crate) adapter: Adapter,
    pub(crate) scene: Scene,
    pub(crate) picture: Picture,
    pub(crate) counts: BTreeMap<&'static str, usize>,
    pub(crate) decided_fraction: f64,
    pub(crate) worst_depth: f64,
    pub(crate) worst_normal: f64,
    /// Number of pixels in which `render` gives other values than the recording; `None` if that is not known.
    pub(crate) rendered_otherwise: Option<usize>,
    pub(crate) upload: Option<String>,
    pub(crate) violations: Vec<Listed>,
    /// The check of the light paths, for a scene with the integrator `path`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) paths: Option<LightReport>,
    /// The check of the light of a studio, for a scene with the integrator `studio`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) studio: Option<LightReport>,
    /// The check of the denoiser, for a scene whose picture is denoised.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) denoiser: Option<DenoiserReport>,
    /// Quantities whose results lie to one side of the middle of their bounds: notes, not violations.
    pub(crate) biased: Vec<String>,
    pub(crate) outcome: &'static str,
    pub(crate) legal: bool,
    pub(crate) command: String,
    /// The certificate as a table of text.
    #[serde(skip)]
    table: String,
    /// The first pixels with several legal answers.
    pub(crate) open: Vec<OpenPixel>,
}

#[derive(Serialize)]
pub(crate) struct Adapter {
    #[serde(flatten)]
    pub(crate) adapter: AdapterReport,
    pub(crate) limits: BTreeMap<String, u64>,
}

#[derive(Serialize)]
pub(crate) struct Scene {
    pub(crate) spheres: usize,
    pub(crate) sha256: String,
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

impl Report {
    pub(crate) fn new(
        run: &Run,
        certificate: &Certificate,
        light: Option<&LitCertificate>,
        denoiser: Option<&DenoiseCertificate>,
    ) -> Self {
        let Run { scene, recording, provenance } = run;
        let count = |verdict: &Verdict| (verdict.name(), certificate.count(*verdict));
        let of_light = light.map_or(Outcome::Proved, LitCertificate::outcome);
        let of_denoiser = denoiser.map_or(Outcome::Proved, DenoiseCertificate::outcome);
        let outcome = certificate.outcome().max(of_light).max(of_denoiser);
        Self {
            version: one_line(&provenance.version),
            adapter: Adapter {
                adapter: AdapterReport::of_run(provenance),
                limits: provenance.limits.clone(),
            },
            scene: Scene { spheres: scene.len(), sha256: scene_sha256(scene) },
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
            upload: certificate.upload.as_ref().map(ToString::to_string),
            violations: certificate.violations.iter().take(LISTED).map(Listed::from).collect(),
            paths: light.filter(|light| !light.is_studio).map(LightReport::from),
            studio: light.filter(|light| light.is_studio).map(LightReport::from),
            denoiser: denoiser.map(DenoiserReport::from),
            biased: [Some(&certificate.deviations), light.map(|light| &light.deviations)]
                .into_iter()
                .flatten()
                .flat_map(Deviations::biased)
                .map(ToString::to_string)
                .collect(),
            outcome: outcome.name(),
            legal: outcome == Outcome::Proved,
            command: one_line(&provenance.command),
            table: certificate.to_string(),
            open: Vec::new(),
        }
    }

    /// The check of light, if there was one.
    pub(crate) fn light(&self) -> Option<&LightReport> {
        self.paths.as_ref().or(self.studio.as_ref())
    }

    pub(crate) fn verdict(&self) -> String {
        match (self.legal, &self.upload, self.count(Verdict::Violation)) {
            (true, ..) => match self.light() {
                Some(light) => format!(
                    "legal: every pixel by one ray, and {}, are as a conforming device may have made them",
                    light.judged.words()
                ),
                None => "legal: every pixel is as a conforming device may have made it".to_owned(),
            },
            (false, ..) if self.outcome == Outcome::Undecided.name() => {
                "undecided: no violation was found, but too many answers could be others".to_owned()
            }
            (false, Some(_), _) => {
                "NOT legal: the data on the device are not those of this scene and view".to_owned()
            }
            (false, None, 0) if self.light().is_none_or(LightReport::is_without_fault) => {
                "NOT legal: violations in the denoised picture".to_owned()
            }
            (false, None, 0) if self.studio.is_some() => {
                "NOT legal: violations in the light of the studio".to_owned()
            }
            (false, None, 0) => "NOT legal: violations in the light paths".to_owned(),
            (false, None, 1) => "NOT legal: 1 violation".to_owned(),
            (false, None, count) => format!("NOT legal: {count} violations"),
        }
    }

    pub(crate) fn count(&self, verdict: Verdict) -> usize {
        self.counts.get(verdict.name()).copied().unwrap_or_default()
    }

    /// Returns the report as text. Each entry that comes from a run file has a line of its own.
    pub(crate) fn table(&self) -> String {
        let Scene { spheres, sha256 } = &self.scene;
        let Picture { width, height, camera, structure, .. } = &self.picture;
        let adapter = one_line(&self.adapter.adapter.line());
        let line = |line: String| line + "\n";
        let light = self.light().map_or(String::new(), LightReport::lines);
        let denoiser = self.denoiser.as_ref().map_or(String::new(), |found| line(found.line()));
        format!(
            "adapter: {adapter}\nscene: {spheres} spheres, {} bytes, sha256 {sha256}\n\
             picture: {width}x{height}, {camera} camera\n\
             structure: {structure}\n{}\n{light}{denoiser}{}\n",
            16 * spheres,
            self.table,
            self.verdict()
        )
    }
}

/// Returns the command line of this program, quoted for a shell.
pub(crate) fn command_line() -> String {
    let arguments = std::env::args_os().skip(1);
    let arguments = arguments.map(|word| in_quotes(&one_line(&word.to_string_lossy())));
    std::iter::once("pinhole".to_owned()).chain(arguments).collect::<Vec<_>>().join(" ")
}

/// The largest number of open searches in the table.
const LINES: usize = 3;

/// The object `paths` or `studio` of the JSON document.
#[derive(Serialize)]
pub(crate) struct LightReport {
    /// Number of paths, or of samples of a studio.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) paths: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) samples: Option<u64>,
    pub(crate) stages: BTreeMap<&'static str, Counts>,
    /// First column and row, width and height of the parts of the film in which samples were checked.
    pub(crate) rectangles: Vec<[u32; 4]>,
    pub(crate) judged: Judged,
    pub(crate) upload: Option<String>,
    pub(crate) violation_count: u64,
    pub(crate) violations: Vec<ListedStage>,
    pub(crate) outcome: &'static str,
    pub(crate) legal: bool,
    /// The certificate as one line of text.
    #[serde(skip)]
    pub(crate) line: String,
    /// The first stages with several legal results, and those of which the check says little.
    pub(crate) open: Vec<ListedOpen>,
}

impl LightReport {
    /// Lines of text about the counts, and about the first open searches.
    pub(crate) fn lines(&self) -> String {
        let open = self.open.iter().filter(|open| !open.legal.is_empty());
        let lines = open.take(LINES).map(|open| format!("open: {}\n", open.line));
        std::iter::once(format!("{}\n", self.line)).chain(lines).collect()
    }

    /// Whether nothing is known to be wrong.
    pub(crate) fn is_without_fault(&self) -> bool {
        self.violation_count == 0 && self.upload.is_none()
    }
}

/// How much of the picture was judged.
#[derive(Serialize)]
pub(crate) struct Judged {
    samples: u64,
    of_samples: u64,
    pixels: u64,
    of_pixels: u64,
    fraction: f64,
}

impl From<LitShare> for Judged {
    fn from(share: LitShare) -> Self {
        let LitShare { samples, of_samples, pixels, of_pixels, .. } = share;
        Self { samples, of_samples, pixels, of_pixels, fraction: share.fraction() }
    }
}

impl Judged {
    /// The share in words.
    pub(crate) fn words(&self) -> String {
        let Self { samples, of_samples, pixels, of_pixels, fraction } = self;
        // Rounded down, so that nothing but all of them is called 100 %.
        let percent = (fraction * 1e6).floor() / 1e4;
        format!(
            "{percent} % of the samples of its light ({samples} of {of_samples} in {pixels} of {of_pixels} pixels)"
        )
    }
}

/// A stage that is open, or of which the check says little.
#[derive(Serialize)]
pub(crate) struct ListedOpen {
    pub(crate) pixel: [u32; 2],
    pub(crate) sample: u32,
    pub(crate) surface: u32,
    pub(crate) stage: &'static str,
    pub(crate) is_undecided: bool,
    /// Of an open search, up to four legal answers.
    pub(crate) legal: Vec<String>,
    /// The same as one line of text.
    #[serde(skip)]
    pub(crate) line: String,
}

impl From<&LitOpen> for ListedOpen {
    fn from(open: &LitOpen) -> Self {
        let LitOpen { pixel, sample, surface, stage, is_undecided, ref legal, .. } = *open;
        let (stage, legal, line) = (stage.name(), legal.clone(), open.to_string());
        Self { pixel, sample, surface, stage, is_undecided, legal, line }
    }
}

#[derive(Serialize)]
pub(crate) struct Counts {
    pub(crate) checked: u64,
    pub(crate) decided: u64,
    pub(crate) open: u64,
    pub(crate) undecided: u64,
}

#[derive(Serialize)]
pub(crate) struct ListedStage {
    pub(crate) pixel: [u32; 2],
    pub(crate) sample: u32,
    pub(crate) surface: u32,
    pub(crate) stage: &'static str,
    pub(crate) message: String,
}

impl From<StageCounts> for Counts {
    fn from(StageCounts { checked, decided, open, undecided, .. }: StageCounts) -> Self {
        Self { checked, decided, open, undecided }
    }
}

impl From<&LitViolation> for ListedStage {
    fn from(violation: &LitViolation) -> Self {
        let LitViolation { pixel, sample, surface, stage, message, .. } = violation;
        let (stage, message) = (stage.name(), message.clone());
        Self { pixel: *pixel, sample: *sample, surface: *surface, stage, message }
    }
}

impl From<&LitCertificate> for LightReport {
    fn from(certificate: &LitCertificate) -> Self {
        let LitCertificate { paths, is_studio, .. } = *certificate;
        let stages = certificate.named();
        Self {
            paths: (!is_studio).then_some(paths),
            samples: is_studio.then_some(paths),
            stages: stages.into_iter().map(|(name, counts)| (name, counts.into())).collect(),
            rectangles: certificate.rectangles.clone(),
            judged: certificate.share().into(),
            open: certificate.open.iter().map(ListedOpen::from).collect(),
            upload: certificate.upload.as_ref().map(ToString::to_string),
            violation_count: certificate.violation_count,
            violations: certificate.violations.iter().take(LISTED).map(ListedStage::from).collect(),
            outcome: certificate.outcome().name(),
            legal: certificate.is_legal(),
            line: certificate.to_string(),
        }
    }
}

/// The largest number of violations in the JSON document.
pub(crate) const LISTED: usize = 100;

/// A violation with its message.
#[derive(Serialize)]
pub(crate) struct Listed {
    pub(crate) pixel: [u32; 2],
    pub(crate) stage: &'static str,
    pub(crate) message: String,
}

impl From<&Violation> for Listed {
    fn from(violation: &Violation) -> Self {
        Self { pixel: violation.pixel, stage: violation.stage, message: violation.message.clone() }
    }
}

/// The largest number of pixels with each verdict.
const SHOWN: usize = 3;

/// A pixel with several legal answers.
#[derive(Serialize)]
pub(crate) struct OpenPixel {
    pub(crate) pixel: [u32; 2],
    pub(crate) verdict: &'static str,
    /// The answer that was found, and the legal ones.
    pub(crate) message: String,
}

/// The first ties and silhouettes.
pub(crate) fn open_pixels(
    checker: &Checker<'_>,
    recording: &Recording,
    certificate: &Certificate,
) -> Vec<OpenPixel> {
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
            Some(OpenPixel { pixel, verdict: verdict.name(), message })
        })
    };
    of(Verdict::Tie).chain(of(Verdict::Silhouette)).collect()
}

/// The object `denoiser` of the JSON document.
#[derive(Serialize)]
pub(crate) struct DenoiserReport {
    pixels: u64,
    undecided: u64,
    violation_count: u64,
    violations: Vec<String>,
    outcome: &'static str,
}

impl From<&DenoiseCertificate> for DenoiserReport {
    fn from(certificate: &DenoiseCertificate) -> Self {
        let DenoiseCertificate { pixels, undecided, violation_count, ref violations, .. } =
            *certificate;
        Self {
            pixels,
            undecided,
            violation_count,
            violations: violations.iter().take(LISTED).map(ToString::to_string).collect(),
            outcome: certificate.outcome().name(),
        }
    }
}

impl DenoiserReport {
    /// The report as one line of text.
    pub(crate) fn line(&self) -> String {
        let Self { pixels, undecided, violation_count, .. } = self;
        let legal = pixels - undecided - violation_count;
        format!(
            "denoiser: {pixels} pixels: {legal} legal, {undecided} undecided, {violation_count} violations"
        )
    }
}

/// Judges what the device made of a noisy picture.
pub(crate) fn judge([noisy, quiet]: &[Image; 2]) -> Result<DenoiseCertificate> {
    denoised::certify(noisy, quiet).context("the denoiser cannot be checked")
}
