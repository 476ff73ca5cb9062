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
        &["rotate", "rotation", "rotations", "azimuth", "elevation", "azim", "elev", "rot"],
        "--view AZIMUTH,ELEVATION in degrees says from where, such as --view 30,20",
    ),
    (&["quality"], "--samples N takes more rays for each pixel, and --style chooses how light is computed"),
    (&["shadows", "shadow"], "--style studio has soft shadows"),
    (&["light", "light-direction", "lights"], "--style chooses the light; [[lights]] in a scene file say where it is"),
    (&["ambient-occlusion", "ssao"], "--style default has it; --ao N takes N rays for it"),
    (
        &["fog", "depth-cue", "depthcue", "depthcueing"],
        "colors fade with distance with --set studio.depth_cue={} alone; leave it out for none",
    ),
    (
        &["crop", "trim", "autocrop"],
        "--margin 0 leaves no space around; --focus EXPRESSION frames a part, and --select 'x > -1 and x < 1' keeps a part",
    ),
    (&["point-size", "point-radius"], "--radius sets the radius of all spheres, and --radius-scale a factor"),
    (
        &["radii", "atomic-radii", "radius-by-type", "radii-by-type"],
        "--radius R gives all spheres one, --radius-scale F multiplies them; --set 'elements.O.radius=0.5' is for a kind, \
         and with --set 'elements_by=[\"type\"]' for a type",
    ),
    (
        &["colors", "colours", "type-color", "type-colors", "type-colours", "color-type"],
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
        "--show 'sticks, radius=0.1, color=gray' says how sticks look, and --show 'trace, radius=0.1' a tube; balls have \
         stick=RADIUS between them",
    ),
    (
        &["cutoff", "bond-cutoff", "create-bonds", "max-bond"],
        "--bond-length LENGTH joins all spheres that are closer; --bonds FACTOR goes by covalent radii",
    ),
    (
        &["material"],
        "surfaces are matte; --style chooses the light, --opacity PART makes all clear, and [materials] in a scene file names \
         others",
    ),
    (&["transparency", "translucency"], "--opacity 0.5 says how opaque spheres are, from 0 to 1"),
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
        &[
            "ptm",
            "cna",
            "coordination",
            "centrosymmetry",
            "structure-type",
            "structure-types",
            "polyhedral-template-matching",
        ],
        "structures are not analyzed; add a column to the file, which --color-by draws",
    ),
    (&["modifier", "modifiers"], "--select, --slice, --replicate, --wrap, --bonds and --color-by do what modifiers do"),
    (
        &["renderer"],
        "all pictures are ray traced, so leave it out; --style chooses the light, and --backend the device",
    ),
    (
        &["display"],
        "--camera orthographic and --camera pinhole say how space is seen; --set studio.depth_cue={} fades with distance",
    ),
    (
        &["viewport"],
        "--view front, top or left says from where, and --camera orthographic or pinhole how space is seen",
    ),
    (&["movie"], "--turntable 36 -o movie.mp4 turns the data once, and -o movie.mp4 alone shows its frames"),
    (
        &["timestep-label", "time-label", "frame-label"],
        "texts that change from frame to frame are not drawn; --label TEXT writes the same in all",
    ),
    (
        &["ray-opaque-background", "opaque-background", "ray-opaque"],
        "--transparent leaves out the background; pictures have one otherwise",
    ),
    (
        &["threshold", "clip-box", "bounds"],
        "--slice x=-1:1 keeps what is between, and --select 'x > -1 and charge < 0.5' any part",
    ),
    (
        &["glyph", "glyphs", "scale-array"],
        "points are spheres; --radius-by COLUMN gives them radii, and --arrows VECTOR arrows",
    ),
    (
        &["spin", "orbit", "rotate-movie", "turn-table", "animate", "rotating"],
        "--turntable N -o movie.mp4 turns the data once in N pictures; --fps says how fast",
    ),
    (
        &["duration", "length", "loop"],
        "--turntable N or --frames say how many pictures there are, and --fps how fast; movies repeat",
    ),
    (&["force", "overwrite", "clobber", "yes"], "-o replaces a picture that is there; leave it out"),
    (
        &["verbose", "debug"],
        "what the program does is always said; --profile says where time goes, and --quiet says less",
    ),
    (&["dry-run", "estimate"], "`pinhole plan FILE` says what a picture needs, and --print-scene what would be drawn"),
    (
        &["list-colormaps", "list-cmaps", "colormaps"],
        "--cmap takes viridis, plasma, inferno, magma, cividis, batlow, jet, coolwarm, hot, tab10 and more; a wrong name lists all",
    ),
    (
        &["list-styles", "styles"],
        "--style takes default, fast, flat, studio, illustration, path or stars; --show what is drawn",
    ),
    (
        &["info", "list", "list-columns", "list-fields", "columns-of", "list-properties"],
        "`pinhole info FILE` says what a file holds, with its columns",
    ),
    (
        &["outdir", "output-dir", "out-dir", "directory"],
        "-o FOLDER/NAME.png names the picture; for each of several files: for f in *.xyz; do pinhole \"$f\"; done",
    ),
    (&["figsize", "fig-size"], "--size WIDTHxHEIGHT is in pixels, such as --size 1600x1200"),
    (
        &["plot", "scatter", "scatter3d", "plot-type"],
        "points are drawn as spheres, and a curve as a tube; leave it out",
    ),
    (
        &["trajectory-lines", "trails", "paths"],
        "paths over frames are not drawn; a table with the places of one sphere is drawn as a curve",
    ),
    (&["s"], "--radius R is in units of the data, and --radius-scale F multiplies radii"),
    (&["xlim", "ylim", "zlim"], "--slice x=0:10 keeps what is between, and y and z likewise"),
    (&["slice-width", "slab-width", "slice-thickness"], "--slice z=3:7 has both ends"),
    (&["invert", "invert-selection"], "--select 'not (EXPRESSION)' keeps the others"),
    (
        &["orient", "center-view", "reset-view", "zoom-to-fit", "fit", "complete"],
        "pictures frame what they show; leave it out",
    ),
    (&["bond-order", "bond-orders", "double-bonds"], "bonds are drawn as single sticks; leave it out"),
    (&["delaunay", "mesh-points", "triangulate"], "points are spheres, and not meshed; --radius R makes them touch"),
    (&["util.cbc", "cbc", "color-by-chains"], "--color chain colors by chain"),
    (&["util.cnc", "cnc"], "--color element colors by element; --show 'all = sticks, carbon=chain' carbon by chain"),
    (&["background-gradient"], "--background COLOR is one color, such as white"),
    (&["subsample", "sample", "decimate"], "--select 'index % 10 == 0' keeps every tenth"),
    (&["atom-style"], "the style of a LAMMPS file stands after its word `Atoms`, as in `Atoms # full`"),
    (&["edl", "lighting"], "--style default has shadows in pockets, and --style illustration lines"),
    (&["x", "y", "z"], "--columns names the columns of a table, such as --columns x,y,z"),
    (
        &["layers"],
        "--slice z=LOW:HIGH keeps a layer, --replicate repeats the cell, and --layer NAME=FILE writes data of pixels",
    ),
    (
        &["grid", "layout", "montage", "side-by-side", "subplots"],
        "a picture shows one file; `magick montage a.png b.png ab.png` joins pictures",
    ),
    (&["polyhedra", "isosurface", "mesh"], "only spheres, cylinders and cones are drawn; --show balls joins neighbors"),
    (
        &["labels", "label-atoms", "atom-labels"],
        "texts at atoms are not drawn; --label TEXT writes a text at a place of the picture",
    ),
    (&["hydrogens"], "--hide hydrogen leaves them out; they are drawn otherwise"),
    (&["color-scheme", "coloring"], "--color-by COLUMN colors by a column, such as chain or element"),
];

/// The words about a setting of `PyMOL`, which say what to type.
pub(super) fn of_setting(key: &str) -> Option<&'static str> {
    Some(match key {
        "stick_radius" => {
            "--show 'sticks, radius=0.3' says how thick sticks are, and --show 'balls, stick=0.1' between balls"
        }
        "sphere_scale" => "--radius-scale F multiplies radii",
        "sphere_transparency" | "transparency" | "stick_transparency" => "--opacity 0.5 says how opaque spheres are",
        "ray_opaque_background" | "opaque_background" => "--transparent leaves out the background",
        "bg_color" | "bg_rgb" => "--background COLOR is that behind the data",
        "orthoscopic" | "ortho" => "--camera orthographic",
        "antialias" => "--samples N takes more rays for each pixel",
        _ => return None,
    })
}

/// Returns the meaning of a flag. `has_show` is true where `--show` can be given.
pub(super) fn of(name: &str, has_show: bool) -> Hint {
    if let Some((_, words)) = SAID.iter().find(|(names, _)| names.contains(&name)) {
        return Hint::Say(words);
    }
    if !has_show {
        return Hint::None;
    }
    match name {
        "no-water" | "no-waters" | "hide-water" | "hide-waters" | "remove-water" => {
            Hint::Flag("hide", "water".to_owned())
        }
        "no-hydrogens" | "no-hydrogen" | "no-h" | "hide-hydrogens" | "hide-hydrogen" => {
            Hint::Flag("hide", "hydrogen".to_owned())
        }
        "hide-cell" | "hide-box" | "hide-unit-cell" => Hint::Flag("box", "false".to_owned()),
        "no-outline" | "no-outlines" => Hint::Flag("outline", "0".to_owned()),
        "wrap" => Hint::Flag("replicate", "wrap".to_owned()),
        "unwrap" | "whole" => Hint::Flag("replicate", "whole".to_owned()),
        "boundary-atoms" | "periodic-images" => Hint::Flag("replicate", "faces".to_owned()),
        "no-particles" | "no-spheres" | "no-atoms" => Hint::Flag("show", "sticks".to_owned()),
        "no-bonds" => Hint::Flag("show", "spacefill".to_owned()),
        "orthographic" | "parallel" | "ortho" | "parallel-projection" | "orthoscopic" => {
            Hint::Flag("camera", "orthographic".to_owned())
        }
        "perspective" => Hint::Flag("camera", "pinhole".to_owned()),
        name => match name.strip_prefix("color-by-").or(name.strip_prefix("colour-by-")) {
            Some(column) => Hint::Flag("color-by", column.to_owned()),
            None if ShowStyle::of_name(name).is_some() || name == "surface" => Hint::Flag("show", name.to_owned()),
            None => Hint::None,
        },
    }
}
