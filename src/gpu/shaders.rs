//! Composes kernels: an explicit list of WGSL parts per kernel, concatenated.
//!
//! WGSL has no modules and does not care about the order of declarations, so "these parts" is a
//! complete module system for a folder of this size. This is the only file that knows how it is done.

use std::borrow::Cow;

use super::edit::ShaderEdit;
use super::error::GpuError;
use super::formats::ColorTarget;
use crate::accel::{BrickKind, ListLayout, Primitive, Structure};
use crate::camera::{CameraKind, camera_table};

/// One WGSL file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Part {
    file: &'static str,
    source: Cow<'static, str>,
}

macro_rules! part {
    ($($piece:literal),+) => {
        $crate::gpu::shaders::Part::new(
            concat!($($piece),+),
            include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/", $($piece),+)),
        )
    };
}
pub(super) use part;

impl Part {
    pub(super) const fn new(file: &'static str, source: &'static str) -> Self {
        Self { file, source: Cow::Borrowed(source) }
    }
}

/// An entry point, and the parts that it is composed of.
#[derive(Clone, Debug)]
pub(super) struct Kernel {
    pub(super) entry_point: &'static str,
    pub(super) parts: Vec<Part>,
}

/// Whether a brick is the first that a picture's rays meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BrickPass {
    First,
    Later,
}

/// What a kernel of the self-test tries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Probe {
    /// Operations that may round.
    Arithmetic,
    /// Operations that may not.
    Exact,
    Loops,
}

/// Finds the nearest sphere of every ray; the rays may be kept.
pub(super) fn trace_kernel(
    camera: CameraKind,
    kind: BrickKind,
    brick_pass: BrickPass,
    keeps_rays: bool,
) -> Kernel {
    let mut parts = walk_parts(camera, kind, brick_pass);
    parts.push(match (keeps_rays, brick_pass) {
        (false, _) => part!("entry_made.wgsl"),
        (true, BrickPass::First) => part!("entry_recorded.wgsl"),
        (true, BrickPass::Later) => part!("entry_replayed.wgsl"),
    });
    parts.push(part!("trace.wgsl"));
    Kernel { entry_point: "trace", parts }
}

/// Finds whether every ray hits anything.
pub(super) fn occluded_kernel(
    camera: CameraKind,
    kind: BrickKind,
    brick_pass: BrickPass,
) -> Kernel {
    let mut parts = walk_parts(camera, kind, brick_pass);
    parts.extend([part!("entry_made.wgsl"), part!("occluded.wgsl")]);
    Kernel { entry_point: "occluded", parts }
}

fn walk_parts(
    camera: CameraKind,
    BrickKind { structure, primitive }: BrickKind,
    brick_pass: BrickPass,
) -> Vec<Part> {
    let mut parts = common_parts(camera, primitive);
    parts.extend([
        part!("schedule.wgsl"),
        part!("status.wgsl"),
        part!("spend.wgsl"),
        part!("origin_none.wgsl"),
        part!("brick.wgsl"),
    ]);
    parts.push(match brick_pass {
        BrickPass::First => part!("first_brick.wgsl"),
        BrickPass::Later => part!("later_brick.wgsl"),
    });
    parts.extend(structure_parts(structure));
    parts
}

/// What walks a structure.
pub(super) fn structure_parts(structure: Structure) -> Vec<Part> {
    match structure {
        Structure::List => vec![part!("list.wgsl")],
        Structure::WideTree => vec![
            part!("slab.wgsl"),
            part!("leaf.wgsl"),
            part!("wide_group.wgsl"),
            part!("wide_node.wgsl"),
            part!("wide_tree.wgsl"),
        ],
        Structure::BinaryTree => vec![
            part!("slab.wgsl"),
            part!("leaf.wgsl"),
            part!("binary_node.wgsl"),
            part!("binary_tree.wgsl"),
        ],
        Structure::Grid(layout) => {
            vec![part!("grid_ray.wgsl"), part!("grid.wgsl"), list_part(layout)]
        }
        Structure::NestedGrid(layout) => {
            vec![part!("grid_ray.wgsl"), part!("nested_grid.wgsl"), list_part(layout)]
        }
    }
}

/// Turns hits into colour and, if wanted, data layers.
pub(super) fn shade_kernel(
    camera: CameraKind,
    primitive: Primitive,
    color: ColorTarget,
    data_layers: bool,
) -> Kernel {
    let mut parts = common_parts(camera, primitive);
    parts.extend([
        part!("appearance.wgsl"),
        part!("shade.wgsl"),
        part!("shading.wgsl"),
        match color {
            ColorTarget::Srgb8 => part!("color_rgba8unorm.wgsl"),
            ColorTarget::Linear16 => part!("color_rgba16float.wgsl"),
            ColorTarget::Linear32 => part!("color_rgba32float.wgsl"),
        },
        if data_layers { part!("layers_all.wgsl") } else { part!("layers_none.wgsl") },
    ]);
    Kernel { entry_point: "shade", parts }
}

/// Does what the self-test judges.
pub(super) fn self_test_kernel(probe: Probe) -> Kernel {
    let (entry_point, part) = match probe {
        Probe::Arithmetic => ("arithmetic", part!("self_test_arithmetic.wgsl")),
        Probe::Exact => ("exact", part!("self_test_exact.wgsl")),
        Probe::Loops => ("loops", part!("self_test_loops.wgsl")),
    };
    Kernel { entry_point, parts: vec![part!("self_test.wgsl"), part!("fence.wgsl"), part] }
}

fn list_part(layout: ListLayout) -> Part {
    match layout {
        ListLayout::Copied => part!("list_copied.wgsl"),
        ListLayout::Referenced => part!("list_referenced.wgsl"),
    }
}

/// What a primitive is: `Shape`, `intersect` and `shape_normal`.
fn primitive_part(primitive: Primitive) -> Part {
    match primitive {
        Primitive::Sphere => part!("sphere.wgsl"),
    }
}

fn common_parts(camera: CameraKind, primitive: Primitive) -> Vec<Part> {
    let mut parts = vec![
        part!("records.wgsl"),
        part!("frame.wgsl"),
        part!("hits.wgsl"),
        part!("fence.wgsl"),
        part!("film.wgsl"),
        part!("ray.wgsl"),
        part!("enter.wgsl"),
        part!("camera_entry.wgsl"),
        primitive_part(primitive),
    ];
    parts.extend(camera_parts(camera));
    parts
}

/// A camera, and what cameras compute with.
pub(super) fn camera_parts(camera: CameraKind) -> [Part; 3] {
    [part!("trigonometry.wgsl"), part!("disk.wgsl"), camera_part(camera)]
}

macro_rules! define_camera_part {
    ($($(#[$doc:meta])* $variant:ident, $camera:ident, $name:literal, $parameters:ident;)+) => {
        fn camera_part(camera: CameraKind) -> Part {
            match camera {
                $(CameraKind::$variant => part!("camera_", $name, ".wgsl"),)+
            }
        }
    };
}
camera_table!(define_camera_part);

impl Kernel {
    /// The entry point and the parts that distinguish this kernel from others.
    pub(super) fn name(&self) -> String {
        let varying = [
            "camera_",
            "color_",
            "layers_",
            "list",
            "grid.",
            "nested_grid",
            "wide_tree",
            "binary_tree",
            "entry_re",
            "entry_path",
            "schedule_",
            "direct",
            "scatter_",
            "medium_",
            "settle_",
            "start_",
            "sky_",
        ];
        self.parts
            .iter()
            .filter(|part| varying.iter().any(|prefix| part.file.starts_with(prefix)))
            .fold(self.entry_point.to_owned(), |name, part| {
                name + " " + part.file.trim_end_matches(".wgsl")
            })
    }

    /// The kernel with one more part.
    #[cfg(test)]
    pub(super) fn with_part(mut self, file: &'static str, source: &'static str) -> Self {
        self.parts.push(Part { file, source: source.into() });
        self
    }

    /// The kernel with the changes that concern its parts.
    pub(super) fn edited(mut self, edits: &[ShaderEdit]) -> Result<Self, GpuError> {
        for edit in edits {
            for part in self.parts.iter_mut().filter(|part| part.file == edit.file) {
                if !part.source.contains(&edit.find) {
                    return Err(GpuError::NoSuchText { edit: edit.clone() });
                }
                part.source = part.source.replace(&edit.find, &edit.replace).into();
            }
        }
        Ok(self)
    }

    /// The composed WGSL.
    pub(super) fn source(&self) -> String {
        self.parts.iter().flat_map(|part| [part.source.as_ref(), "\n"]).collect()
    }

    /// Replaces every place in the composed WGSL, in a message of naga's or wgpu's, by a place in a part.
    ///
    /// The parser calls the text `wgsl`, the validator by its label, which is the kernel's name.
    pub(super) fn with_positions_in_parts(&self, message: &str) -> String {
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

    /// The part, and the line in it, that a line of the composed WGSL comes from; lines count from 1.
    fn position(&self, line: usize) -> Option<(&'static str, usize)> {
        let mut first = 1;
        for part in &self.parts {
            // One more for the line end that `source` adds.
            let lines = part.source.matches('\n').count() + 1;
            if (first..first + lines).contains(&line) {
                return Some((part.file, line - first + 1));
            }
            first += lines;
        }
        None
    }
}

/// Every kernel that can be composed.
#[cfg(test)]
pub(super) fn all_kernels() -> Vec<Kernel> {
    let mut kernels =
        [Probe::Arithmetic, Probe::Exact, Probe::Loops].map(self_test_kernel).to_vec();
    for &camera in CameraKind::ALL {
        for kind in BrickKind::of(Structure::ALL, Primitive::ALL) {
            for brick_pass in [BrickPass::First, BrickPass::Later] {
                for keeps_rays in [false, true] {
                    kernels.push(trace_kernel(camera, kind, brick_pass, keeps_rays));
                }
                kernels.push(occluded_kernel(camera, kind, brick_pass));
            }
        }
        for &primitive in Primitive::ALL {
            for &color in ColorTarget::ALL {
                for data_layers in [false, true] {
                    kernels.push(shade_kernel(camera, primitive, color, data_layers));
                }
            }
        }
    }
    kernels.extend(super::lit::all_kernels());
    kernels.push(super::denoise::denoise_kernel());
    kernels.push(super::recolor::recolor_kernel());
    kernels
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use super::*;

    fn validate(kernel: &Kernel) -> Result<naga::Module, String> {
        let source = kernel.source();
        let readable = |message: String| kernel.with_positions_in_parts(&message);
        let module = naga::front::wgsl::parse_str(&source)
            .map_err(|error| readable(error.emit_to_string(&source)))?;
        naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            // Nothing beyond WebGPU's core.
            naga::valid::Capabilities::empty(),
        )
        .validate(&module)
        .map_err(|error| readable(error.emit_to_string(&source)))?;
        Ok(module)
    }

    #[test]
    fn every_kernel_composes_and_validates() {
        let kernels = all_kernels();
        assert_eq!(
            kernels.len(),
            CameraKind::ALL.len()
                * (6 * BrickKind::of(Structure::ALL, Primitive::ALL).count()
                    + 2 * Primitive::ALL.len() * ColorTarget::ALL.len())
                + 5
                + super::super::lit::all_kernels().len()
        );
        for kernel in kernels {
            let module =
                validate(&kernel).unwrap_or_else(|error| panic!("{}: {error}", kernel.name()));
            let entry = &module.entry_points[0];
            assert_eq!(module.entry_points.len(), 1, "{}", kernel.name());
            assert_eq!(entry.name, kernel.entry_point);
            assert_eq!(entry.workgroup_size.iter().product::<u32>(), 64);
        }
    }

    /// A zero that a kernel has not set is one that the compiler knows.
    #[test]
    fn every_kernel_sets_what_fences_need() {
        let uses_frame =
            |kernel: &Kernel| kernel.parts.iter().any(|part| part.file == "frame.wgsl");
        for kernel in all_kernels().iter().filter(|kernel| uses_frame(kernel)) {
            let source = kernel.source();
            let entry = source.split(&format!("fn {}(", kernel.entry_point)).nth(1).unwrap();
            let first = entry.lines().nth(1).unwrap();
            assert_eq!(first.trim(), "zero_bits = frame.zero;", "{}", kernel.name());
        }
    }

    #[test]
    fn an_error_names_the_part_and_its_line() {
        let broken =
            Part { file: "broken.wgsl", source: "// first\n// second\nconst x: f32 = y;\n".into() };
        let parts = vec![part!("ray.wgsl"), broken, part!("film.wgsl")];
        let message = validate(&Kernel { entry_point: "none", parts }).unwrap_err();
        assert!(message.contains("broken.wgsl:3:"), "{message}");
    }

    #[test]
    fn every_shader_file_is_used_short_and_listed() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
        let readme = std::fs::read_to_string(folder.join("README.md")).unwrap();
        let kernels = all_kernels();
        let used: BTreeSet<&str> =
            kernels.iter().flat_map(|k| k.parts.iter().map(|p| p.file)).collect();
        let files: BTreeSet<String> = std::fs::read_dir(&folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|name| name.ends_with(".wgsl"))
            .collect();
        assert_eq!(used, files.iter().map(String::as_str).collect());
        for file in &files {
            assert!(
                readme.contains(&format!("`{file}`")),
                "shaders/README.md does not list {file}"
            );
            let lines = std::fs::read_to_string(folder.join(file)).unwrap().lines().count();
            assert!(lines <= 100, "{file} has {lines} lines; one idea per file");
        }
    }

    /// A part with a twin says where it is.
    #[test]
    fn twins_exist() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut twins = 0;
        for part in all_kernels().iter().flat_map(|kernel| &kernel.parts) {
            let twin =
                part.source.lines().find(|line| line.contains("win: ") || line.contains("win of "));
            let Some(line) = twin else { continue };
            let words = line.split([' ', ',', '`']).map(|word| word.trim_end_matches('.'));
            for path in words.filter(|word| word.starts_with("src/")) {
                assert!(root.join(path).exists(), "{}: {path} is missing", part.file);
                twins += 1;
            }
        }
        assert!(twins > 10, "{twins}");
    }
}
