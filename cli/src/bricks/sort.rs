//! `pinhole sort`: divides the spheres of a data file among the bricks of a new file. Arrays are read in pieces, four
//! times, so that memory use does not depend on their size.

use std::io::BufWriter;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result, anyhow};
use clap::Args;

use crate::bricks::EXTENSION;
use crate::bricks::file::{COLOR, Header, ID, SPHERE, StoredColors, WholeBits};
use crate::bricks::outer::{Cells, Outer};
use crate::bricks::writer::{self, Array, Stream, Writer};
use crate::input::data::{DataOptions, format_parser};
use crate::input::{Source, default_color, extension};
use crate::output::files::{check_not_inputs, check_writable, name_all, unnamed_with};
use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, tell};
use crate::terminal::{memory, threads};
use pinhole::scene::{Colors, Scene, SceneExtent};
use pinhole_data::load::Format as DataFormat;

/// Default size of a brick in bytes: spheres and ids of 4 Mi spheres.
const BRICK_BYTES: u64 = 80 << 20;

const MOST_BRICKS: u64 = 1 << 16;

#[derive(Debug, Args)]
#[command(
    after_help = "Arrays (.npy of shape (n, 4), or (n, 3) with --radius, of f32 or f64, and raw-f32x4) are read \
    piece by piece, four times, in memory that does not depend on their size. Other files are read whole. Colors are kept; \
    other columns are not. Exit codes are those of `render`."
)]
pub(crate) struct SortArgs {
    /// Data file to sort
    #[arg(value_name = "DATA")]
    pub(crate) path: PathBuf,
    /// File of bricks to write
    #[arg(short, long, value_name = "FILE.bricks")]
    output: PathBuf,
    /// Number of bricks [default: as many as bricks of --brick-bytes are]
    #[arg(long, value_name = "N", conflicts_with = "brick_bytes", value_parser = clap::value_parser!(u64).range(1..=65536))]
    bricks: Option<u64>,
    /// Bytes of a brick, such as 20M or 1G: 20 for each sphere, and 4 more with colors [default: 80M]
    #[arg(long, value_name = "BYTES")]
    brick_bytes: Option<String>,
    /// Format of the data file, whatever its extension is
    #[arg(long, value_parser = format_parser())]
    format: Option<&'static DataFormat>,
    /// File that says what the spheres of a trajectory are, for formats that have positions alone
    #[arg(long, value_name = "FILE")]
    topology: Option<PathBuf>,
    /// Names of the columns of a table without a header, such as x,y,z,radius
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    columns: Vec<String>,
    /// Radius of all spheres, for atoms and data without radii
    #[arg(long, value_name = "R", allow_hyphen_values = true)]
    radius: Option<f64>,
    /// Frame of a trajectory, counted from 0 [default: 0]
    #[arg(long, value_name = "N")]
    frame: Option<usize>,
    /// Say nothing but warnings and errors
    #[arg(short, long)]
    quiet: bool,
}

struct Input {
    stream: Stream,
    z_is_up: bool,
    has_atoms: bool,
}

pub(crate) fn run(args: &SortArgs) -> Result<(), Failure> {
    let started = Instant::now();
    if extension(&args.output).as_deref() != Some(EXTENSION) {
        return Err(Failure::usage(format!(
            "{}: spheres are sorted into files with the extension .{EXTENSION}",
            args.output.display()
        )));
    }
    check_writable(&args.output)?;
    check_not_inputs(std::iter::once(&args.output), std::slice::from_ref(&args.path))?;
    let bytes = args.brick_bytes.as_deref().map(parse_bytes).transpose()?;
    if args.quiet {
        progress::close();
    }
    threads::start()?;
    let input = input(args)?;
    let count = input.stream.count();
    if count == 0 {
        return Err(Failure::Job(anyhow!(
            "{}: the file has no spheres, so there is nothing to sort",
            args.path.display()
        )));
    }
    if count >= u64::from(u32::MAX) {
        return Err(Failure::Job(anyhow!("{}: {count} spheres are too many; ids are u32", args.path.display())));
    }
    let colors = stored_colors(&input.stream)?;
    let per_brick = (bytes.unwrap_or(BRICK_BYTES) / colors.sphere_bytes()).max(1);
    let bricks = args.bricks.unwrap_or(count.div_ceil(per_brick)).min(count);
    if bricks > MOST_BRICKS {
        return Err(Failure::usage(format!(
            "--brick-bytes: {count} spheres would be {bricks} bricks, but a file has {MOST_BRICKS} at most; choose \
             larger ones"
        )));
    }
    let written = write(args, &input, colors, bricks as usize)?;
    progress::clear();
    if !args.quiet {
        tell(format_args!(
            "{}: {count} spheres in {} bricks, the largest of {}; {:.1} s",
            args.output.display(),
            written.bricks.len(),
            memory::readable(written.largest()),
            started.elapsed().as_secs_f64()
        ));
    }
    Ok(())
}

impl Header {
    pub(crate) fn largest(&self) -> u64 {
        let most = self.bricks.iter().map(|brick| brick.section.count).max();
        most.unwrap_or(0) * self.colors.sphere_bytes()
    }
}

/// Parses a number of bytes with an optional unit.
fn parse_bytes(text: &str) -> Result<u64, Failure> {
    let units = [("K", 10), ("M", 20), ("G", 30)];
    let unit = units.into_iter().find_map(|(unit, shift)| Some((text.strip_suffix(unit)?, shift)));
    let (digits, shift) = unit.unwrap_or((text, 0));
    let number = digits.parse::<u64>().ok().and_then(|number| number.checked_mul(1 << shift));
    number.filter(|bytes| *bytes >= SPHERE + ID + COLOR).ok_or_else(|| {
        Failure::usage(format!("--brick-bytes {text}: write a number of bytes such as 80M, at least 24"))
    })
}

fn input(args: &SortArgs) -> Result<Input, Failure> {
    let options = DataOptions {
        frame: args.frame,
        radius: args.radius,
        topology: args.topology.clone(),
        columns: args.columns.clone(),
    };
    let source = Source::new(&args.path, &options.given(args.format).plain())?;
    let Some(format) = source.data_format() else {
        return Err(Failure::usage(format!(
            "{}: name a data file; scenes are sorted by the data that they name",
            args.path.display()
        )));
    };
    let z_is_up = format.z_is_up;
    let can_stream = args.topology.is_none() && args.columns.is_empty() && args.frame.is_none();
    if can_stream && let Some(array) = Array::of(&args.path, format, args.radius) {
        let stream = Stream::Array(args.path.clone(), array);
        return Ok(Input { stream, z_is_up, has_atoms: false });
    }
    let mut contents = source.contents()?;
    let notes = std::mem::take(&mut contents.details.notes);
    if !args.quiet && !contents.scene.is_empty() {
        notes.iter().for_each(|note| tell(format_args!("note: {note}")));
    }
    let has_atoms = contents.details.has_atoms;
    Ok(Input { stream: Stream::Scene(Box::new(contents.scene)), z_is_up, has_atoms })
}

/// Decides how the colours of spheres are stored.
fn stored_colors(stream: &Stream) -> Result<StoredColors, Failure> {
    let bits = |color: &pinhole::LinearRgb| color.to_array().map(f32::to_bits);
    let Stream::Scene(scene) = stream else { return Ok(StoredColors::None) };
    match scene.appearance().colors() {
        Colors::One(color) if *color == default_color() => Ok(StoredColors::None),
        Colors::One(color) => Ok(StoredColors::One(bits(color))),
        Colors::Palette { palette, .. } => Ok(StoredColors::Palette(palette.iter().map(bits).collect())),
        Colors::Rgba8(_) => Ok(StoredColors::Rgba8),
        _ => Err(Failure::Job(anyhow!(
            "colors by numbers are not kept in bricks; remove them from the data, or give spheres colors of their own"
        ))),
    }
}

fn color_of(scene: Option<&Scene>, id: u32) -> Option<[u8; 4]> {
    match scene?.appearance().colors() {
        Colors::Palette { indices, .. } => indices.get(id as usize).map(|index| index.to_le_bytes()),
        Colors::Rgba8(colors) => colors.get(id as usize).copied(),
        _ => None,
    }
}

/// Reads the spheres in passes, and writes the file.
fn write(
    args: &SortArgs,
    Input { stream, z_is_up, has_atoms }: &Input,
    colors: StoredColors,
    bricks: usize,
) -> Result<Header, Failure> {
    let stage = |number: u32, what: &str| {
        progress::stage(format!("{}: pass {number} of 4: {what}", args.path.display()));
    };
    stage(1, "the box of all spheres");
    let bounds = stream.bounds()?.context("there are no spheres")?;
    stage(2, "how they are spread");
    let mut whole = SceneExtent::new(bounds);
    let low = (bounds.min() - whole.origin()).as_vec3();
    let mut cells = Cells::new(low, (bounds.max() - whole.origin()).as_vec3(), stream.count());
    let mut sample = Sample::new(stream.count(), bricks as u64);
    let frame = whole;
    stream.for_each(&frame, &mut |id, sphere| {
        whole.add(sphere);
        cells.add(sphere);
        sample.add(id, sphere);
        Ok(())
    })?;
    cells.set_flat(whole.center_min.cmpeq(whole.center_max));
    let (cuts, outermost) = (sample.cuts(bricks), cells.outermost());
    stage(3, "how many are in each brick");
    let (mut counts, mut outer) = (vec![0_u64; cuts.bricks], Outer::default());
    stream.for_each(&frame, &mut |id, sphere| {
        counts[cuts.brick(id, sphere)] += 1;
        outer.add(&outermost, sphere);
        Ok(())
    })?;
    let outer = outer.into_spheres();
    // Empty bricks are left out.
    let mut number = 0;
    let place: Vec<usize> = counts
        .iter()
        .map(|count| {
            number += usize::from(*count > 0);
            number.saturating_sub(1)
        })
        .collect();
    counts.retain(|count| *count > 0);
    stage(4, "writing bricks");
    let has_colors = colors.bytes() > 0;
    let scene = match stream {
        Stream::Scene(scene) if has_colors => Some(scene.as_ref()),
        _ => None,
    };
    let mut header = Header {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        source: args.path.display().to_string(),
        z_is_up: *z_is_up,
        has_atoms: *has_atoms,
        whole: WholeBits::of(&whole),
        colors,
        outer: writer::none(),
        bricks: Vec::new(),
    };
    // A fault that a pass finds in the input is not an error of the output.
    let mut unread = None;
    let written = unnamed_with(&args.output, |file| {
        let mut file = BufWriter::new(file);
        let mut writer = Writer::new(&mut file, &counts, has_colors);
        let mut unwritten = None;
        let passed = stream.for_each(&frame, &mut |id, sphere| {
            let brick = place[cuts.brick(id, sphere)];
            writer.add(brick, id, sphere, color_of(scene, id)).map_err(|error| {
                unwritten = Some(error);
                anyhow!("the bricks cannot be written")
            })
        });
        if let Err(error) = passed {
            return Err(unwritten.unwrap_or_else(|| {
                unread = Some(error);
                std::io::Error::other("the data cannot be read again")
            }));
        }
        let (written, end) = writer.finish()?;
        header.bricks = written;
        header.outer = writer::outer(&mut file, end, &outer)?;
        let end = end + SPHERE * header.outer.count;
        writer::header(&mut file, end, &header)?;
        std::io::Write::flush(&mut file)
    });
    if let Some(error) = unread {
        return Err(error.into());
    }
    name_all(vec![(&args.output, written?)])?;
    Ok(header)
}

/// The position of a sphere among others along an axis: its coordinate as an integer with the same order, and its id,
/// so that spheres in one place can be divided too.
type Key = (u32, u32);

/// Number of sampled spheres for each brick that is enough for bricks of about equal size.
const PER_BRICK: u64 = 1 << 12;

/// The most spheres in the sample.
const MOST: u64 = 1 << 21;

/// A sample of the spheres, chosen by their ids.
pub(crate) struct Sample {
    /// Ids whose hash is below this number are chosen.
    below: u64,
    spheres: Vec<([f32; 3], u32)>,
}

impl Sample {
    /// Creates an empty sample of `count` spheres, for this number of bricks.
    pub(crate) fn new(count: u64, bricks: u64) -> Self {
        let wanted = (bricks * PER_BRICK).clamp(1 << 16, MOST);
        let below = if wanted >= count { u64::MAX } else { u64::MAX / count * wanted };
        Self { below, spheres: Vec::new() }
    }

    pub(crate) fn add(&mut self, id: u32, [x, y, z, _]: [f32; 4]) {
        if hash(id) <= self.below {
            self.spheres.push(([x, y, z], id));
        }
    }

    pub(crate) fn cuts(mut self, bricks: usize) -> Cuts {
        let mut cuts = Cuts { nodes: Vec::new(), bricks };
        cuts.cut(&mut self.spheres, 0, bricks);
        cuts
    }
}

/// A bijection that moves near numbers far apart (the finaliser of `SplitMix64`: Steele, Lea and Flood 2014).
fn hash(id: u32) -> u64 {
    let x = u64::from(id).wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Repeated cuts across the longest side. Bricks are numbered so that consecutive ones lie together.
pub(crate) struct Cuts {
    nodes: Vec<Node>,
    pub(crate) bricks: usize,
}

#[derive(Clone, Copy)]
enum Node {
    Cut { axis: usize, first_right: Key, right: usize },
    Brick(usize),
}

impl Cuts {
    /// Cuts some spheres of the sample into this number of bricks, from the brick `first` on.
    fn cut(&mut self, spheres: &mut [([f32; 3], u32)], first: usize, bricks: usize) {
        let middle = spheres.len() * (bricks / 2) / bricks.max(1);
        if bricks <= 1 || middle == 0 {
            self.nodes.push(Node::Brick(first));
            return;
        }
        let axis = longest_side(spheres);
        let key = |(center, id): &([f32; 3], u32)| (ascending(center[axis]), *id);
        spheres.select_nth_unstable_by_key(middle, key);
        let first_right = key(&spheres[middle]);
        let (left, right) = spheres.split_at_mut(middle);
        let node = self.nodes.len();
        self.nodes.push(Node::Brick(first));
        self.cut(left, first, bricks / 2);
        self.nodes[node] = Node::Cut { axis, first_right, right: self.nodes.len() };
        self.cut(right, first + bricks / 2, bricks - bricks / 2);
    }

    pub(crate) fn brick(&self, id: u32, sphere: [f32; 4]) -> usize {
        let mut at = 0;
        loop {
            match self.nodes[at] {
                Node::Brick(brick) => return brick,
                Node::Cut { axis, first_right, right } => {
                    at = if (ascending(sphere[axis]), id) < first_right { at + 1 } else { right };
                }
            }
        }
    }
}

fn longest_side(spheres: &[([f32; 3], u32)]) -> usize {
    let mut sides = [(f32::MAX, f32::MIN); 3];
    for (center, _) in spheres {
        for (side, x) in sides.iter_mut().zip(center) {
            *side = (side.0.min(*x), side.1.max(*x));
        }
    }
    let length = |axis: &usize| sides[*axis].1 - sides[*axis].0;
    (0..3).max_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or(0)
}

/// Returns an integer with the same order as a number.
fn ascending(x: f32) -> u32 {
    let bits = (x + 0.0).to_bits();
    if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counts(spheres: &[[f32; 4]], bricks: usize) -> Vec<usize> {
        let mut sample = Sample::new(spheres.len() as u64, bricks as u64);
        (0..).zip(spheres).for_each(|(id, sphere)| sample.add(id, *sphere));
        let cuts = sample.cuts(bricks);
        let mut counts = vec![0; bricks];
        (0..).zip(spheres).for_each(|(id, sphere)| counts[cuts.brick(id, *sphere)] += 1);
        counts
    }

    #[test]
    fn bricks_have_about_equal_numbers_also_of_spheres_in_one_place() {
        let lattice = |i: u32| [(i % 64) as f32, (i / 64 % 64) as f32, (i / 4096) as f32, 0.5];
        let kinds: [fn(u32) -> [f32; 4]; 3] = [lattice, |_| [-3.0, 1e30, 0.0, 1.0], |i| [-(i as f32), 0.0, -0.0, 1.0]];
        for kind in kinds {
            let spheres: Vec<[f32; 4]> = (0..200_000).map(kind).collect();
            for bricks in [1, 2, 7, 48] {
                let counts = counts(&spheres, bricks);
                let even = spheres.len() / bricks;
                assert!(counts.iter().all(|count| count.abs_diff(even) <= even / 5), "{counts:?}");
            }
        }
    }

    #[test]
    fn few_spheres_make_bricks_of_one_or_none() {
        let spheres = [[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 1.0], [2.0, 0.0, 0.0, 1.0]];
        assert_eq!(counts(&spheres, 3), [1, 1, 1]);
        assert_eq!(counts(&spheres, 8).iter().sum::<usize>(), 3);
        assert_eq!(counts(&[], 4), [0; 4]);
    }
}
