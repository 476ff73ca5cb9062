//! Flags that other programs have: what they are here, or what to type in their place.

use pinhole_data::show::ShowStyle;

/// The meaning of a flag that the program does not have.
pub(super) enum Hint {
    /// Another flag with a value.
    Flag(&'static str, String),
    /// Words that say what to type.
    Say(&'static str),
    None,
}

/// Flags of other programs, and words that say what to type.
const SAID: &[(&[&str], &str)] = &[
    (
        &["rotate", "rotation", "azimuth", "elevation", "rot"],
        "--view AZIMUTH,ELEVATION in degrees says from where, such as --view 30,20",
    ),
    (&["quality"], "--samples N takes more rays for each pixel, and --style chooses how light is computed"),
    (&["shadows", "shadow"], "--style studio has soft shadows"),
    (&["light", "light-direction", "lights"], "--style chooses the light; [[lights]] in a scene file say where it is"),
    (&["ambient-occlusion", "ssao"], "--style default has it; --ao N takes N rays for it"),
    (
        &["fog", "depth-cue", "depthcue"],
        "colors fade with distance with --set studio.depth_cue={} alone; leave it out for none",
    ),
    (&["no-outline", "no-outlines"], "--style fast has none; styles in scene files may leave out [studio.outline]"),
    (&["crop", "trim", "autocrop"], "--margin 0 leaves no space around; --focus EXPRESSION frames a part"),
    (&["point-size", "point-radius"], "--radius sets the radius of all spheres, and --radius-scale a factor"),
    (
        &["radii", "atomic-radii", "radius-by-type", "radii-by-type"],
        "--radius R gives all spheres one, --radius-scale F multiplies them; --set 'elements.O.radius=0.5' is for a kind, \
         and with --set 'elements_by=[\"type\"]' for a type",
    ),
    (
        &["colors", "colours", "type-colors"],
        "--color-by COLUMN colors by data, --color CSS all alike; --set 'elements.O.color=\"red\"' is for a kind",
    ),
    (
        &["chain", "resname", "residue", "resid", "element", "segid", "atoms"],
        "--select EXPRESSION keeps a part, such as --select 'chain A and resname HEM'",
    ),
    (&["symbols", "elements"], "--select 'element C O' keeps these elements"),
    (
        &["index", "indices", "ids"],
        "--select 'index 48 49' keeps these spheres; --frame N and --frames 0:50:10 choose frames",
    ),
    (
        &["first", "last", "step", "start", "stop", "end", "stride", "skip"],
        "--frames FIRST:END:STEP chooses frames, without END itself",
    ),
    (&["hide-particles", "bonds-only"], "--show lines and --show sticks draw bonds without balls"),
    (
        &["bond-radius", "bond-width", "bond-thickness", "stick-radius", "linewidth", "line-width", "bond-color"],
        "--show 'sticks, radius=0.1, color=gray' says how sticks look; balls have stick=RADIUS between them",
    ),
    (
        &["cutoff", "bond-cutoff", "create-bonds", "max-bond"],
        "--bond-length LENGTH joins all spheres that are closer; --bonds FACTOR goes by covalent radii",
    ),
    (&["material"], "--opacity PART is for all spheres; --show 'SELECTION = spacefill, opacity=0.5' for a part"),
    (&["pbc"], "--box draws the cell, and --wrap moves spheres into it"),
    (&["cell-color", "box-color"], "--box WIDTH says how wide edges of the cell are; they have one color"),
    (
        &["slice-normal", "slice-distance", "clip-plane", "clipping"],
        "--slice z=3:9 keeps the spheres whose centers are between, and --select 'x + y < 5' any part",
    ),
    (&["arrow-scale", "vector-scale"], "--arrows VECTOR,scale=2 says how long arrows are"),
    (
        &["displacements", "displacement"],
        "columns of the file alone are drawn; --arrows NAME draws NAME.x, NAME.y and NAME.z",
    ),
    (
        &["ptm", "coordination", "centrosymmetry"],
        "structures are not analyzed; add a column to the file, which --color-by draws",
    ),
    (&["modifier", "modifiers"], "--select, --slice, --replicate, --wrap, --bonds and --color-by do what modifiers do"),
    (&["renderer"], "all pictures are ray traced; --style chooses the light, and --backend the device"),
    (&["display", "projection"], "--camera orthographic and --camera pinhole say how space is seen"),
    (&["grid", "montage", "layout"], "a picture shows one file; `magick montage a.png b.png ab.png` joins pictures"),
    (&["polyhedra", "isosurface", "mesh"], "only spheres, cylinders and cones are drawn; --show balls joins neighbors"),
    (
        &["labels", "label-atoms", "atom-labels"],
        "texts at atoms are not drawn; --label TEXT writes a text at a place of the picture",
    ),
    (&["hydrogens"], "--hide hydrogen leaves them out; they are drawn otherwise"),
    (&["color-scheme", "coloring"], "--color-by COLUMN colors by a column, such as chain or element"),
];

/// Returns the meaning of a flag. `has_show` is true where `--show` can be given.
pub(super) fn of(name: &str, has_show: bool) -> Hint {
    if let Some((_, words)) = SAID.iter().find(|(names, _)| names.contains(&name)) {
        return Hint::Say(words);
    }
    if !has_show {
        return Hint::None;
    }
    match name {
        "no-water" | "no-waters" => Hint::Flag("hide", "water".to_owned()),
        "no-hydrogens" | "no-hydrogen" | "no-h" => Hint::Flag("hide", "hydrogen".to_owned()),
        "wrap" => Hint::Flag("replicate", "wrap".to_owned()),
        "unwrap" | "whole" => Hint::Flag("replicate", "whole".to_owned()),
        "boundary-atoms" | "periodic-images" => Hint::Flag("replicate", "faces".to_owned()),
        "no-bonds" => Hint::Flag("show", "spacefill".to_owned()),
        "orthographic" | "parallel" | "ortho" => Hint::Flag("camera", "orthographic".to_owned()),
        "perspective" => Hint::Flag("camera", "pinhole".to_owned()),
        name => match name.strip_prefix("color-by-").or(name.strip_prefix("colour-by-")) {
            Some(column) => Hint::Flag("color-by", column.to_owned()),
            None if ShowStyle::of_name(name).is_some() => Hint::Flag("show", name.to_owned()),
            None => Hint::None,
        },
    }
}
