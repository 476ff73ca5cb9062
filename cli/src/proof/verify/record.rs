//! Recordings of a device for `pinhole verify`: a picture with one ray per pixel, samples of light, and denoising.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use anyhow::Context;

use crate::input::{Input, Source};
use crate::output::picture::{Outputs, PictureFormat};
use crate::proof::certified::{self, FilePicture};
use crate::proof::render_certified::witness;
use crate::proof::self_test;
use crate::proof::verify::args::VerifyArgs;
use crate::proof::verify::output::{VerifyJob, VerifyOutputs};
use crate::proof::verify::report::{FinalPicture, JudgedLight, command_line};
use crate::render::device::{AdapterReport, OpenDevice, WantedAdapter, explained_alone};
use crate::render::views::views_of;
use crate::render::with_scene::{upload, with_structures};
use crate::render::{self, ghosts};
use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, tell};
use crate::terminal::{interrupt, memory, threads};
use pinhole::accel::{AccelChoice, Structure};
use pinhole::gpu::{Headless, LitPart, Progress, SampleRequest, Wait};
use pinhole::image::color::to_srgb8;
use pinhole::image::denoise::GUIDES;
use pinhole::image::{Image, LayerSet};
use pinhole::verify::denoised;
use pinhole::verify::finished::FinishedCertificate;
use pinhole::verify::run_file::{Provenance, Run};
use pinhole::verify::{Checker, LitCertificate, LitRecording};

/// Renders a scene on an adapter and records it.
pub(crate) fn recorded(path: &Path, args: &VerifyArgs) -> Result<VerifyJob, Failure> {
    let source = Source::new(path, &args.view.given)?.without_bricks("`verify`")?;
    let outputs = VerifyOutputs::new(args)?;
    let wanted = WantedAdapter::new(&args.adapter).for_structures(args.accel.accel);
    threads::start()?;
    let input = source.load()?;
    outputs.check_not_inputs(&input.files)?;
    for note in &input.notes {
        tell(format_args!("note: {note}"));
    }
    ghosts::note(&input, "not checked").iter().for_each(tell);
    if input.eyes.is_some() {
        tell("note: the camera has two eyes; only the view from the middle between them is checked");
    }
    let is_lit = !input.settings.integrator.is_primary();
    for (flag, is_given) in [("--paths", args.paths.is_some()), ("--tile-seed", args.tile_seed.is_some())] {
        if is_given && !input.has_random_light() {
            return Err(Failure::usage(format!(
                "{flag} needs light that is sampled at random, and this picture has none; remove {flag}"
            )));
        }
    }
    if is_lit && args.save.is_some() {
        tell(
            "note: run files do not keep light: the file holds the picture by one ray for each pixel; `pinhole render \
             --certify` writes a picture with light that can be judged anywhere",
        );
    }
    let headless = wanted.open_any()?;
    self_test::check(&headless)?;
    let (scene, view) = (&input.scene, &input.view());
    let settings = &input.settings.by_primary_rays();
    let choice = args.accel.accel.unwrap_or_default();
    let encoding = memory::ENCODING_BYTES_PER_PIXEL;
    let plan = |choice| headless.plan_record(scene, view, choice, encoding);
    let decide = |progress: &Progress| {
        progress::tracing(progress.part);
        interrupt::decide()
    };
    let done = with_structures(&headless, choice, plan, |plan| {
        interrupt::on_device(|| {
            let buffers = upload(&headless, scene, plan)?;
            progress::stage("preparing");
            headless.record_and_render(&buffers, view, settings, &mut decide.clone()).wait()
        })
    })?;
    let (mut recording, structure) = done.map_err(|error| explained_alone(&headless, &error))?;
    if choice == AccelChoice::Auto {
        let compared = || headless.compare_single(&mut recording, scene, view, settings, &mut decide.clone()).wait();
        interrupt::on_device(compared)?.map_err(|error| explained_alone(&headless, &error))?;
    }
    let provenance = provenance(&headless, structure);
    let chosen = (args.paths.unwrap_or(1), args.tile_seed);
    let scene = input.scene.clone();
    let light = is_lit.then(|| judged_light(input, headless, chosen, choice)).transpose()?;
    let run = Run { scene: Arc::unwrap_or_clone(scene), recording, provenance };
    Ok(VerifyJob { run, outputs, light })
}

fn provenance(headless: &Headless, structure: Structure) -> Provenance {
    let AdapterReport { name, backend, device_type, driver, driver_info } = AdapterReport::of(headless.adapter_info());
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

/// Records this number of samples on an adapter, one after the other, in the middle of the film and in a random
/// part, and checks them.
fn certify_light(
    headless: &Headless,
    input: &Input,
    (count, tile_seed): (u32, Option<u32>),
    choice: AccelChoice,
) -> Result<LitCertificate, Failure> {
    let Input { scene, settings, .. } = input;
    let (view, views) = (input.view(), views_of(input, input.film));
    let samples = chosen(settings.sampling.samples, count, settings.sampling.seed);
    let plan = |choice| render::plan(headless, input, &views, LayerSet::COLOR, choice, false);
    let tile_seed = tile_seed.unwrap_or_else(any_seed);
    let done = with_structures(headless, choice, plan, |plan| {
        let uploaded = interrupt::on_device(|| upload(headless, scene, plan))?;
        let buffers = match uploaded {
            Ok(buffers) => buffers,
            Err(error) => return Ok(Err(error)),
        };
        let checker = Checker::new(scene).context("the checker cannot be prepared")?;
        let mut certificate = LitCertificate::default();
        let recording = "recording light";
        progress::stage(recording);
        let recorded = interrupt::on_device(|| {
            let each = &mut |recorded: &LitRecording| {
                interrupt::driver_rests(true);
                progress::stage("checking light");
                certificate.join(checker.certify_lit(recorded));
                progress::stage(recording);
                interrupt::driver_rests(false);
            };
            let watch = &mut |_: &_| interrupt::decide();
            [LitPart::Middle, LitPart::Random(tile_seed)].into_iter().try_for_each(|part| {
                let request = SampleRequest { part, samples: &samples };
                headless.record_lit(&buffers, &view, settings, request, each, watch).wait()
            })
        })?;
        Ok(recorded.map(|()| certificate))
    })?;
    let (certificate, _) = done.map_err(|error| explained_alone(headless, &error))?;
    if let [_, [x, y, width, height]] = certificate.rectangles[..] {
        tell(format_args!(
            "note: light was checked in the middle and in {width}x{height} pixels at ({x}, {y}); to check the \
             same again, add --tile-seed {tile_seed}"
        ));
    }
    Ok(certificate)
}

/// A number that differs in each run.
fn any_seed() -> u32 {
    use std::hash::{BuildHasher, RandomState};
    RandomState::new().hash_one(0) as u32
}

/// The indices of the samples to check: `count` of those of a picture, including the last and, if there are several,
/// the first. Others are random. If the picture has fewer samples, the first `count` are chosen.
fn chosen(all: u32, count: u32, seed: u32) -> Vec<u32> {
    let all = all.max(1);
    if count >= all {
        return (0..count).collect();
    }
    let mut chosen = BTreeSet::from([all - 1]);
    if count > 1 {
        chosen.insert(0);
    }
    let mut random = seed;
    while chosen.len() < count as usize {
        // A linear congruential generator, whose upper bits are used (Numerical Recipes, section 7.1).
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        chosen.insert(((u64::from(random) * u64::from(all)) >> 32) as u32);
    }
    chosen.into_iter().collect()
}

/// The most samples of the picture that is judged as a whole. More would take long, and the program takes them alike.
const PICTURE_SAMPLES: u32 = 16;

/// Judges samples of the light stage by stage. Then renders the view as `render` does, with its light but few samples, and
/// judges every pixel of the raw picture, and the removal of noise.
fn judged_light(
    mut input: Input,
    headless: Headless,
    chosen: (u32, Option<u32>),
    choice: AccelChoice,
) -> Result<JudgedLight, Failure> {
    let stages = input.has_random_light().then(|| certify_light(&headless, &input, chosen, choice)).transpose()?;
    let wanted = input.settings.sampling.samples;
    let samples = wanted.min(PICTURE_SAMPLES);
    input.settings.sampling.samples = samples;
    input.settings.is_transparent = input.encoding.transparent;
    input.eyes = None;
    let finished = input.settings.clone();
    input.settings = finished.unfinished();
    let outputs = Outputs::unwritten(PictureFormat::Exr);
    let layers = outputs.layers(&input.encoding);
    let opened = OpenDevice::Device { headless: Box::new(headless), choice, warning: None, or_cpu: false };
    let image = render::render(&input, finished.layers_for(layers), &opened)?;
    let written = FilePicture::of(&image, &input.encoding, &outputs)?;
    let encoding = input.encoding;
    let outcome = FinishedCertificate::outcome_of_device;
    let find = |checker: &Checker<'_>, input: &mut Input, exact: &Image| witness(checker, input, exact, &opened);
    let rendered = certified::judge(&mut input, &encoding, &outputs, &written, outcome, &find)?;
    progress::stage("finishing");
    let mut denoiser = None;
    if finished.sampling.denoise {
        let mut without_lines = input.settings.clone();
        without_lines.sampling.denoise = true;
        let quiet = render::finish(image.clone(), &without_lines, GUIDES, &opened)?;
        denoiser = Some(denoised::certify(&image, &quiet).context("the denoiser cannot be checked")?);
    }
    let image = render::finish(image, &finished, layers, &opened)?;
    Ok(JudgedLight { stages, denoiser, rendered, shown: shown(&image, &input, wanted) })
}

/// Encodes the picture as the scene specifies, but with its background.
fn shown(image: &Image, Input { settings, encoding, .. }: &Input, wanted: u32) -> FinalPicture {
    let (color, alpha) = (image.color(), image.alpha());
    let srgb = (0..color.len()).map(|i| {
        to_srgb8(match alpha {
            Some(alpha) => encoding.display_over(color[i], alpha[i], settings.background),
            None => encoding.display(color[i]),
        })
    });
    FinalPicture { srgb: srgb.collect(), samples: settings.sampling.samples, wanted }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_sample_is_among_those_that_are_checked() {
        assert_eq!(chosen(64, 1, 7), [63]);
        assert_eq!(chosen(64, 2, 7), [0, 63]);
        assert_eq!(chosen(2, 5, 7), [0, 1, 2, 3, 4]);
        let some = chosen(1000, 20, 7);
        assert!(some.len() == 20 && some[0] == 0 && some[19] == 999, "{some:?}");
        assert!(some[1] > 1, "{some:?}");
        assert_ne!(some, chosen(1000, 20, 8));
        assert_eq!(chosen(9, 8, 3).len(), 8);
    }
}
