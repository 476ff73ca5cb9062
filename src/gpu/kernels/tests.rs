//! Tests of all kernels that need no device.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use naga::valid::{Capabilities, ValidationFlags, Validator};

use super::declarations::Declarations;
use super::{all_kernels, all_sources};
use crate::gpu::shader::fold::folded_module;
use crate::gpu::shader::{Kernel, Part, variants};

fn validate(kernel: &Kernel) -> Result<naga::Module, String> {
    let source = kernel.source();
    let readable = |message: String| kernel.with_positions_in_files(&message);
    let module = naga::front::wgsl::parse_str(&source).map_err(|error| readable(error.emit_to_string(&source)))?;
    validator(kernel.has_ray_queries()).validate(&module).map_err(|error| readable(error.emit_to_string(&source)))?;
    Ok(module)
}

fn validator(has_ray_queries: bool) -> Validator {
    // Kernels without ray queries may use only the core features of WebGPU.
    let capabilities = match has_ray_queries {
        true => Capabilities::RAY_QUERY,
        false => Capabilities::empty(),
    };
    Validator::new(ValidationFlags::all(), capabilities)
}

/// Maximum number of kernel sources. A change may lower it: kernels differ in `override` constants, unless the
/// difference is a type, a directive or a binding. The last are for lists of tiles,
/// which have no structure, and for cones: their test, eight searches by lists,
/// grids and trees and one by tiles with what records or goes on, the shading of each target, and light: four searches
/// by each of four structures, the surfaces of a studio, and scattering under both kinds of sky.
const MOST_SOURCES: usize = 124;

/// The parts with entry points of render passes.
const RENDERED: [&str; 3] = ["host/composite.wgsl", "host/cover.wgsl", "host/overlay.wgsl"];

#[test]
fn every_kernel_composes_and_validates() {
    let kernels = all_sources();
    assert!(kernels.len() <= MOST_SOURCES, "{} sources", kernels.len());
    for kernel in kernels {
        let module = validate(&kernel).unwrap_or_else(|error| panic!("{}: {error}", kernel.name()));
        let entry = &module.entry_points[0];
        assert_eq!(module.entry_points.len(), 1, "{}", kernel.name());
        assert_eq!(entry.name, kernel.entry_point);
        // Kernels of render passes have no workgroups.
        let is_compute = entry.stage == naga::ShaderStage::Compute;
        assert!(is_compute != kernel.parts.iter().any(|part| RENDERED.contains(&part.name)));
        let size = entry.workgroup_size.iter().product::<u32>();
        // A lane of a tile takes four pixels.
        let pixels_of_lane = if entry.name == "trace_tile" { 4 } else { 1 };
        assert_eq!(size * pixels_of_lane, if is_compute { 64 } else { 0 });
    }
}

/// wgpu refuses a value for a constant that a source does not declare, and a constant without a value. It inserts
/// values only when a driver needs the pipeline, so the `noop` device does not show whether the result is valid.
#[test]
fn every_pipeline_has_the_constants_that_its_source_declares() {
    let mut sources = BTreeMap::new();
    for kernel in all_kernels() {
        let (module, info) = sources.entry(kernel.name()).or_insert_with(|| {
            let module = naga::front::wgsl::parse_str(&kernel.source()).unwrap();
            let info = validator(kernel.has_ray_queries()).validate(&module).unwrap();
            (module, info)
        });
        let overrides = module.overrides.iter().filter_map(|(_, found)| found.name.as_deref());
        let declared: BTreeSet<&str> = overrides.collect();
        let given: BTreeSet<&str> = kernel.constants.iter().map(|(name, _)| *name).collect();
        let name = kernel.name();
        assert_eq!((&given, given.len()), (&declared, kernel.constants.len()), "{name}");
        // Kernels of render passes have no constants.
        if module.entry_points[0].stage == naga::ShaderStage::Compute {
            let values = kernel.values_of_constants();
            let folded = folded_module(module, info, kernel.entry_point, &values);
            let folded = folded.unwrap_or_else(|| panic!("{name} {values:?}"));
            validator(kernel.has_ray_queries())
                .validate(&folded)
                .unwrap_or_else(|error| panic!("{name} {values:?}: {error:?}"));
        }
    }
}

/// Names of kernels are file names of `pinhole info --dump-shaders` and labels in messages, so they must be unique.
#[test]
fn no_two_kernels_have_the_same_name() {
    let mut sources = BTreeMap::new();
    for kernel in all_kernels() {
        let source = kernel.source();
        let before = sources.insert(kernel.name(), source.clone());
        assert!(before.is_none_or(|before| before == source), "{}", kernel.name());
    }
}

/// Tests that every kernel calls `start_fences`, because a compiler knows the value of a zero that was never set.
#[test]
fn every_kernel_sets_what_fences_need() {
    let uses_frame = |kernel: &Kernel| kernel.parts.iter().any(|part| part.name == "scene/frame.wgsl");
    for kernel in all_sources().iter().filter(|kernel| uses_frame(kernel)) {
        let source = kernel.source();
        let entry = source.split(&format!("fn {}(", kernel.entry_point)).nth(1).unwrap();
        let first = entry.lines().nth(1).unwrap();
        assert_eq!(first.trim(), "start_fences();", "{}", kernel.name());
    }
}

/// Parts pass data by arguments: no part reads or writes a private variable of another.
#[test]
fn no_part_uses_a_private_variable_of_another() {
    for kernel in all_sources() {
        let parts: Vec<_> = kernel.parts.iter().map(|part| (part, Declarations::of(&part.source))).collect();
        for (owner, declared) in &parts {
            for variable in &declared.private_variables {
                let others = parts.iter().filter(|(part, _)| part.name != owner.name);
                for (part, other) in others {
                    assert!(!other.used.contains(variable), "{} uses {variable}", part.name);
                }
            }
        }
    }
}

#[test]
fn an_error_names_the_file_and_its_line() {
    let broken = Part::of("broken.wgsl", "// first\n// second\nconst x: f32 = y;\n");
    let parts = vec![Part::named("camera/ray.wgsl"), broken, Part::named("camera/film.wgsl")];
    let refused = |parts| validate(&Kernel { entry_point: "none", parts, constants: vec![] }).unwrap_err();
    let message = refused(parts);
    assert!(message.contains("broken.wgsl:3:"), "{message}");
    let file = "// Head.\n\n//// a\nconst x: f32 = 1.0;\n//// b\n\nconst x: f32 = y;\n";
    let parts = vec![Part::named("camera/ray.wgsl"), Part::of("broken.wgsl#b", file)];
    let message = refused(parts);
    assert!(message.contains("broken.wgsl:7:"), "{message}");
}

/// The paths of all files in the folder `shaders`.
pub(super) fn files() -> BTreeMap<String, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut found = BTreeMap::new();
    for folder in std::fs::read_dir(&root).unwrap() {
        let folder = folder.unwrap().path();
        if !folder.is_dir() {
            continue;
        }
        for file in std::fs::read_dir(folder).unwrap() {
            let path = file.unwrap().path();
            let name = path.strip_prefix(&root).unwrap().to_str().unwrap().replace('\\', "/");
            found.insert(name, std::fs::read_to_string(&path).unwrap());
        }
    }
    found
}

#[test]
fn every_file_and_variant_is_used_and_short() {
    let kernels = all_sources();
    let used: BTreeSet<String> = kernels.iter().flat_map(|k| k.parts.iter().map(|p| p.name.to_owned())).collect();
    let mut there = BTreeSet::new();
    for (file, text) in files() {
        let lines = text.lines().count();
        assert!(lines <= 105, "{file} has {lines} lines; one idea per file");
        let variants: Vec<_> = variants(&text).map(|(name, ..)| format!("{file}#{name}")).collect();
        there.extend(if variants.is_empty() { vec![file] } else { variants });
    }
    assert_eq!(used, there);
}

/// The twins that parts name must exist.
#[test]
fn twins_exist() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut twins = 0;
    for (file, text) in files() {
        for line in text.lines().filter(|line| line.contains("win: ") || line.contains("win of ")) {
            let words = line.split([' ', ',', '`']).map(|word| word.trim_end_matches('.'));
            for path in words.filter(|word| word.starts_with("src/")) {
                assert!(root.join(path).exists(), "{file}: {path} is missing");
                twins += 1;
            }
        }
    }
    assert!(twins > 10, "{twins}");
}
