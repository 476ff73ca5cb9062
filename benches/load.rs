//! Measures readers of text against a parser of a few lines for the same text, which knows its layout and checks nothing.
//!
//! ```sh
//! cargo bench --bench load
//! cargo bench --bench load -- files 4hhb.pdb trajectory.xyz    # times and peak memory of own files
//! ```
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark may panic, and prints")]

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::Instant;

use pinhole::load::{self, Loaded, Options};

/// How often each is measured, by turns.
const TURNS: usize = 9;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    if let [files, paths @ ..] = arguments.as_slice()
        && files == "files"
    {
        return paths.iter().for_each(|path| file(path));
    }
    let atoms = 300_000;
    compare("xyz", &xyz(atoms), |text| few_lines(text, 2, [1, 2, 3]));
    compare("lammps-dump", &dump(atoms), |text| few_lines(text, 9, [2, 3, 4]));
}

/// Prints the median times of the reader and of the few lines, and their ratio.
fn compare(format: &str, text: &str, few_lines: impl Fn(&str) -> Atoms) {
    let options = Options::default().with_format(load::Format::of_name(format).unwrap());
    let read = || load::from_bytes(text.as_bytes(), "", &options).unwrap();
    let centers = |loaded: &Loaded| {
        loaded.spheres.with_color(pinhole::LinearRgb::WHITE).map(|s| s.center).collect::<Vec<_>>()
    };
    assert_eq!(centers(&read()), few_lines(text).centers);
    let (mut reader, mut yardstick) = (Vec::new(), Vec::new());
    for _ in 0..TURNS {
        reader.push(seconds(|| drop(black_box(read()))));
        yardstick.push(seconds(|| drop(black_box(few_lines(text)))));
    }
    let (reader, yardstick) = (median(reader), median(yardstick));
    println!(
        "{format:12} {:6.1} MB: {:7.1} ms, few lines {:7.1} ms, ratio {:.2}",
        text.len() as f64 / 1e6,
        reader * 1e3,
        yardstick * 1e3,
        reader / yardstick
    );
}

fn seconds(what: impl FnOnce()) -> f64 {
    let start = Instant::now();
    what();
    start.elapsed().as_secs_f64()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_unstable_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Prints how long the last frame of a file takes, which is found by passing over the others, and the peak memory of this
/// process.
fn file(path: &str) {
    let frames = load::Trajectory::open(path, &Options::default()).map_or(1, |found| found.len());
    let mut options = Options::default();
    options.frame = (frames > 1).then_some(frames - 1);
    let mut loaded = None;
    let times = (0..TURNS)
        .map(|_| {
            loaded = None;
            seconds(|| loaded = Some(load::open(path, &options).unwrap()))
        })
        .collect();
    let loaded = loaded.unwrap();
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find(|line| line.starts_with("VmHWM")).unwrap_or_default().to_owned();
    println!(
        "{path}: {frames} frames, {} spheres, {:.1} ms; {peak}; {:?}",
        loaded.spheres.len(),
        median(times) * 1e3,
        loaded.notes
    );
}

/// What the few lines keep: places, and for each atom which of the different texts its first value is.
struct Atoms {
    centers: Vec<[f64; 3]>,
    #[expect(dead_code, reason = "collected as a reader must")]
    names: (Vec<String>, Vec<usize>),
}

fn few_lines(text: &str, head: usize, [x, y, z]: [usize; 3]) -> Atoms {
    let mut centers = Vec::new();
    let mut names = (Vec::<String>::new(), Vec::new());
    for line in text.lines().skip(head) {
        let values: Vec<&str> = line.split_ascii_whitespace().collect();
        centers.push([x, y, z].map(|column| values[column].parse().unwrap()));
        let name = values[x - 1];
        let index = names.0.iter().position(|known| known == name).unwrap_or_else(|| {
            names.0.push(name.to_owned());
            names.0.len() - 1
        });
        names.1.push(index);
    }
    Atoms { centers, names }
}

fn xyz(atoms: usize) -> String {
    let mut random = fastrand::Rng::with_seed(1);
    (0..atoms).fold(format!("{atoms}\n\n"), |mut text, _| {
        let [x, y, z] = [(); 3].map(|()| 100.0 * random.f64());
        let element = ["H", "C", "O", "N"][random.usize(..4)];
        writeln!(text, "{element} {x:14.8} {y:14.8} {z:14.8}").unwrap();
        text
    })
}

fn dump(atoms: usize) -> String {
    let mut random = fastrand::Rng::with_seed(2);
    let head = format!(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{atoms}\nITEM: BOX BOUNDS pp pp pp\n0 100\n0 100\n0 100\n\
         ITEM: ATOMS id type x y z vx vy vz\n"
    );
    (0..atoms).fold(head, |mut text, id| {
        let [x, y, z] = [(); 3].map(|()| 100.0 * random.f32());
        let [vx, vy, vz] = [(); 3].map(|()| random.f32() - 0.5);
        let kind = random.u8(1..4);
        writeln!(text, "{id} {kind} {x} {y} {z} {vx} {vy} {vz}").unwrap();
        text
    })
}
