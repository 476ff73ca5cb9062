//! The report of `pinhole bench`, as JSON and as text.

use std::time::Duration;

use serde::Serialize;

use crate::render::device::{AdapterReport, DEVICE_CLOCK};
use crate::terminal::memory::readable;
use crate::terminal::text::table;
use pinhole::camera::Camera;
use pinhole::camera::film::Film;
use pinhole::scene::Scene;

/// A scene that was generated or read.
pub(crate) struct BenchScene {
    pub(crate) name: String,
    pub(crate) scene: Scene,
    pub(crate) camera: Box<dyn Camera>,
    pub(crate) film: Film,
    pub(crate) load: Duration,
}

#[derive(Serialize)]
pub(crate) struct BenchReport {
    pub(crate) version: &'static str,
    pub(crate) adapter: AdapterReport,
    pub(crate) reps: u32,
    pub(crate) scenes: Vec<SceneReport>,
}

/// A scene with the measurements of every structure.
#[derive(Serialize)]
pub(crate) struct SceneReport {
    name: String,
    spheres: usize,
    cones: usize,
    width: u32,
    height: u32,
    load_seconds: f64,
    runs: Vec<RunReport>,
    /// A comparison of the structures, if there are several.
    note: Option<String>,
}

#[derive(Serialize)]
pub(crate) struct RunReport {
    pub(crate) choice: String,
    pub(crate) structure: &'static str,
    pub(crate) reason: String,
    /// Time to build the structure, including planning.
    pub(crate) build_seconds: f64,
    pub(crate) upload_seconds: f64,
    /// Time of the first picture, including the building of pipelines and the copy back to the host.
    pub(crate) first_render_seconds: f64,
    pub(crate) trace_wall: Option<Spread>,
    /// Tracing time by the device's clock, if its clock measures work.
    pub(crate) trace_device: Option<Spread>,
    /// The clock on which rates and the comparison are based: `device` or `host`.
    pub(crate) clock: &'static str,
    pub(crate) rays: u64,
    /// Rays per second, from the median time by this clock.
    pub(crate) rays_per_second: Option<f64>,
    pub(crate) submissions: u32,
    /// Not known for tiles.
    pub(crate) longest_submission_seconds: Option<f64>,
    /// Bytes of device memory for the scene and the frame.
    pub(crate) device_bytes: u64,
    pub(crate) device_bytes_per_sphere: Option<f64>,
    pub(crate) peak_memory_bytes: Option<u64>,
}

/// Times of repeated measurements.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Spread {
    pub(crate) median_seconds: f64,
    pub(crate) best_seconds: f64,
}

impl Spread {
    /// Summarizes times. Returns `None` if there are none, or if one of them is not known.
    pub(crate) fn of(times: impl Iterator<Item = Option<Duration>>) -> Option<Self> {
        let mut times: Vec<Duration> = times.collect::<Option<_>>()?;
        times.sort_unstable();
        let median = times.get(times.len() / 2)?;
        Some(Self { median_seconds: median.as_secs_f64(), best_seconds: times.first()?.as_secs_f64() })
    }
}

impl BenchReport {
    pub(crate) fn heading(&self) -> String {
        let Self { version, adapter, reps, .. } = self;
        let clock = adapter.clock();
        let why = if clock == DEVICE_CLOCK {
            ""
        } else {
            "; no device times, because the clock of a software device measures when work was queued, not when it ran"
        };
        format!("pinhole {version}\n{}\nreps: {reps}; rates by the clock of the {clock}{why}\n", adapter.line(),)
    }
}

impl SceneReport {
    pub(crate) fn new(scene: &BenchScene, runs: Vec<RunReport>) -> Self {
        let BenchScene { name, scene, film, load, .. } = scene;
        Self {
            name: name.clone(),
            spheres: scene.len(),
            cones: scene.cones().len(),
            width: film.width(),
            height: film.height(),
            load_seconds: load.as_secs_f64(),
            note: compared(&runs),
            runs,
        }
    }

    pub(crate) fn readable(&self) -> String {
        let Self { name, spheres, cones, width, height, load_seconds, .. } = self;
        let of_cones = if *cones > 0 { format!("{cones} cones and cylinders, ") } else { String::new() };
        let mut text =
            format!("\n{name}: {spheres} spheres, {of_cones}{width}x{height}, loaded in {load_seconds:.2} s\n");
        let rows: Vec<_> = self.runs.iter().map(RunReport::row).collect();
        text += &table(
            [
                "structure",
                "build s",
                "upload s",
                "first s",
                "wall ms",
                "best",
                "device ms",
                "best",
                "Mrays/s",
                "B/shape",
                "peak",
                "submissions",
                "longest ms",
            ],
            &rows,
        );
        if let Some(note) = &self.note {
            text += &format!("  {note}\n");
        }
        text
    }
}

impl RunReport {
    fn row(&self) -> [String; 13] {
        let dash = || "-".to_owned();
        let milliseconds = |seconds: f64| format!("{:.1}", seconds * 1e3);
        let spread = |spread: Option<Spread>| {
            spread.map_or([dash(), dash()], |spread| [spread.median_seconds, spread.best_seconds].map(milliseconds))
        };
        let rate = |rate: Option<f64>| rate.map_or_else(dash, |rate| format!("{:.2}", rate / 1e6));
        let [wall, wall_best] = spread(self.trace_wall);
        let [device, device_best] = spread(self.trace_device);
        [
            format!("{}: {}", self.choice, self.structure),
            format!("{:.2}", self.build_seconds),
            format!("{:.2}", self.upload_seconds),
            format!("{:.2}", self.first_render_seconds),
            wall,
            wall_best,
            device,
            device_best,
            rate(self.rays_per_second),
            self.device_bytes_per_sphere.map_or_else(dash, |bytes| format!("{bytes:.1}")),
            self.peak_memory_bytes.map_or_else(dash, readable),
            self.submissions.to_string(),
            self.longest_submission_seconds.map_or_else(dash, milliseconds),
        ]
    }
}

/// Compares the first run with the fastest of the others.
fn compared(runs: &[RunReport]) -> Option<String> {
    let (first, others) = runs.split_first()?;
    let timed = others.iter().filter_map(|run| Some((run, run.rays_per_second?)));
    let (other, theirs) = timed.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let own = first.rays_per_second?;
    let (name, other) = (first.structure, other.structure);
    let chose = format!("{} chose {name}; {other} is", first.choice);
    let percent = |fast: f64, slow: f64| (fast / slow - 1.0) * 100.0;
    // "30 % faster" means 30 % more rays per second, and "30 % slower" means 30 % more time per ray.
    Some(if theirs > own {
        format!("{chose} {:.0} % faster", percent(theirs, own))
    } else {
        format!("{chose} {:.0} % slower", percent(own, theirs))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_needs_all_times() {
        let seconds = |s: u64| Some(Duration::from_secs(s));
        let spread = Spread::of([seconds(5), seconds(1), seconds(3)].into_iter());
        assert_eq!(spread, Some(Spread { median_seconds: 3.0, best_seconds: 1.0 }));
        assert_eq!(Spread::of([seconds(5), None].into_iter()), None);
        assert_eq!(Spread::of([].into_iter()), None);
    }
}
