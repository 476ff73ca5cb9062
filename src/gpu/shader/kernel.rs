//! Kernels, whose source is the concatenation of a list of parts.

use std::collections::BTreeSet;

use super::part::{Part, parts};
use crate::gpu::edit::Edits;
use crate::gpu::error::GpuError;

/// The value of an `override` constant of WGSL, which is 0 or 1 for one of type `bool`.
pub(crate) type Constant = (&'static str, u32);

/// An entry point, the parts from which it is composed, and the values of their `override` constants. Kernels that
/// differ only in these values have the same source, and a pipeline for each set of values.
#[derive(Clone, Debug)]
pub(crate) struct Kernel {
    pub(crate) entry_point: &'static str,
    pub(crate) parts: Vec<Part>,
    pub(crate) constants: Vec<Constant>,
}

/// The files of structures, which are alternatives to each other.
const STRUCTURES: &[&str] =
    &["accel/list.wgsl", "accel/ball_grid.wgsl", "accel/nested_grid.wgsl", "accel/wide_tree.wgsl", WITH_DIRECTIVE];

/// The file that begins with a directive, which WGSL allows only before all declarations.
const WITH_DIRECTIVE: &str = "accel/ray_query.wgsl";

/// The file of the shape that is not a sphere.
const CONE: &str = "scene/cone.wgsl";

/// Whether other kernels with the same entry point may have another part in place of this one.
fn is_choice(part: &str) -> bool {
    part.contains('#') || STRUCTURES.contains(&part) || part == CONE
}

impl Kernel {
    /// The kernel with the list of parts of its entry point in `shaders/kernels.txt`. `choices` are names in the list
    /// that begin with `$`, and the lists that replace them.
    pub(crate) fn new(entry_point: &'static str, choices: &[(&str, &'static str)]) -> Self {
        Self { entry_point, parts: parts(entry_point, choices), constants: Vec::new() }
    }

    /// The kernel with values of constants. Values of constants that it does not declare are ignored.
    pub(crate) fn with(mut self, constants: impl IntoIterator<Item = Constant>) -> Self {
        let lines = self.parts.iter().flat_map(|part| part.source.lines());
        let names: BTreeSet<_> =
            lines.filter_map(|line| Some(line.strip_prefix("override ")?.split_once(':')?.0)).collect();
        let declared = constants.into_iter().filter(|(name, _)| names.contains(name));
        self.constants.extend(declared);
        self
    }

    /// The entry point and the parts that distinguish this kernel from others with another source.
    pub(crate) fn name(&self) -> String {
        let chosen = self.parts.iter().map(|part| part.name).filter(|name| is_choice(name));
        chosen.fold(self.entry_point.to_owned(), |name, part| {
            let (_, file) = part.split_once('/').unwrap_or(("", part));
            name + " " + &file.replace(".wgsl", "")
        })
    }

    /// The constants in the form that wgpu takes.
    pub(crate) fn values_of_constants(&self) -> Vec<(&'static str, f64)> {
        self.constants.iter().map(|(name, value)| (*name, f64::from(*value))).collect()
    }

    /// Whether the kernel uses ray queries, which not every device supports.
    pub(crate) fn has_ray_queries(&self) -> bool {
        self.parts.iter().any(|part| part.name == WITH_DIRECTIVE)
    }

    /// The kernel with one more part.
    #[cfg(test)]
    pub(crate) fn with_part(mut self, file: &'static str, source: &'static str) -> Self {
        self.parts.push(Part::of(file, source));
        self
    }

    /// The kernel after the edits of its parts and the rewrite of its whole source.
    pub(crate) fn edited(mut self, edits: &Edits) -> Result<Self, GpuError> {
        for edit in &edits.replacements {
            for part in self.parts.iter_mut().filter(|part| part.name == edit.file) {
                if !part.source.contains(&edit.find) {
                    return Err(GpuError::NoSuchText { edit: edit.clone() });
                }
                part.source = part.source.replace(&edit.find, &edit.replace).into();
            }
        }
        if let Some(rewrite) = &edits.rewrite {
            let source = rewrite.apply(&self.name(), &self.source());
            // The names of the parts stay, because they name the kernel. The first part gets the whole source.
            self.parts.iter_mut().for_each(|part| part.source = "".into());
            if let Some(first) = self.parts.first_mut() {
                first.source = source.into();
            }
        }
        Ok(self)
    }

    /// The composed WGSL, in which a comment names each part.
    pub(crate) fn source(&self) -> String {
        let parts = self.in_order();
        parts.flat_map(|part| ["//// ", part.name, "\n", &part.source, "\n"]).collect()
    }

    /// The parts in the order in which they are composed. A part that begins with a directive is the first.
    fn in_order(&self) -> impl Iterator<Item = &Part> {
        let has_directive = |part: &&Part| part.name == WITH_DIRECTIVE;
        let others = self.parts.iter().filter(move |part| !has_directive(part));
        self.parts.iter().filter(has_directive).chain(others)
    }

    /// Replaces positions in the composed WGSL, in a message of naga or wgpu, by positions in files.
    ///
    /// The parser names the source `wgsl`, and the validator names it by its label, which is the name of the kernel.
    pub(crate) fn with_positions_in_files(&self, message: &str) -> String {
        let positions = self.replace_positions("wgsl:", message);
        self.replace_positions(&format!("{}:", self.name()), &positions)
    }

    fn replace_positions(&self, prefix: &str, message: &str) -> String {
        let mut pieces = message.split(prefix);
        let mut text = pieces.next().unwrap_or_default().to_owned();
        for piece in pieces {
            let digits = piece.find(|c: char| !c.is_ascii_digit()).unwrap_or(piece.len());
            match piece[..digits].parse().ok().and_then(|line| self.position(line)) {
                Some((file, line)) => text += &format!("{file}:{line}{}", &piece[digits..]),
                None => text += &format!("{prefix}{piece}"),
            }
        }
        text
    }

    /// The file and line of a line of the composed WGSL. Lines are counted from 1.
    fn position(&self, line: usize) -> Option<(&'static str, usize)> {
        // The first line of a part is the comment that names it.
        let mut comment = 1;
        for part in self.in_order() {
            // `source` adds a line end to every part.
            let lines = part.source.matches('\n').count() + 1;
            if (comment..=comment + lines).contains(&line) {
                let in_source = line.saturating_sub(comment).max(1);
                return Some((part.file(), part.line_in_file(in_source)));
            }
            comment += 1 + lines;
        }
        None
    }
}
