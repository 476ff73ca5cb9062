//! Judges finished pictures as they are in files, pixel by pixel, against the picture that exact arithmetic gives.
//!
//! The random numbers of a picture follow from its seed. So the f64 reference takes the very samples of the device, and
//! the same code finishes both: it removes noise, draws lines and annotations, and encodes. What rounding changes within
//! a pixel is mostly less than a step of the file, so that almost every pixel of a correct device *equals* the exact
//! one. Where a ray passes an edge, rounding may decide otherwise, and a pixel differs. Such a pixel is judged by an
//! interval: in pictures with one ray through each pixel, by [`written`](super::written), and in others by following all
//! samples forward, with every branch that rounding may take, and through the removal of noise, the lines, the encoding
//! and what is drawn over the picture (`lit/forward.rs`, `lit/legal_picture.rs`). If that says nothing about a pixel that
//! differs, it stays open, and the picture undecided.

use super::certificate::{CHUNK, KEPT, Outcome, channel_name};
use super::written::{Samples, WrittenError, WrittenPicture, WrittenViolation};
use crate::camera::View;
use crate::parallel::{map_parts, ranges};
use crate::recording::pixel_at;
use crate::render::RenderSettings;
use crate::smooth::SmoothPicture;
use crate::verify::lit::check::LitCheck;
use crate::verify::lit::forward;
use crate::verify::{Checker, Interval, Verdict};

/// The least share of exact pixels in a picture that is proved.
pub const LEAST_EXACT: f64 = 0.99;

/// The largest share of wide pixels in a picture that is proved.
pub const MOST_WIDE: f64 = 0.001;

/// The number of pixels that may be followed with intervals in any picture.
const MOST_FOLLOWED: usize = 2000;

/// The verdict about a pixel of a finished picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PixelVerdict {
    /// It is what exact arithmetic gives, to the resolution of the file.
    Exact,
    /// It is another value to which rounding may lead.
    Legal,
    /// Rounding may lead there, but also to many other values.
    Wide,
    /// It differs, and nothing says whether rounding may lead there, or too many pixels differ to say it of all.
    Open,
    /// Rounding cannot lead there.
    Violated,
}

impl PixelVerdict {
    /// All verdicts, in the order of reports.
    pub const ALL: &'static [Self] = &[Self::Exact, Self::Legal, Self::Wide, Self::Open, Self::Violated];

    /// The name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Legal => "legal",
            Self::Wide => "wide",
            Self::Open => "open",
            Self::Violated => "violated",
        }
    }
}

/// A pixel that differs from the exact one, and need not be legal.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PixelDifference {
    /// Column and row, from the top left.
    pub pixel: [u32; 2],
    /// The first channel that differs, from 0 for red to 3 for alpha.
    pub channel: usize,
    /// The sample.
    pub found: f64,
    /// The exact sample.
    pub exact: f64,
}

impl std::fmt::Display for PixelDifference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { pixel: [i, j], channel, found, exact } = self;
        write!(f, "pixel ({i}, {j}): {} is {found}, and the exact one {exact}", channel_name(*channel))
    }
}

/// The verdicts about all pixels of a picture in a file.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FinishedCertificate {
    /// The verdict about every pixel, row by row from the top.
    pub verdicts: Vec<PixelVerdict>,
    /// The first violations, in the order of pixels.
    pub violations: Vec<WrittenViolation>,
    /// The first pixels that are wide or open, in the order of pixels.
    pub open: Vec<PixelDifference>,
}

impl FinishedCertificate {
    /// The number of pixels with a verdict.
    #[must_use]
    pub fn count(&self, verdict: PixelVerdict) -> usize {
        self.verdicts.iter().filter(|other| **other == verdict).count()
    }

    /// The outcome: proved if at least [`LEAST_EXACT`] of all pixels are exact, at most [`MOST_WIDE`] are wide, and all
    /// others are legal.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let all = self.verdicts.len() as f64;
        let share = |verdict| self.count(verdict) as f64 / all;
        if self.count(PixelVerdict::Violated) > 0 {
            return Outcome::Violated;
        }
        let is_known = self.count(PixelVerdict::Open) == 0 && share(PixelVerdict::Wide) <= MOST_WIDE;
        // This is also false for a picture without pixels.
        let is_exact = share(PixelVerdict::Exact) >= LEAST_EXACT;
        if is_known && is_exact { Outcome::Proved } else { Outcome::Undecided }
    }

    /// The outcome for a device that rendered the picture just now, so that nobody chose which pixels are open: as for
    /// other checks of devices, at most [`MOST_UNDECIDED`](super::MOST_UNDECIDED) of all pixels may be wide or open.
    #[must_use]
    pub fn outcome_of_device(&self) -> Outcome {
        let undecided = self.count(PixelVerdict::Wide) + self.count(PixelVerdict::Open);
        Outcome::of(self.count(PixelVerdict::Violated) > 0, undecided as u64, self.verdicts.len() as u64)
    }
}

/// Draws over the samples of a whole picture, which are as in [`Samples::Encoded`].
pub type Annotate<'a> = dyn Fn(&mut [u8]) + 'a;

/// A finished picture to judge.
#[derive(Clone, Copy)]
pub struct FinishedRequest<'a> {
    /// The view, or those of a left and a right eye, whose pictures are side by side.
    pub views: &'a [View<'a>],
    /// The settings.
    pub settings: &'a RenderSettings,
    /// The picture.
    pub picture: &'a WrittenPicture<'a>,
    /// The picture of the CPU reference with the same settings, finished and encoded by the same code, but for what is
    /// drawn over it.
    pub exact: &'a WrittenPicture<'a>,
    /// A function that draws over encoded samples, such as labels. They may decide what it draws.
    pub annotate: Option<&'a Annotate<'a>>,
}

/// The least and the greatest samples of a pixel, if something is known.
type Range = Option<[[f64; 2]; 4]>;

impl FinishedRequest<'_> {
    /// The samples of the exact picture after a change, and with what is drawn over it.
    fn annotated_by(&self, change: impl Fn(&mut [u8])) -> Option<Vec<u8>> {
        let (annotate, Samples::Encoded(exact)) = (self.annotate?, self.exact.samples) else { return None };
        let mut samples = exact.to_vec();
        change(&mut samples);
        annotate(&mut samples);
        Some(samples)
    }

    /// Draws over pixels with these indices and ranges.
    fn drawn(&self, indices: &[usize], ranges: Vec<Range>, exact: &[u8]) -> Vec<Range> {
        // What is drawn changes with each sample in one direction. It may depend on alpha in either.
        let corners = [[0, 0], [0, 1], [1, 0], [1, 1]].map(|[of_color, of_alpha]| {
            let with_range = |samples: &mut [u8]| {
                for (index, range) in indices.iter().zip(&ranges) {
                    let [r, g, b, alpha] = range.unwrap_or([[0.0, f64::from(self.exact.encoding.bits.white())]; 4]);
                    let sample = [r[of_color], g[of_color], b[of_color], alpha[of_alpha]];
                    self.exact.put(samples, *index, sample);
                }
            };
            self.annotated_by(with_range)
        });
        let corners: Vec<Vec<u8>> = corners.into_iter().flatten().collect();
        let drawn = |(index, range): (&usize, Range)| {
            range?;
            let at = |samples: &[u8]| {
                WrittenPicture { samples: Samples::Encoded(samples), ..*self.exact }
                    .at(*index)
                    .map(|sample| [sample; 2])
            };
            let join =
                |a: [[f64; 2]; 4], b: [[f64; 2]; 4]| [0, 1, 2, 3].map(|c| [a[c][0].min(b[c][0]), a[c][1].max(b[c][1])]);
            corners.iter().map(Vec::as_slice).chain([exact]).map(at).reduce(join)
        };
        indices.iter().zip(ranges).map(drawn).collect()
    }
}

impl Checker<'_> {
    /// The light that a conforming device may have for some pixels of a finished picture, given by their indices row by
    /// row from the top: red, green, blue and alpha. `None` if hardly anything is known.
    #[must_use]
    pub fn legal_light(
        &self,
        view: &View<'_>,
        settings: &RenderSettings,
        indices: &[usize],
    ) -> Vec<Option<[Interval; 4]>> {
        if indices.is_empty() {
            return Vec::new();
        }
        if let Some(primary) = settings.primary() {
            return self.legal_colors(view, &primary, indices);
        }
        match forward::inputs(self, view, settings) {
            Some(inputs) => {
                let mut check = LitCheck::new(self, &inputs);
                check.brightest = check.most_light_of_paths();
                check.finished_light(indices, SmoothPicture::of(self.scene, view, settings).as_ref())
            }
            None => vec![None; indices.len()],
        }
    }

    /// Judges every pixel of a finished picture.
    ///
    /// # Errors
    /// Returns an error if a picture is not as large as the views together, or has another number of samples.
    pub fn certify_finished(&self, request: FinishedRequest<'_>) -> Result<FinishedCertificate, WrittenError> {
        let FinishedRequest { views, settings, picture, exact, .. } = request;
        let Some(View { film, .. }) = views.first() else { return Ok(FinishedCertificate::default()) };
        let [width, height] = [film.width(), film.height()];
        let size = [width * views.len() as u32, height];
        for View { film, .. } in views {
            picture.check([film.width() * views.len() as u32, film.height()])?;
        }
        exact.check(size)?;
        let annotated = request.annotated_by(|_| {});
        let by_intervals = settings.primary().filter(|_| views.len() == 1 && annotated.is_none());
        let legal = by_intervals.map(|primary| self.certify_written(&views[0], &primary, picture)).transpose()?;
        let exact = match &annotated {
            Some(samples) => WrittenPicture { samples: Samples::Encoded(samples), ..*exact },
            None => *exact,
        };
        let count = size[0] as usize * height as usize;
        let differs = |index: usize| picture.difference(&exact, index).is_some();
        let parts = map_parts(ranges(count, CHUNK), |range| range.filter(|index| differs(*index)).collect::<Vec<_>>());
        let different = parts.concat();
        // If too many pixels differ for a proof, a part of them is followed, which finds what is wrong.
        let most = MOST_FOLLOWED.max(((1.0 - LEAST_EXACT) * count as f64) as usize);
        let is_followed = |at: usize| match (different.len() > most, settings.sampling.denoise) {
            (false, _) => true,
            // What is followed for a pixel serves those beside it.
            (true, true) => at.abs_diff(different.len() / 2) < most / 2,
            (true, false) => at.is_multiple_of(different.len().div_ceil(most)),
        };
        let mut ranges = vec![None; different.len()];
        if legal.is_none() {
            for (eye, view) in views.iter().enumerate() {
                // The pixels of this eye: their places in the list, and their indices in its picture.
                let [first, width] = [eye * width as usize, width as usize];
                let of_eye = different.iter().enumerate().filter_map(|(at, index)| {
                    let [i, j] = [index % size[0] as usize, index / size[0] as usize];
                    ((first..first + width).contains(&i) && is_followed(at)).then(|| (at, j * width + i - first))
                });
                let (places, indices): (Vec<usize>, Vec<usize>) = of_eye.unzip();
                for (at, light) in places.into_iter().zip(self.legal_light(view, settings, &indices)) {
                    ranges[at] = light.and_then(|light| exact.of_light(light));
                }
            }
        }
        if let Some(samples) = &annotated {
            ranges = request.drawn(&different, ranges, samples);
        }
        let mut all =
            FinishedCertificate { verdicts: vec![PixelVerdict::Exact; count], ..FinishedCertificate::default() };
        for (index, range) in different.into_iter().zip(ranges) {
            let pixel = pixel_at(index, size[0]);
            let judged = range.map(|range| picture.judge_range(index, range));
            all.verdicts[index] = match (&legal, judged) {
                (Some(_), _) | (None, Some(Ok(true))) => PixelVerdict::Legal,
                (None, Some(Ok(false))) => PixelVerdict::Wide,
                (None, None) => PixelVerdict::Open,
                (None, Some(Err((channel, legal)))) => {
                    let found = picture.at(index)[channel];
                    all.violations.push(WrittenViolation { pixel, channel, found, legal });
                    PixelVerdict::Violated
                }
            };
            if let (PixelVerdict::Open | PixelVerdict::Wide, Some((channel, [found, exact]))) =
                (all.verdicts[index], picture.difference(&exact, index))
            {
                all.open.push(PixelDifference { pixel, channel, found, exact });
            }
        }
        if let Some(legal) = legal {
            let illegal =
                legal.verdicts.iter().zip(&mut all.verdicts).filter(|(found, _)| **found == Verdict::Violation);
            illegal.for_each(|(_, verdict)| *verdict = PixelVerdict::Violated);
            all.violations = legal.violations;
        }
        all.open.truncate(KEPT);
        all.violations.truncate(KEPT);
        Ok(all)
    }
}
