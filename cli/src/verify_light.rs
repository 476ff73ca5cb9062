//! `pinhole verify` of a scene with light: checks some samples of every pixel, stage by stage.

use std::collections::BTreeMap;

use serde::Serialize;

use super::verify_report::LISTED;
use pinhole::verify::{LitCertificate, LitOpen, LitShare, LitViolation, StageCounts};

/// The largest number of open searches in the table.
const LINES: usize = 3;

/// The object `paths` or `studio` of the JSON document.
#[derive(Serialize)]
pub(super) struct LightReport {
    /// Number of paths, or of samples of a studio.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) paths: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) samples: Option<u64>,
    pub(super) stages: BTreeMap<&'static str, Counts>,
    /// First column and row, width and height of the parts of the film in which samples were checked.
    pub(super) rectangles: Vec<[u32; 4]>,
    pub(super) judged: Judged,
    pub(super) upload: Option<String>,
    pub(super) violation_count: u64,
    pub(super) violations: Vec<Listed>,
    pub(super) outcome: &'static str,
    pub(super) legal: bool,
    /// The certificate as one line of text.
    #[serde(skip)]
    pub(super) line: String,
    /// The first stages with several legal results, and those of which the check says little.
    pub(super) open: Vec<ListedOpen>,
}

impl LightReport {
    /// Lines of text about the counts, and about the first open searches.
    pub(super) fn lines(&self) -> String {
        let open = self.open.iter().filter(|open| !open.legal.is_empty());
        let lines = open.take(LINES).map(|open| format!("open: {}\n", open.line));
        std::iter::once(format!("{}\n", self.line)).chain(lines).collect()
    }

    /// Whether nothing is known to be wrong.
    pub(super) fn is_without_fault(&self) -> bool {
        self.violation_count == 0 && self.upload.is_none()
    }
}

/// How much of the picture was judged.
#[derive(Serialize)]
pub(super) struct Judged {
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
    pub(super) fn words(&self) -> String {
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
pub(super) struct ListedOpen {
    pub(super) pixel: [u32; 2],
    pub(super) sample: u32,
    pub(super) surface: u32,
    pub(super) stage: &'static str,
    pub(super) is_undecided: bool,
    /// Of an open search, up to four legal answers.
    pub(super) legal: Vec<String>,
    /// The same as one line of text.
    #[serde(skip)]
    pub(super) line: String,
}

impl From<&LitOpen> for ListedOpen {
    fn from(open: &LitOpen) -> Self {
        let LitOpen { pixel, sample, surface, stage, is_undecided, ref legal, .. } = *open;
        let (stage, legal, line) = (stage.name(), legal.clone(), open.to_string());
        Self { pixel, sample, surface, stage, is_undecided, legal, line }
    }
}

#[derive(Serialize)]
pub(super) struct Counts {
    pub(super) checked: u64,
    pub(super) decided: u64,
    pub(super) open: u64,
    pub(super) undecided: u64,
}

#[derive(Serialize)]
pub(super) struct Listed {
    pub(super) pixel: [u32; 2],
    pub(super) sample: u32,
    pub(super) surface: u32,
    pub(super) stage: &'static str,
    pub(super) message: String,
}

impl From<StageCounts> for Counts {
    fn from(StageCounts { checked, decided, open, undecided, .. }: StageCounts) -> Self {
        Self { checked, decided, open, undecided }
    }
}

impl From<&LitViolation> for Listed {
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
            violations: certificate.violations.iter().take(LISTED).map(Listed::from).collect(),
            outcome: certificate.outcome().name(),
            legal: certificate.is_legal(),
            line: certificate.to_string(),
        }
    }
}

#[cfg(feature = "gpu")]
pub(super) use recorded::certify;

#[cfg(feature = "gpu")]
mod recorded {
    use std::cell::RefCell;
    use std::collections::BTreeSet;

    use anyhow::{Context, anyhow};

    use super::*;
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
    use pinhole::verify::{Checker, LitRecording};

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
                    let callbacks =
                        (&mut *each as &mut EachSample<'_>, &mut *watch as &mut Watch<'_>);
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
}
