//! `pinhole verify`: checks whether a picture is legal that an adapter renders now, or that was recorded before.

use std::path::Path;

use anyhow::{Context, anyhow};

use super::args::VerifyArgs;
use super::failure::Failure;
use super::speak::answer;
use super::verify_kept::{Kept, Replayed};
use super::verify_open::open_pixels;
use super::verify_output::VerifyOutputs;
use super::verify_report::Report;
use super::{progress, threads, verify_kept, verify_picture};
use pinhole::verify::denoised::DenoiseCertificate;
use pinhole::verify::run_file::Run;
use pinhole::verify::{Certificate, Checker, LitCertificate, MOST_UNDECIDED, Outcome, Verdict};

pub(super) fn run(args: &VerifyArgs) -> Result<(), Failure> {
    if let (Some(scene), Some(picture)) = (&args.scene, &args.path) {
        return verify_picture::run(args, picture, scene);
    }
    let Recorded { run, outputs, light, denoiser, kept } = match (&args.replay, &args.path) {
        (Some(path), _) => replayed(path, args)?,
        (None, Some(path)) => recorded::recorded(path, args)?,
        (None, None) => return Err(Failure::usage("name a scene or data file, or --replay RUN")),
    };
    progress::stage("checking");
    let checker = Checker::new(&run.scene).context("the checker cannot be prepared")?;
    let certificate = checker.certify(&run.recording);
    let mut report = Report::new(&run, &certificate, light.as_ref(), denoiser.as_ref());
    report.open = open_pixels(&checker, &run.recording, &certificate);
    drop(checker);
    progress::clear();
    answer(report.table().as_bytes()).context("standard output: cannot be written")?;
    outputs.write(&run, &certificate, &report, &kept)?;
    let of_light = light.as_ref().map_or(Ok(()), verdict_of_light);
    let of_denoiser = denoiser.as_ref().map_or(Ok(()), verdict_of_denoiser);
    worse(worse(verdict(&certificate), of_light), of_denoiser)
}

/// The first failure, but a violation says more than what is undecided.
fn worse(first: Result<(), Failure>, second: Result<(), Failure>) -> Result<(), Failure> {
    match (first, second) {
        (Err(Failure::Undecided(_)), Err(worse @ Failure::CheckFailed(_))) => Err(worse),
        (first, second) => first.and(second),
    }
}

/// Reads a saved recording, and checks its light.
fn replayed(path: &Path, args: &VerifyArgs) -> Result<Recorded, Failure> {
    let outputs = VerifyOutputs::new(args)?;
    outputs.check_not_inputs(&[path.to_path_buf()])?;
    threads::start()?;
    let Replayed { run, light, denoiser, kept } = verify_kept::replay(path)?;
    Ok(Recorded { run, outputs, light, denoiser, kept })
}

fn verdict(certificate: &Certificate) -> Result<(), Failure> {
    if let Some(error) = &certificate.upload {
        return Err(Failure::CheckFailed(anyhow!("the picture is not legal: {error}")));
    }
    if certificate.outcome() == Outcome::Undecided {
        let (count, all) = (certificate.undecided(), certificate.verdicts.len());
        return Err(undecided(&format!("{count} of {all} pixels have several legal answers")));
    }
    match certificate.violations.first() {
        None => Ok(()),
        Some(first) => Err(Failure::CheckFailed(anyhow!(
            "the picture is not legal: {} of {} pixels; the first is {first}",
            certificate.count(Verdict::Violation),
            certificate.verdicts.len()
        ))),
    }
}

/// The failure of a check that says too little.
fn undecided(what: &str) -> Failure {
    let percent = 100.0 * MOST_UNDECIDED;
    Failure::Undecided(anyhow!("no violation was found, but {what}; at most {percent} % may"))
}

fn verdict_of_light(certificate: &LitCertificate) -> Result<(), Failure> {
    let what = if certificate.is_studio { "the studio is" } else { "the paths are" };
    if let Some(error) = &certificate.upload {
        return Err(Failure::CheckFailed(anyhow!("{what} not legal: {error}")));
    }
    if certificate.outcome() == Outcome::Undecided {
        let stages = certificate.stages();
        return Err(undecided(&format!(
            "the bounds of {} of {} stages of light are so wide that they say little",
            stages.undecided, stages.checked
        )));
    }
    match certificate.violations.first() {
        None => Ok(()),
        Some(first) => Err(Failure::CheckFailed(anyhow!(
            "{what} not legal: {} of {} stages; the first is {first}",
            certificate.violation_count,
            certificate.stages().checked
        ))),
    }
}

fn verdict_of_denoiser(certificate: &DenoiseCertificate) -> Result<(), Failure> {
    let DenoiseCertificate { pixels, undecided: vague, violation_count, .. } = *certificate;
    if certificate.outcome() == Outcome::Undecided {
        let what = format!("the bounds of {vague} of {pixels} denoised pixels say little");
        return Err(undecided(&what));
    }
    match certificate.violations.first() {
        None => Ok(()),
        Some(first) => Err(Failure::CheckFailed(anyhow!(
            "the denoised picture is not legal: {violation_count} of {pixels} pixels; the first is {first}"
        ))),
    }
}

/// What is to be checked and written.
struct Recorded {
    run: Run,
    outputs: VerifyOutputs,
    /// The certificate of the light, if it was checked.
    light: Option<LitCertificate>,
    /// The certificate of the denoiser, if the scene asks for it.
    denoiser: Option<DenoiseCertificate>,
    /// What is kept of the light, for a run file and the page.
    kept: Kept,
}

#[cfg(not(feature = "gpu"))]
mod recorded {
    use super::*;

    pub(super) fn recorded(_: &Path, _: &VerifyArgs) -> Result<Recorded, Failure> {
        Err(Failure::usage(
            "this program was built without the feature `gpu`, so it can only check recordings: \
             `pinhole verify --replay RUN`",
        ))
    }
}

#[cfg(feature = "gpu")]
mod recorded {
    use super::*;
    use crate::adapter::AdapterReport;
    use crate::device::{WantedAdapter, choice, explained_alone};
    use crate::input::Source;
    use crate::speak::tell;
    use crate::verify_report::command_line;
    use crate::with_scene::{upload, with_structures};
    use crate::{
        interrupt, memory, prices, progress, self_test, verify_denoiser, verify_light, verify_lit,
    };
    use pinhole::accel::Structure;
    use pinhole::gpu::{Headless, Progress};
    use pinhole::verify::run_file::{self, Provenance};

    /// Renders a scene on an adapter and records it.
    pub(super) fn recorded(path: &Path, args: &VerifyArgs) -> Result<Recorded, Failure> {
        let source = Source::of_view(path, &args.view)?.without_bricks("`verify`")?;
        let outputs = VerifyOutputs::new(args)?;
        let wanted = WantedAdapter::new(&args.adapter).for_structures(args.accel.accel);
        threads::start()?;
        let input = source.load()?;
        outputs.check_not_inputs(&input.files)?;
        for note in &input.notes {
            tell(format_args!("note: {note}"));
        }
        if input.eyes.is_some() {
            tell(
                "note: the camera has two eyes; only the view from the middle between them is checked",
            );
        }
        let is_lit = !input.settings.integrator.is_primary();
        if !is_lit && args.paths.is_some() {
            return Err(Failure::usage(
                "--paths needs a scene with the integrator `studio` or `path`; remove --paths",
            ));
        }
        if !is_lit && args.tile_seed.is_some() {
            return Err(Failure::usage(
                "--tile-seed needs a scene with the integrator `studio` or `path`; remove --tile-seed",
            ));
        }
        // Of each sample the middle is recorded, and a part elsewhere.
        let most = run_file::MAX_SAMPLES / 2;
        if args.save.is_some() && args.paths.is_some_and(|paths| paths > most) {
            return Err(Failure::usage(format!(
                "a run file has room for {most} samples of each pixel; choose --paths {most} or less"
            )));
        }
        let mut headless = wanted.open_any()?;
        self_test::check(&headless)?;
        let (_, note) = prices::use_measured(&mut headless);
        note.iter().for_each(|note| tell(format_args!("note: {note}")));
        let (scene, view) = (&input.scene, &input.view());
        let settings = &input.settings.by_primary_rays();
        let choice = choice(args.accel.accel);
        let encoding = memory::ENCODING_BYTES_PER_PIXEL;
        let plan = |choice| headless.plan_record(scene, view, choice, encoding);
        let done = with_structures(&headless, choice, plan, |plan| {
            interrupt::on_device(|| {
                let buffers = upload(&headless, scene, plan)?;
                progress::stage("preparing");
                let watch = &mut |progress: &Progress| {
                    progress::tracing(progress.part);
                    interrupt::decide()
                };
                headless.record_and_render(&buffers, view, settings, watch)
            })
        })?;
        let (recording, structure) = done.map_err(|error| explained_alone(&headless, &error))?;
        let provenance = provenance(&headless, structure);
        let chosen = (args.paths.unwrap_or(1), args.tile_seed);
        let mut kept = Kept::beside(outputs.save().filter(|_| is_lit))?;
        let certify =
            || verify_light::certify(&headless, &input, chosen, choice, kept.samples.as_mut());
        let light = is_lit.then(certify).transpose()?;
        if input.settings.is_denoised {
            kept.denoised = Some(verify_denoiser::render(&headless, &input, choice)?);
        }
        let denoiser = kept.denoised.as_ref().map(verify_denoiser::judge).transpose()?;
        if is_lit && outputs.has_picture() {
            kept.shown = Some(verify_lit::render(&headless, &input, choice)?);
        }
        let run =
            Run { scene: std::sync::Arc::unwrap_or_clone(input.scene), recording, provenance };
        Ok(Recorded { run, outputs, light, denoiser, kept })
    }

    fn provenance(headless: &Headless, structure: Structure) -> Provenance {
        let AdapterReport { name, backend, device_type, driver, driver_info } =
            AdapterReport::of(headless);
        let limits = headless.device().limits();
        let limits = [
            ("max_buffer_size", limits.max_buffer_size),
            ("max_storage_buffer_binding_size", limits.max_storage_buffer_binding_size),
            ("max_texture_dimension_2d", limits.max_texture_dimension_2d.into()),
        ];
        Provenance {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            command: command_line(),
            adapter: name,
            backend,
            device_type,
            driver,
            driver_info,
            structure: structure.name().to_owned(),
            limits: limits.map(|(name, limit)| (name.to_owned(), limit)).into(),
        }
    }
}
