//! Parts of kernels. A part is a WGSL file of the folder `shaders`, or a variant of such a file.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::LazyLock;

/// The start of the line that begins a variant in its file. The rest of the line is the name of the variant.
pub(crate) const VARIANT: &str = "//// ";

/// A WGSL file, or one variant of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    /// Path of the file relative to `shaders`. For a variant, `#` and its name follow.
    pub(crate) name: &'static str,
    pub(crate) source: Cow<'static, str>,
    /// Number of lines of the file before the source.
    skipped: usize,
}

macro_rules! files {
    ($($folder:literal: $($file:literal)+;)+) => {
        &[$($((
            concat!($folder, "/", $file, ".wgsl"),
            include_str!(concat!(
                env!("CARGO_MANIFEST_DIR"), "/shaders/", $folder, "/", $file, ".wgsl"
            )),
        ),)+)+]
    };
}

/// The paths of all files relative to `shaders`, and their texts.
const FILES: &[(&str, &str)] = files! {
    "accel": "ball_grid" "ball_list" "balls" "brick" "capsules" "cell_words" "excluded" "grid_ray" "leaf" "list"
        "nested_ball_cell" "nested_grid" "nearest_hit" "ray_query" "slab" "spend" "tile_lists" "wide_group" "wide_node" "wide_tree";
    "camera": "camera_ray" "entry" "film" "film_sample" "filter" "fisheye" "orthographic" "panorama" "pinhole"
        "ray" "thin-lens";
    "host": "clip_depth" "composite" "cover" "covered" "farthest" "hide" "host_color" "host_depth" "host_view"
        "limit" "mean" "overlay" "picture_depth" "resolve";
    "live": "light" "records" "reproject" "show" "trace" "view";
    "math": "disk" "fence" "luminance" "sampling" "trigonometry" "trigonometry_inverse" "turns" "warp";
    "path": "accumulate" "address" "advance" "begin_path" "bounce" "bsdf" "by_chance" "choices" "cone_place"
        "departed_shape" "departure" "dielectric" "direct" "direct_light" "extend" "film_sums" "first_hit" "hit_before"
        "leave" "medium" "microfacet" "noise" "occlude" "queue" "scatter" "scatter_light" "schedule" "seen_light"
        "sphere_place" "start" "state" "surface_point" "vertex" "whole_paths";
    "primary": "color_target" "data_layers" "denoise" "entry" "hit_before" "hits" "schedule" "shade"
        "shade_entry" "shading" "status" "trace" "trace_tile";
    "scene": "appearance" "appearance_words" "cone" "cone_crossing" "cone_side" "emitter" "emitters" "enter" "environment" "frame" "lamp"
        "lighting" "lighting_records" "material" "recolor" "records" "sky" "sphere";
    "self_test": "arithmetic" "cones" "exact" "loops" "records";
    "studio": "ambient" "ambient_light" "catcher" "faded" "gather" "hidden_light" "hide" "illuminate"
        "lamp_light" "one_ground" "one_pass" "one_surface" "reflected" "seen" "shadow" "surface";
};

/// The lists of parts.
const LISTS: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/kernels.txt"));

/// The parts that are named in a list of `shaders/kernels.txt`. `choices` are names that begin with
/// `$`, and the lists that replace them.
pub(super) fn parts(names: &'static str, choices: &[(&str, &'static str)]) -> Vec<Part> {
    static BY_NAME: LazyLock<HashMap<&str, &str>> =
        LazyLock::new(|| LISTS.split("\n\n").filter_map(|list| list.split_once(':')).collect());
    let expanded = names.split_whitespace().flat_map(|name| {
        let choice = choices.iter().find(|(choice, _)| *choice == name);
        match choice.map(|(_, list)| list).or(BY_NAME.get(name)) {
            Some(&list) => parts(list, choices),
            None => vec![Part::named(name)],
        }
    });
    expanded.collect()
}

impl Part {
    /// A file of the folder, or one of its variants. If it does not exist, its source is empty,
    /// which a test of all kernels detects.
    pub(crate) fn named(name: &'static str) -> Self {
        let file = name.split('#').next();
        let text = FILES.iter().find(|(known, _)| Some(*known) == file).map_or("", |(_, text)| text);
        Self::of(name, text)
    }

    /// The part with this name from the text of its file.
    pub(crate) fn of(name: &'static str, text: &'static str) -> Self {
        let (source, skipped) = match name.split_once('#') {
            None => (text, 0),
            Some((_, wanted)) => {
                let found = variants(text).find(|(variant, ..)| *variant == wanted);
                found.map(|(_, source, skipped)| (source, skipped)).unwrap_or_default()
            }
        };
        Self { name, source: Cow::Borrowed(source), skipped }
    }

    /// Path of the file relative to `shaders`.
    pub(crate) fn file(&self) -> &'static str {
        self.name.split('#').next().unwrap_or(self.name)
    }

    /// The line of the file that corresponds to a line of the source. Both are counted from 1.
    pub(super) fn line_in_file(&self, line: usize) -> usize {
        self.skipped + line
    }
}

/// The variants of a file: name, source without the line of the name, and number of lines before the source.
pub(crate) fn variants(file: &str) -> impl Iterator<Item = (&str, &str, usize)> {
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
        let part = Part::of("a.wgsl#two", FILE);
        assert_eq!((part.file(), part.source.as_ref()), ("a.wgsl", "fn b() {}\n"));
        assert_eq!(FILE.lines().nth(part.line_in_file(1) - 1), Some("fn b() {}"));
        assert!(Part::of("a.wgsl#three", FILE).source.is_empty());
    }
}
