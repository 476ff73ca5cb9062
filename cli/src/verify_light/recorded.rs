//! The samples of light that `pinhole verify` records on a device and checks.

use std::cell::RefCell;
use std::collections::BTreeSet;

use anyhow::{Context, anyhow};

use crate::device::explained_alone;
use crate::failure::Failure;
use crate::input::Input;
use crate::speak::tell;
use crate::views::Views;
use crate::with_scene::{upload, with_structures};
use crate::{interrupt, progress, render};
use pinhole::accel::AccelChoice;
use pinhole::gpu::{Decision, EachSample, Headless, LitPart, Watch};
use pinhole::image::LayerSet;
use pinhole::verify::run_file::LitSamples;
use pinhole::verify::{Checker, LitCertificate, LitRecording};

/// Records this number of samples on an adapter, one after the other, in the middle of the film and in a part at
/// random, and checks them. If they will be saved, `kept` keeps them.
pub(crate) fn certify(
    headless: &Headless,
    input: &Input,
    (count, tile_seed): (u32, Option<u32>),
    choice: AccelChoice,
    kept: Option<&mut LitSamples>,
) -> Result<LitCertificate, Failure> {
    let Input { scene, settings, .. } = input;
    let (view, views) = (input.view(), Views::of(input));
    let samples = chosen(settings.sampling.samples, count, settings.sampling.seed);
    let plan = |choice| render::plan(headless, input, &views, LayerSet::COLOR, choice);
    let tile_seed = tile_seed.unwrap_or_else(any_seed);
    let kept = RefCell::new(kept);
    let done = with_structures(headless, choice, plan, |plan| {
        let uploaded = interrupt::on_device(|| upload(headless, scene, plan))?;
        let buffers = match uploaded {
            Ok(buffers) => buffers,
            Err(error) => return Ok(Err(error)),
        };
        let checker = Checker::new(scene).context("the checker cannot be prepared")?;
        let mut certificate = LitCertificate::default();
        // With another structure, recording begins anew.
        kept.borrow_mut().iter_mut().for_each(|kept| kept.clear());
        let failed = RefCell::new(None);
        let recording = "recording light";
        progress::stage(recording);
        let recorded = interrupt::on_device(|| {
            let each = &mut |recorded: LitRecording<'_>| {
                interrupt::driver_rests(true);
                progress::stage("checking light");
                certificate.join(checker.certify_lit(recorded));
                let added = kept.borrow_mut().as_mut().map(|kept| kept.add(recorded));
                if let Some(Err(error)) = added {
                    *failed.borrow_mut() = Some(error);
                }
                progress::stage(recording);
                interrupt::driver_rests(false);
            };
            let watch = &mut |_: &_| match *failed.borrow() {
                None => interrupt::decide(),
                Some(_) => Decision::Stop,
            };
            [LitPart::Middle, LitPart::Random(tile_seed)].into_iter().try_for_each(|part| {
                let samples = (part, &samples[..]);
                let callbacks = (&mut *each as &mut EachSample<'_>, &mut *watch as &mut Watch<'_>);
                headless.record_lit_part(&buffers, &view, settings, samples, callbacks)
            })
        })?;
        if let Some(error) = failed.take() {
            return Err(anyhow!("the samples of the light cannot be kept: {error}").into());
        }
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

/// Another number in each run.
fn any_seed() -> u32 {
    use std::hash::{BuildHasher, RandomState};
    RandomState::new().hash_one(0) as u32
}

/// The indices of the samples that are checked: `count` of those of a picture, among them the last and, if there are
/// several, the first; the others are chosen at random. More than the picture has are the first ones.
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
        // A linear congruential generator, of which the upper bits are used (Numerical Recipes, section 7.1).
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        chosen.insert(((u64::from(random) * u64::from(all)) >> 32) as u32);
    }
    chosen.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::chosen;

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
