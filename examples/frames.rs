//! Prints the contents of every frame of a file as tables with tabs: the cell, the notes, and a line for each sphere.
//!
//! `cargo run --example frames -- FILE [TOPOLOGY]`

use std::io::Write as _;

use pinhole::{LinearRgb, SphereArray};
use pinhole_data::load::{self, Column, ColumnValues, Dataset, LoadErrorKind, Options, Trajectory};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let file = arguments.next().ok_or("name a file")?;
    let mut options = Options::default();
    if let Some(topology) = arguments.next() {
        options = options.with_topology(topology);
    }
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    match Trajectory::open(&file, &options) {
        Ok(mut trajectory) => {
            for index in 0..trajectory.len() {
                let frame = trajectory.frame(index)?;
                print(&mut out, index, &frame)?;
            }
            if let Some(problem) = trajectory.problem() {
                writeln!(out, "problem\t{problem}")?;
            }
        }
        Err(error) if error.kind == LoadErrorKind::NoFrames => {
            print(&mut out, 0, &load::open(&file, &options)?)?;
        }
        Err(error) => return Err(error.into()),
    }
    Ok(())
}

fn print(out: &mut impl std::io::Write, index: usize, frame: &Dataset) -> std::io::Result<()> {
    writeln!(out, "frame\t{index}\t{}", frame.spheres.len())?;
    for edge in frame.cell.iter().flatten() {
        writeln!(out, "cell\t{}\t{}\t{}", edge[0], edge[1], edge[2])?;
    }
    for note in &frame.notes {
        writeln!(out, "note\t{note}")?;
    }
    write!(out, "columns\tx\ty\tz\tradius")?;
    for Column { name, .. } in &frame.columns {
        write!(out, "\t{name}")?;
    }
    let has_colors = frame.colors.is_some();
    writeln!(out, "{}", if has_colors { "\tcolor" } else { "" })?;
    for (row, sphere) in frame.colored_spheres(LinearRgb::WHITE).enumerate() {
        let [x, y, z, radius] = match &frame.spheres {
            SphereArray::F32(all) => all[row].map(f64::from),
            SphereArray::F64(all) => all[row],
        };
        write!(out, "{x}\t{y}\t{z}\t{radius}")?;
        for Column { values, .. } in &frame.columns {
            match values {
                ColumnValues::Numbers(numbers) => write!(out, "\t{}", numbers[row])?,
                ColumnValues::Labels(all) => {
                    write!(out, "\t{}", all.names[all.indices[row] as usize])?;
                }
            }
        }
        if has_colors {
            let [r, g, b] = sphere.color.to_srgb8();
            write!(out, "\t#{r:02x}{g:02x}{b:02x}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}
