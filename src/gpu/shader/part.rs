//! Parts of kernels. A part is a WGSL file of the folder `shaders`, or a variant of such a file.

use std::borrow::Cow;

/// The start of the line that begins a variant in its file. The rest of the line is the name of the variant.
pub(in crate::gpu) const VARIANT: &str = "//// ";

/// A WGSL file, or one variant of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::gpu) struct Part {
    /// Path of the file relative to `shaders`. For a variant, `#` and its name follow.
    pub(in crate::gpu) name: &'static str,
    pub(in crate::gpu) source: Cow<'static, str>,
    /// Number of lines of the file before the source.
    skipped: usize,
}

/// Creates a part from its file and, if the file has variants, the name of the variant.
macro_rules! part {
    ($file:literal) => {
        $crate::gpu::shader::Part::whole(
            $file,
            include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/", $file)),
        )
    };
    ($file:literal, $variant:literal) => {
        $crate::gpu::shader::Part::variant(
            concat!($file, "#", $variant),
            include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/", $file)),
        )
    };
}
pub(in crate::gpu) use part;

impl Part {
    pub(in crate::gpu) const fn whole(name: &'static str, source: &'static str) -> Self {
        Self { name, source: Cow::Borrowed(source), skipped: 0 }
    }

    /// The variant with the given name. Its source is empty if the file has no such variant, which a test of all
    /// kernels detects.
    pub(in crate::gpu) fn variant(name: &'static str, file: &'static str) -> Self {
        let wanted = name.split_once('#').map(|(_, variant)| variant);
        let found = variants(file).find(|(variant, ..)| Some(*variant) == wanted);
        let (_, source, skipped) = found.unwrap_or_default();
        Self { name, source: Cow::Borrowed(source), skipped }
    }

    /// Path of the file relative to `shaders`.
    pub(in crate::gpu) fn file(&self) -> &'static str {
        self.name.split('#').next().unwrap_or(self.name)
    }

    /// The line of the file that corresponds to a line of the source. Both are counted from 1.
    pub(super) fn line_in_file(&self, line: usize) -> usize {
        self.skipped + line
    }
}

/// The variants of a file: name, source without the line of the name, and number of lines before the source.
pub(in crate::gpu) fn variants(file: &str) -> impl Iterator<Item = (&str, &str, usize)> {
    let starts = file.match_indices(VARIANT).map(|(at, _)| at);
    let starts: Vec<usize> = starts.filter(|at| file[..*at].ends_with('\n')).collect();
    let ends = starts.clone().into_iter().skip(1).chain([file.len()]);
    starts.into_iter().zip(ends).map(|(start, end)| {
        let text = &file[start + VARIANT.len()..end];
        let (name, source) = text.split_once('\n').unwrap_or((text, ""));
        (name, source, file[..start].matches('\n').count() + 1)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "// What both do.\n\n//// one\nfn a() {}\n\n//// two\nfn b() {}\n";

    #[test]
    fn a_file_has_variants() {
        let found: Vec<_> = variants(FILE).collect();
        assert_eq!(found, [("one", "fn a() {}\n\n", 3), ("two", "fn b() {}\n", 6)]);
        assert_eq!(variants("fn a() {}\n").count(), 0);
    }

    #[test]
    fn a_variant_knows_its_lines() {
        let part = Part::variant("a.wgsl#two", FILE);
        assert_eq!((part.file(), part.source.as_ref()), ("a.wgsl", "fn b() {}\n"));
        assert_eq!(FILE.lines().nth(part.line_in_file(1) - 1), Some("fn b() {}"));
        assert!(Part::variant("a.wgsl#three", FILE).source.is_empty());
    }
}
