//! The line that `render` prints about a picture.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;

use pinhole_figure::style::Style;

/// Flags for what the program says.
#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// Write the whole scene file that this command means to standard output, and render nothing
    #[arg(long, conflicts_with_all = ["output", "time", "noise", "keep_partial", "layers", "stereo"])]
    pub(crate) print_scene: bool,
    /// Write that scene file beside the picture, with paths that are relative to its folder
    #[arg(long, value_name = "FILE.toml", conflicts_with_all = ["print_scene", "certify"])]
    pub(crate) save_scene: Option<PathBuf>,
    /// Say nothing but warnings and errors: no line about the picture, no notes, no progress
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// The facts in the line about a picture.
#[derive(Clone, Debug)]
pub(crate) struct Report {
    /// The file that was rendered.
    pub(crate) path: String,
    /// The number of spheres in the scene, without those that were added to the data.
    pub(crate) spheres: usize,
    /// The number of spheres before a selection.
    pub(crate) selected_from: Option<usize>,
    /// The number of cones and cylinders in the scene file itself.
    pub(crate) cones: usize,
    pub(crate) bonds: Option<usize>,
    pub(crate) has_atoms: bool,
    pub(crate) style: Option<Style>,
    /// The kind of the data, if it decides anything.
    pub(crate) kind: Option<&'static str>,
    /// The flags for the view, if any.
    pub(crate) view: Option<String>,
    /// The column that colours the spheres without a flag.
    pub(crate) color_by: Option<String>,
}

impl Report {
    /// Returns the line about a picture that took this time: the input, and the flags for the same look.
    pub(crate) fn line(&self, elapsed: Duration) -> String {
        self.line_with("", elapsed)
    }

    /// Returns the line about several pictures that took this time.
    pub(crate) fn line_of(&self, pictures: usize, elapsed: Duration) -> String {
        let plural = if pictures == 1 { "" } else { "s" };
        self.line_with(&format!("{} picture{plural} of ", grouped(pictures)), elapsed)
    }

    fn line_with(&self, start: &str, elapsed: Duration) -> String {
        let noun = if self.has_atoms { "atom" } else { "sphere" };
        let plural = if self.selected_from.unwrap_or(self.spheres) == 1 { "" } else { "s" };
        let style = self.style.map(|style| format!("--style {}", style.name()));
        let kind = self.kind.map(|kind| format!("--kind {kind}"));
        let flags: Vec<String> = kind
            .into_iter()
            .chain(style)
            .chain(self.view.clone())
            .chain(self.color_by.as_ref().map(|column| format!("--color-by {column}")))
            .collect();
        let flags = if flags.is_empty() { String::new() } else { format!("; {}", flags.join(" ")) };
        let count = match self.selected_from {
            Some(all) => format!("kept {} of {}", grouped(self.spheres), grouped(all)),
            None => grouped(self.spheres),
        };
        let more =
            |count: usize, noun: &str| format!(", {} {noun}{}", grouped(count), if count == 1 { "" } else { "s" });
        let cones = if self.cones > 0 { more(self.cones, "cone") } else { String::new() };
        let bonds = self.bonds.map_or(String::new(), |bonds| more(bonds, "bond"));
        let path = &self.path;
        format!("{path}: {start}{count} {noun}{plural}{cones}{bonds}{flags}; {:.1} s", elapsed.as_secs_f64())
    }
}

/// Writes a number with a comma before each group of three digits.
pub(crate) fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_grouped() {
        for (number, text) in [(0, "0"), (999, "999"), (4779, "4,779"), (1_234_567, "1,234,567")] {
            assert_eq!(grouped(number), text);
        }
    }
}
