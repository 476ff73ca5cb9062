//! The recording of a scene that an adapter renders, for `pinhole verify`.

use std::path::Path;

use super::recorded::Recorded;
use crate::adapter::AdapterReport;
use crate::args::VerifyArgs;
use crate::device::{WantedAdapter, choice, explained_alone};
use crate::failure::Failure;
use crate::input::Source;
use crate::speak::tell;
use crate::verify_kept::Kept;
use crate::verify_output::VerifyOutputs;
use crate::verify_report::command_line;
use crate::with_scene::{upload, with_structures};
use crate::{
    interrupt, memory, progress, self_test, threads, verify_denoiser, verify_light, verify_lit,
};
use pinhole::accel::Structure;
use pinhole::gpu::{Headless, Progress};
use pinhole::verify::run_file::{self, Provenance, Run};

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
    let headless = wanted.open_any()?;
    self_test::check(&headless)?;
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
    let run = Run { scene: std::sync::Arc::unwrap_or_clone(input.scene), recording, provenance };
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
