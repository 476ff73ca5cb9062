//! The report of `pinhole verify`, as JSON and as text.

use std::collections::BTreeMap;

use serde::Serialize;

use super::adapter::AdapterReport;
use super::shell::in_quotes;
use super::verify_denoiser::DenoiserReport;
use super::verify_light::LightReport;
use super::verify_listed::{LISTED, Listed};
use super::verify_open::OpenPixel;
use pinhole::internals::text::one_line;
use pinhole::verify::denoised::DenoiseCertificate;
use pinhole::verify::run_file::{Run, scene_sha256};
use pinhole::verify::{Certificate, Deviations, LitCertificate, Outcome, Verdict};

/// The JSON document.
#[derive(Serialize)]
pub(super) struct Report {
    pub(super) version: String,
    pub(super) adapter: Adapter,
    pub(super) scene: Scene,
    pub(super) picture: Picture,
    pub(super) counts: BTreeMap<&'static str, usize>,
    pub(super) decided_fraction: f64,
    pub(super) worst_depth: f64,
    pub(super) worst_normal: f64,
    /// Number of pixels in which `render` gives other values than the recording; `None` if that is not known.
    pub(super) rendered_otherwise: Option<usize>,
    pub(super) upload: Option<String>,
    pub(super) violations: Vec<Listed>,
    /// The check of the light paths, for a scene with the integrator `path`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) paths: Option<LightReport>,
    /// The check of the light of a studio, for a scene with the integrator `studio`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) studio: Option<LightReport>,
    /// The check of the denoiser, for a scene whose picture is denoised.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) denoiser: Option<DenoiserReport>,
    /// Quantities whose results lie to one side of the middle of their bounds: notes, not violations.
    pub(super) biased: Vec<String>,
    pub(super) outcome: &'static str,
    pub(super) legal: bool,
    pub(super) command: String,
    /// The certificate as a table of text.
    #[serde(skip)]
    table: String,
    /// The first pixels with several legal answers.
    pub(super) open: Vec<OpenPixel>,
}

#[derive(Serialize)]
pub(super) struct Adapter {
    #[serde(flatten)]
    pub(super) adapter: AdapterReport,
    pub(super) limits: BTreeMap<String, u64>,
}

#[derive(Serialize)]
pub(super) struct Scene {
    pub(super) spheres: usize,
    pub(super) sha256: String,
}

#[derive(Serialize)]
pub(super) struct Picture {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) camera: &'static str,
    pub(super) y_axis: &'static str,
    pub(super) shading: &'static str,
    pub(super) structure: String,
}

impl Report {
    pub(super) fn new(
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
    pub(super) fn light(&self) -> Option<&LightReport> {
        self.paths.as_ref().or(self.studio.as_ref())
    }

    /// Returns the verdict on one line.
    pub(super) fn verdict(&self) -> String {
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

    pub(super) fn count(&self, verdict: Verdict) -> usize {
        self.counts.get(verdict.name()).copied().unwrap_or_default()
    }

    /// Returns the report as text. Each entry that comes from a run file has a line of its own.
    pub(super) fn table(&self) -> String {
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
pub(super) fn command_line() -> String {
    let arguments = std::env::args_os().skip(1);
    let arguments = arguments.map(|word| in_quotes(&one_line(&word.to_string_lossy())));
    std::iter::once("pinhole".to_owned()).chain(arguments).collect::<Vec<_>>().join(" ")
}
