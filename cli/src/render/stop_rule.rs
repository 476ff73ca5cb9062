//! The rule that stops rendering: after a time, at a level of noise, or at a signal.

use std::cell::Cell;
use std::time::{Duration, Instant};

use clap::Args;

use crate::flags::settings::LOOK_HEADING;
use crate::terminal::failure::Failure;
use crate::terminal::interrupt;
use crate::terminal::progress::{self, tell};
use pinhole::render::{Decision, Progress};

#[derive(Debug, Args)]
pub(crate) struct StopArgs {
    /// Take samples for this time in seconds, or such as 20s, 1.5m or 2h, but at most --samples
    #[arg(long, help_heading = LOOK_HEADING, value_name = "TIME")]
    time: Option<String>,
    /// Take samples until the noise is at most this fraction of the light, such as 0.01, but at most --samples
    #[arg(long, help_heading = LOOK_HEADING, value_name = "PART", allow_hyphen_values = true)]
    noise: Option<f64>,
    /// On Ctrl-C, write the lit picture from the samples taken so far. With --time, also wait until every pixel has a
    /// sample. A second Ctrl-C ends without a picture
    #[arg(long)]
    pub(crate) keep_partial: bool,
}

impl StopArgs {
    /// Returns a flag of the rule that was given, if there is one.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let open_end = open_end(self.time.as_ref(), self.noise);
        open_end.or(self.keep_partial.then_some("--keep-partial"))
    }
}

/// The flag that leaves the number of samples open, if there is one.
fn open_end<T>(time: Option<T>, noise: Option<f64>) -> Option<&'static str> {
    time.map(|_| "--time").or(noise.map(|_| "--noise"))
}

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StopRule {
    time: Option<Duration>,
    noise: Option<f64>,
    keep_partial: bool,
}

/// Samples that a picture needs before its noise counts. With fewer samples, the estimate may be low by chance.
const LEAST_SAMPLES: u32 = 16;

impl StopRule {
    pub(crate) fn new(args: &StopArgs) -> Result<Self, Failure> {
        let &StopArgs { noise, keep_partial, ref time } = args;
        if let Some(noise) = noise
            && !(noise.is_finite() && noise > 0.0)
        {
            return Err(Failure::usage(format!("--noise {noise}: it must be finite and greater than 0, such as 0.01")));
        }
        let time = time.as_deref().map(parse_time).transpose()?;
        Ok(Self { time, noise, keep_partial })
    }

    /// Returns the flag that leaves the number of samples open, if there is one.
    pub(crate) fn open_end(&self) -> Option<&'static str> {
        open_end(self.time, self.noise)
    }

    /// Whether the picture is written after a signal.
    pub(crate) fn keeps_partial(&self) -> bool {
        self.keep_partial
    }

    /// Refuses flags that do not apply to a picture without light.
    pub(crate) fn check_without_light(&self) -> Result<(), Failure> {
        if self.keep_partial {
            return Err(Failure::usage(
                "--keep-partial applies only to lit pictures, but this one has one sample per pixel; remove it, \
                 or ask for light, for example with --integrator studio",
            ));
        }
        Ok(())
    }
}

/// Parses a time in seconds, minutes or hours.
fn parse_time(text: &str) -> Result<Duration, Failure> {
    let wrong =
        || Failure::usage(format!("--time {text}: write a time greater than 0 in seconds, or such as 20s, 1.5m or 2h"));
    let number = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = match &text[number.len()..] {
        "" | "s" => 1.0,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        _ => return Err(wrong()),
    };
    let seconds = number.parse::<f64>().map_err(|_| wrong())? * unit;
    let time = Duration::try_from_secs_f64(seconds).map_err(|_| wrong())?;
    if time.is_zero() { Err(wrong()) } else { Ok(time) }
}

/// Applies the rule to one of several pictures while it is rendered.
pub(crate) struct Watching {
    stop_rule: StopRule,
    time: Option<Duration>,
    /// Whether noise is measured, which needs a lit picture.
    measures_noise: bool,
    is_lit: bool,
    pixels: u64,
    started: Instant,
    /// Whether a line already said that the program waits for the first sample.
    has_said: Cell<bool>,
    /// The approximate share of pixels that had a sample when the time was up, if it was less than 1.
    too_short: Cell<Option<f64>>,
}

impl Watching {
    /// Starts the clock for one picture. All `pictures` share the time equally.
    pub(crate) fn new(stop_rule: StopRule, pictures: usize, pixels: u64, is_lit: bool) -> Self {
        let time = stop_rule.time.map(|time| time / u32::try_from(pictures).unwrap_or(1));
        let measures_noise = is_lit && (stop_rule.noise.is_some() || progress::is_seen());
        Self {
            stop_rule,
            time,
            measures_noise,
            is_lit,
            pixels,
            started: Instant::now(),
            has_said: Cell::new(false),
            too_short: Cell::new(None),
        }
    }

    /// Shows the progress, and decides whether rendering continues.
    pub(crate) fn decide(&self, progress: &Progress) -> Decision {
        let elapsed = self.started.elapsed();
        self.show(progress, elapsed);
        let has_any = progress.samples > 0;
        let is_late = self.time.is_some_and(|time| elapsed >= time);
        let is_interrupted = interrupt::is_requested();
        if is_interrupted && !self.stop_rule.keep_partial {
            return Decision::Stop;
        }
        if is_interrupted && has_any {
            return Decision::Finish;
        }
        if (is_interrupted || is_late) && !has_any {
            if !self.stop_rule.keep_partial {
                // This is the fraction of one sample for every pixel.
                self.too_short.set(Some(progress.part * f64::from(progress.total)));
                return Decision::Stop;
            }
            self.say_first_sample(is_interrupted);
            return Decision::GoOn;
        }
        let is_smooth = progress.samples >= LEAST_SAMPLES
            && self.stop_rule.noise.zip(progress.noise).is_some_and(|(most, noise)| noise <= most);
        if has_any && (is_late || is_smooth) {
            Decision::Finish
        } else if self.measures_noise {
            Decision::MeasureNoise
        } else {
            Decision::GoOn
        }
    }

    /// Returns the failure if the time was too short for one sample of every pixel.
    pub(crate) fn too_short(&self) -> Option<Failure> {
        let (part, time) = (self.too_short.get()?, self.time?.as_secs_f64());
        Some(Failure::Job(anyhow::anyhow!(
            "--time: after {time:.3} s only {:.0} % of the pixels have a sample, but a picture needs one for each; \
             nothing was written; give more time or a smaller --size, or wait for it with --keep-partial",
            (100.0 * part).clamp(0.0, 99.0)
        )))
    }

    /// Prints once that the program waits until every pixel has a sample, because a picture needs one.
    fn say_first_sample(&self, is_interrupted: bool) {
        if self.has_said.replace(true) {
            return;
        }
        if is_interrupted {
            tell("note: stopping when every pixel has its first sample; press Ctrl-C again to end without a picture");
        } else {
            tell(
                "note: the time is up; the picture will be written when every pixel has its first sample; \
                 press Ctrl-C twice to end without a picture",
            );
        }
    }

    fn show(&self, progress: &Progress, elapsed: Duration) {
        if !self.is_lit {
            return progress::tracing(progress.part);
        }
        let seconds = elapsed.as_secs_f64();
        let by_time = self.time.map_or(0.0, |time| seconds / time.as_secs_f64());
        // Noise is inversely proportional to the square root of the number of samples.
        let by_noise = self
            .stop_rule
            .noise
            .zip(progress.noise)
            .map_or(0.0, |(most, noise)| (most / noise.max(f64::MIN_POSITIVE)).powi(2));
        let part = progress.part.max(by_time).max(by_noise).clamp(0.0, 1.0);
        let taken = progress.part * f64::from(progress.total) * self.pixels as f64;
        let noise = progress.noise.map_or(String::new(), |noise| format!(", noise {:.2}%", 100.0 * noise));
        let of_total =
            if self.stop_rule.open_end().is_some() { String::new() } else { format!(" of {}", progress.total) };
        let message = format!(
            "{}{of_total} samples{noise}, {:.1} million per second",
            progress.samples,
            taken / seconds.max(1e-3) / 1e6
        );
        progress::rendering(part, message);
    }

    /// Returns a line about a picture that stopped early or has more noise than wanted.
    pub(crate) fn verdict(&self, samples: u32, total: u32, noise: Option<f64>, is_stopped: bool) -> Option<String> {
        if is_stopped && samples < total {
            return Some(format!("stopped; the picture has {samples} samples per pixel"));
        }
        let wanted = self.stop_rule.noise?;
        let left = noise.filter(|noise| *noise > wanted)?;
        Some(format!(
            "note: the noise is {left:.3} after {samples} samples, more than --noise {wanted}; allow more --samples or \
             --time"
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times() {
        let time = |text| parse_time(text).map_err(|failure| failure.message());
        for (text, seconds) in [("20", 20.0), ("20s", 20.0), ("1.5m", 90.0), ("2min", 120.0), ("0.5h", 1800.0)] {
            assert_eq!(time(text), Ok(Duration::from_secs_f64(seconds)), "{text}");
        }
        for text in ["", "s", "0s", "-1s", "1d", "infs", "NaNs", "1e300h", "20 s", "1m30s"] {
            let wrong = format!("--time {text}: write a time greater than 0 in seconds, or such as 20s, 1.5m or 2h");
            assert_eq!(time(text), Err(wrong), "{text}");
        }
    }
}
