//! `pinhole job status`: says what is done and what is left.

use std::collections::BTreeMap;

use anyhow::Context;
use rayon::prelude::*;
use serde::Serialize;

use super::StatusArgs;
use super::depth::covered;
use super::folder::Folder;
use super::manifest::VERSION;
use super::marks::{Marks, failures};
use super::part_file::{self, Header, Problem};
use super::units::ranges;
use crate::failure::Failure;
use crate::speak::answer;
use crate::threads;

/// The JSON document. Lists of units are written as `sbatch --array` reads them.
#[derive(Serialize)]
struct Report {
    version: &'static str,
    units: usize,
    pictures: usize,
    done: usize,
    /// Units without a part, also those that are running or failed.
    missing: String,
    missing_count: usize,
    running: String,
    running_count: usize,
    failed: Vec<FailedReport>,
    damaged: String,
    foreign: String,
    /// What rendered the parts, and how many of them.
    devices: BTreeMap<String, usize>,
    /// Mean time of a part; before there is one, what the plan expects.
    seconds_of_unit: f64,
    /// The time left, with as many units at once as are running.
    seconds_left: f64,
    complete: bool,
}

#[derive(Serialize)]
struct FailedReport {
    unit: usize,
    why: String,
}

pub(super) fn run(args: &StatusArgs) -> Result<(), Failure> {
    let folder = Folder::open(&args.job)?;
    threads::start()?;
    let manifest = &folder.manifest;
    let found: Vec<Result<Header, Problem>> = if args.check {
        let units = (0..manifest.units).into_par_iter();
        units.map(|unit| part_file::check(&folder.part(unit), manifest, unit)).collect()
    } else {
        folder.glance()
    };
    let mut found = found;
    for (unit, header) in covered(&folder) {
        found[unit] = Ok(header);
    }
    let mut marks = Marks::read(&folder);
    // A unit may have been done by another try.
    marks.running.retain(|unit| found[*unit].is_err());
    marks.failed.retain(|(unit, _)| found[*unit].is_err());
    let report = Report::new(&folder, &found, &marks);
    let text = if args.json {
        serde_json::to_string_pretty(&report).context("the report cannot be written as JSON")?
            + "\n"
    } else {
        report.readable(&folder, &marks)
    };
    Ok(answer(text.as_bytes()).context("standard output: cannot be written")?)
}

impl Report {
    fn new(folder: &Folder, found: &[Result<Header, Problem>], marks: &Marks) -> Self {
        let of = |wanted: Option<Problem>| -> Vec<usize> {
            let is = |unit: &usize| match (&found[*unit], wanted) {
                (Err(problem), Some(wanted)) => *problem == wanted,
                (Err(_), None) => true,
                (Ok(_), _) => false,
            };
            (0..found.len()).filter(is).collect()
        };
        let headers = found.iter().flatten();
        let (mut devices, mut milliseconds) = (BTreeMap::new(), 0);
        for header in headers.clone() {
            *devices.entry(header.device.clone()).or_insert(0) += 1;
            milliseconds += header.milliseconds;
        }
        let done = headers.count();
        let seconds_of_unit = match done {
            0 => folder.manifest.expected_milliseconds as f64 / 1e3,
            _ => milliseconds as f64 / 1e3 / done as f64,
        };
        let missing = of(None);
        let at_once = marks.running.len().max(1) as f64;
        let failed = marks.failed.iter();
        Self {
            version: VERSION,
            units: found.len(),
            pictures: folder.manifest.pictures.as_ref().map_or(1, Vec::len),
            done,
            missing: ranges(&missing),
            missing_count: missing.len(),
            running: ranges(&marks.running),
            running_count: marks.running.len(),
            failed: failed
                .map(|(unit, why)| FailedReport { unit: *unit, why: why.clone() })
                .collect(),
            damaged: ranges(&of(Some(Problem::Damaged))),
            foreign: ranges(&of(Some(Problem::Foreign))),
            devices,
            seconds_of_unit,
            seconds_left: (missing.len() as f64 / at_once).ceil() * seconds_of_unit,
            complete: missing.is_empty(),
        }
    }

    fn readable(&self, folder: &Folder, marks: &Marks) -> String {
        let mut text = format!("done {} of {}\n", self.done, self.units);
        let lines = [
            ("missing", &self.missing),
            ("running", &self.running),
            ("damaged", &self.damaged),
            ("of another job", &self.foreign),
        ];
        for (word, units) in lines {
            if !units.is_empty() {
                text += &format!("{word} {units}\n");
            }
        }
        text += &failures(&marks.failed);
        for (device, count) in &self.devices {
            text += &format!("rendered by {device}: {count}\n");
        }
        text += &match self.complete {
            true => format!("{:.2} s each\n", self.seconds_of_unit),
            false => format!(
                "{:.2} s each, about {:.0} s left with {} at once; render what is missing with --array={}\n",
                self.seconds_of_unit,
                self.seconds_left,
                self.running_count.max(1),
                self.missing
            ),
        };
        if self.complete {
            text += &format!("complete: pinhole job merge {} -o OUT\n", folder.path().display());
        }
        text
    }
}
