//! Tests that kernels and the host use the same constants. naga evaluates the constants of the composed kernels.

use std::collections::{BTreeMap, BTreeSet};

use naga::{Expression, Handle, Literal, Module};

use super::all_sources;
use crate::accel::grid::{LAST, word};
use crate::accel::wide_tree::{LEAF_COUNT_SHIFT, LEAF_FIRST, WideNode};
use crate::accel::{self};
use crate::camera::CameraKind;
use crate::gpu::host::composite;
use crate::gpu::passes::{emitter_table, lit, tiles};
use crate::gpu::shader::records;
use crate::image::NO_ID;
use crate::image::color::LUMINANCE;
use crate::light::codes;
use crate::verify::cone;

/// The bits of each component of a constant.
type Bits = Vec<u32>;

/// The constants that kernels and host share, with their names in WGSL.
fn of_the_host() -> Vec<(&'static str, Bits)> {
    let vectors = |bytes: usize| (bytes / size_of::<[u32; 4]>()) as u32;
    let words = [
        ("NO_ID", NO_ID),
        ("WORKGROUP_SIDE", tiles::WORKGROUP_SIDE),
        ("PINHOLE", CameraKind::Pinhole as u32),
        ("ORTHOGRAPHIC", CameraKind::Orthographic as u32),
        ("THIN_LENS", CameraKind::ThinLens as u32),
        ("PANORAMA", CameraKind::Panorama as u32),
        ("FISHEYE", CameraKind::Fisheye as u32),
        ("KIND", word::KIND),
        ("AS_STORED", composite::AS_STORED),
        ("TO_LINEAR", composite::TO_LINEAR),
        ("TO_SRGB", composite::TO_SRGB),
        ("EMPTY", word::EMPTY),
        ("LIST", word::LIST),
        ("GRID", word::GRID),
        ("REACH", word::REACH),
        ("REACH_BITS", word::REACH_BITS),
        ("LEVEL", word::LEVEL),
        ("LEVEL_SHIFT", word::LEVEL_SHIFT),
        ("INNER_START", word::INNER_START),
        ("INNER_UNIT", word::INNER_UNIT),
        ("SHAPE_INDEX", !LAST),
        ("LAST_BALL", LAST),
        ("BALLS_PER_VECTOR", accel::ball::BALLS_PER_VECTOR as u32),
        ("CAPSULES_PER_VECTOR", accel::CAPSULES_PER_VECTOR as u32),
        ("COORDINATE_BITS", accel::ball::COORDINATE_BITS),
        ("RADIUS", accel::ball::RADIUS),
        ("RADIUS_TO_FLOAT", accel::ball::RADIUS_TO_FLOAT),
        ("LEAF_FIRST", LEAF_FIRST),
        ("LEAF_COUNT_SHIFT", LEAF_COUNT_SHIFT),
        ("WIDE_LEVELS", accel::wide_tree::WIDE_LEVELS),
        ("WIDE_NODE_VECTORS", vectors(size_of::<WideNode>())),
        ("LIGHTING_TRANSPARENT", codes::lighting::TRANSPARENT),
        ("LIGHTING_SKY_SEEN", codes::lighting::SKY_SEEN),
        ("LIGHTING_SHADOWS", codes::lighting::SHADOWS),
        ("LIGHTING_GROUND", codes::lighting::GROUND),
        ("LIGHTING_CATCHER", codes::lighting::CATCHER),
        ("LAMBERT", codes::material::LAMBERT),
        ("CONDUCTOR", codes::material::CONDUCTOR),
        ("DIELECTRIC", codes::material::DIELECTRIC),
        ("EMISSIVE", codes::material::EMISSIVE),
        ("LAMP_HEAD", codes::lamp::HEAD),
        ("LAMP_DIRECTIONAL", codes::lamp::DIRECTIONAL),
        ("LAMP_POINT", codes::lamp::POINT),
        ("LAMP_SPHERE", codes::lamp::SPHERE),
        ("EMITTER_COLUMNS", emitter_table::COLUMNS as u32),
        ("EMITTER_ROWS", emitter_table::ROWS as u32),
        ("LIGHT_CHANCE", codes::sampling::CHANCE),
        ("LIGHT_DIRECT", codes::sampling::DIRECT),
        ("LIGHT_MULTIPLE", codes::sampling::MULTIPLE),
        ("PATH_ALIVE", codes::path::ALIVE),
        ("PATH_INSIDE", codes::path::INSIDE),
        ("PATH_ON_GROUND", codes::path::ON_GROUND),
        ("PATH_FULL", codes::path::FULL),
        ("PATH_SCATTERED", codes::path::SCATTERED),
        // The last slot of each kind of path. The host defines the numbers of slots.
        ("HIT", lit::records::COMMON_SLOTS as u32 - 1),
        ("PENDING", lit::records::LIGHT_SLOTS as u32 - 1),
        ("MEDIUM", lit::records::MEDIUM_SLOTS as u32 - 1),
        ("LOBE", lit::records::STUDIO_SLOTS as u32 - 1),
        ("LIST_OF_LIGHT", lit::records::LIST_OF_LIGHT),
        ("ENERGIES", crate::light::energy::ENTRIES as u32),
    ];
    let floats = [
        ("NO_HIT", records::NO_HIT),
        ("SMALLEST_COMPONENT", accel::slab::SMALLEST_COMPONENT),
        ("FAR", cone::FAR),
        ("LEAST_RISE", cone::LEAST_RISE),
        ("LEAST_SQUARE", cone::LEAST_SQUARE),
        ("LEAST_LENGTH", cone::LEAST_LENGTH),
        ("NOT_ROUND", cone::NOT_ROUND),
        ("PI", std::f32::consts::PI),
        ("QUANTA", accel::ball::QUANTA),
    ];
    words
        .into_iter()
        .chain(floats.map(|(name, value)| (name, value.to_bits())))
        .map(|(name, bits)| (name, vec![bits]))
        .chain([("LUMINANCE", LUMINANCE.map(|weight| (weight as f32).to_bits()).to_vec())])
        .collect()
}

/// Constants that only kernels use, and the shadings, which a test in `records.rs` compares.
const OF_KERNELS_ALONE: &[&str] = &[
    "NO_SHAPE",
    // Balls or capsules, which are both compared.
    "IN_VECTOR",
    "LEAST_SQUARE_SPAN",
    "WIDE_ROOT",
    "NO_LIST",
    "AT_ONCE",
    "COORDINATE",
    "ONE",
    "NO_PATH",
    "SHADING_FLAT",
    "SHADING_HEADLIGHT",
    "SHADING_TRANSPARENT",
    "NOTHING",
    "SAME_VIEW",
    "SMALLEST_SPOT",
    // The reference has this constant in f64.
    "NO_NOISE",
    // Slots of a path's state, and flags in it.
    "ORIGIN",
    "DIRECTION",
    "DEPARTURE",
    "THROUGHPUT",
    "RADIANCE",
    "FIRST",
    "SHADOW",
    "NORMAL",
    "NO_EMITTER",
    "ALBEDO",
    "PATH_BACK",
    // Kinds of hits, which decide the dispatch that shades a path.
    "OTHER_BRICK",
    "HIT_NOTHING",
    "HIT_GROUND",
    "HIT_SHAPE",
];

fn bits(module: &Module, expression: Handle<Expression>) -> Bits {
    match &module.global_expressions[expression] {
        Expression::Literal(Literal::U32(value)) => vec![*value],
        Expression::Literal(Literal::F32(value)) => vec![value.to_bits()],
        Expression::Compose { components, .. } => {
            components.iter().flat_map(|component| bits(module, *component)).collect()
        }
        other => panic!("{other:?} is not evaluated"),
    }
}

#[test]
fn constants_are_the_same_in_rust_and_wgsl() {
    let mut found: BTreeMap<String, BTreeSet<Bits>> = BTreeMap::new();
    for kernel in all_sources() {
        let module = naga::front::wgsl::parse_str(&kernel.source()).unwrap();
        for (_, constant) in module.constants.iter() {
            let name = constant.name.clone().unwrap();
            found.entry(name).or_default().insert(bits(&module, constant.init));
        }
    }
    let of_the_host = of_the_host();
    for (name, expected) in &of_the_host {
        assert_eq!(found.get(*name), Some(&BTreeSet::from([expected.clone()])), "{name}");
    }
    let known: BTreeSet<&str> =
        of_the_host.iter().map(|(name, _)| *name).chain(OF_KERNELS_ALONE.iter().copied()).collect();
    assert_eq!(found.keys().map(String::as_str).collect::<BTreeSet<_>>(), known);
}
