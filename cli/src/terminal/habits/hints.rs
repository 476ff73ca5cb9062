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
    (&["ambient-occlusion", "ssao"], "--style default has it; --ao N takes N rays for it"),
    (&["fog", "depth-cue", "depthcue"], "--set studio.depth_cue={} fades colors with distance"),
    (&["no-outline", "no-outlines"], "--style fast has none; styles in scene files may leave out [studio.outline]"),
    (&["crop", "trim", "autocrop"], "--margin 0 leaves no space around; --focus EXPRESSION frames a part"),
    (&["wrap", "unwrap"], "positions are drawn as they are in the file; --replicate faces moves them into the cell"),
    (&["point-size", "point-radius"], "--radius sets the radius of all spheres, and --radius-scale a factor"),
    (
        &["chain", "resname", "residue", "resid", "element", "segid", "atoms"],
        "--select EXPRESSION keeps a part, such as --select 'chain A and resname HEM'",
    ),
    (
        &["representation", "rep", "draw-style", "drawing-method"],
        "--show STYLE says how spheres are drawn, such as --show sticks; --show 'SELECTION = STYLE' a part",
    ),
    (&["polyhedra", "isosurface", "mesh"], "only spheres, cylinders and cones are drawn; --show balls joins neighbors"),
    (
        &["labels", "label-atoms", "atom-labels"],
        "--label TEXT writes a text; [[labels]] in a scene file also says where",
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
        "perspective" => Hint::Flag("camera", "pinhole".to_owned()),
        name => match name.strip_prefix("color-by-").or(name.strip_prefix("colour-by-")) {
            Some(column) => Hint::Flag("color-by", column.to_owned()),
            None if ShowStyle::of_name(name).is_some() => Hint::Flag("show", name.to_owned()),
            None => Hint::None,
        },
    }
}
