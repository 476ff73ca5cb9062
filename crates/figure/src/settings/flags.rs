//! The flags that reach settings. A flag is a row: its name, the key that it gives, what its value is, how the help shows
//! the value, and its help.

use pinhole::camera::CameraKind;
use pinhole_data::kind::Kind;
use pinhole_data::load::{FORMATS, Format};

use super::layers::Layer;
use super::words;
use crate::style::Style;

/// What a flag decides, which is also the part of the help in which it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Group {
    /// Which file is read, and how.
    Input = 1,
    /// Selection, cell, bonds and arrows.
    Structure = 2,
    /// Colours, radii and opacities from data.
    Color = 4,
    /// Light and style.
    Look = 8,
    /// The camera.
    Camera = 16,
    /// What is drawn over the picture.
    Annotation = 32,
    /// How the picture is written.
    Output = 64,
}

/// What the value of a flag is.
#[derive(Clone, Copy, Debug)]
pub enum Value {
    /// A number.
    Number,
    /// A whole number.
    Whole,
    /// A text.
    Text,
    /// `true` or `false`.
    Switch,
    /// A list of this many numbers, with commas between them.
    Numbers(usize),
    /// One of some names, each with its help.
    OneOf(fn() -> Vec<(&'static str, &'static str)>),
    /// Words of its own, which this turns into a value of TOML.
    Words(fn(&str) -> Result<String, String>),
    /// Words of its own, which this turns into keys and values of TOML.
    Keys(fn(&str) -> Result<String, String>),
}

/// A flag that reaches settings.
#[derive(Clone, Copy, Debug)]
pub struct Flag {
    /// The flag, with its dashes.
    pub flag: &'static str,
    /// The key that it gives. In `camera.*.eye`, the star stands for the kind of the camera.
    pub key: &'static str,
    /// What its value is.
    pub value: Value,
    /// How the help shows the value.
    pub shown: &'static str,
    /// The help.
    pub help: &'static str,
    /// What the flag decides.
    pub group: Group,
    /// The value of the flag alone. Flags without one need a value.
    pub alone: Option<&'static str>,
}

impl Flag {
    /// The name, without dashes.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.flag.trim_start_matches('-')
    }

    /// Returns true if the flag may be given several times.
    #[must_use]
    pub fn is_list(&self) -> bool {
        matches!(self.flag, "--label" | "--set" | "--show" | "--hide" | "--ghost" | "--define")
    }

    /// The flag of this name, without dashes.
    #[must_use]
    pub fn of_name(name: &str) -> Option<&'static Self> {
        FLAGS.iter().find(|flag| flag.name() == name)
    }

    /// The settings that the flag gives with this value, for a camera of this kind.
    ///
    /// # Errors
    /// Says in words what the value must be.
    pub fn layer(&self, value: &str, camera: &str) -> Result<Layer, String> {
        let value = match self.value {
            Value::Number => words::number(value)?,
            Value::Whole => words::whole(value)?,
            Value::Text | Value::OneOf(_) => words::text(value),
            Value::Switch => words::switch(value)?,
            Value::Numbers(count) => words::numbers(value, count)?,
            Value::Words(read) => read(value)?,
            Value::Keys(read) => return Ok(Layer { flag: self.flag, text: read(value)? }),
        };
        // The kind of the camera is the name of its table.
        if self.key == "camera" {
            return Ok(Layer { flag: self.flag, text: format!("camera.{camera} = {{}}") });
        }
        let key = self.key.replace('*', camera);
        Ok(Layer { flag: self.flag, text: format!("{key} = {value}") })
    }
}

fn styles() -> Vec<(&'static str, &'static str)> {
    Style::ALL.iter().map(|style| (style.name(), "")).collect()
}

fn formats() -> Vec<(&'static str, &'static str)> {
    FORMATS.iter().map(|Format { name, about, .. }| (*name, *about)).collect()
}

fn kinds() -> Vec<(&'static str, &'static str)> {
    Kind::ALL.iter().map(|kind| (kind.name(), "")).collect()
}

fn cameras() -> Vec<(&'static str, &'static str)> {
    CameraKind::ALL.iter().map(|kind| (kind.name(), "")).collect()
}

fn integrators() -> Vec<(&'static str, &'static str)> {
    vec![
        ("primary", "No light: the color of the first sphere that the ray through the center of a pixel hits"),
        ("studio", "Direct light from lights to surfaces: shadows, ambient occlusion, opacity, outlines"),
        ("path", "Path tracing: light is followed as surfaces scatter it"),
    ]
}

fn filters() -> Vec<(&'static str, &'static str)> {
    vec![("box", ""), ("gaussian", ""), ("blackman-harris", "")]
}

fn panels() -> Vec<(&'static str, &'static str)> {
    vec![("auto", "Where the picture behind is mixed"), ("always", "Everywhere"), ("never", "Nowhere")]
}

fn tones() -> Vec<(&'static str, &'static str)> {
    vec![
        ("none", "No curve: brighter light is clipped"),
        ("filmic", "A curve like that of film, for red, green and blue separately"),
        ("agx", "AgX: strong colors turn white"),
    ]
}

/// Flags that exclude others.
pub const EXCLUSIVE: &[(&str, &[&str])] =
    &[("--view", &["--eye", "--look-at", "--direction"]), ("--turn", &["--eye"]), ("--bond-length", &["--bonds"])];

macro_rules! flags {
    ($($group:ident { $($flag:literal $key:literal, $value:expr, $shown:literal $(($alone:literal))?, $help:literal;)+ })+) => {
        /// All flags, group by group. Those of a group take precedence over those before it.
        pub const FLAGS: &[Flag] = &[$($(Flag {
            flag: $flag,
            key: $key,
            value: $value,
            shown: $shown,
            help: $help,
            group: Group::$group,
            alone: flags!(@alone $($alone)?),
        },)+)+];
    };
    (@alone) => { None };
    (@alone $alone:literal) => { Some($alone) };
}

use Value::{Keys, Number, Numbers, OneOf, Switch, Text, Whole, Words};

flags! {
    Input {
        "--format" "format", OneOf(formats), "FORMAT",
            "Format of the data file, whatever its extension is";
        "--kind" "kind", OneOf(kinds), "KIND",
            "What the data is, which decides what is drawn, its colors and the view where no other flag does; `plain` leaves \
             the data as it is [default: follows from the data]";
        "--topology" "topology", Text, "FILE",
            "File that says what the spheres of a trajectory are, for formats that have positions alone";
        "--columns" "columns", Words(words::names), "NAMES",
            "Names of the columns of a table without a header, such as x,y,z,radius";
        "--radius" "radius", Number, "R",
            "Radius of all spheres, for atoms and data without radii";
        "--color" "color", Text, "CSS",
            "CSS color of all spheres, or a column as for --color-by [default: the data's, the scene's, or #cccccc]";
        "--frame" "frame", Words(words::frame), "N",
            "Frame of a trajectory, counted from 0, or last; negative numbers count from the end [default: the scene's, or 0]";
        "--size" "film.width", Keys(words::size), "WxH",
            "Width and height of the picture in pixels, such as 800x600, or the width of a picture that is three quarters as \
             high [default: the scene's, or 800x600]";
        "--set" "", Keys(words::set), "KEY=VALUE",
            "Give any key of a scene file a value, such as studio.occlusion.radius=5; takes precedence over all else, and \
             may be repeated";
    }
    Camera {
        "--camera" "camera", OneOf(cameras), "KIND",
            "Kind of the camera [default: pinhole]";
        "--eye" "camera.*.eye", Numbers(3), "X,Y,Z",
            "Position of the camera; without it, the camera frames the scene";
        "--look-at" "camera.*.look_at", Numbers(3), "X,Y,Z",
            "Point that the camera looks at";
        "--direction" "camera.*.direction", Numbers(3), "X,Y,Z",
            "Direction in which the camera looks, instead of --look-at [default without --eye: 0,0,-1]";
        "--view" "camera.*.view", Words(words::view), "VIEW",
            "Where the camera stands when it frames the scene: x, -x, y, -y, z, -z, iso, front, back, left, right, top, \
             bottom, or AZIMUTH,ELEVATION in degrees; xy, xz and yz show a plane straight on [default for data files: \
             30,20, or straight on where all spheres lie in one plane]";
        "--turn" "camera.*.turn", Number, "DEGREES",
            "Turn the camera about the direction that is up, by this angle in degrees; counter-clockwise seen from above";
        "--margin" "camera.*.margin", Words(words::part), "PART",
            "Free part of the picture on each side of a framed scene: 0.1 or 10% (pinhole, thin-lens, orthographic) \
             [default: 7.5%]";
        "--zoom" "camera.*.zoom", Number, "FACTOR",
            "Enlarge the picture about its middle (pinhole, thin-lens, orthographic)";
        "--up" "camera.*.up", Numbers(3), "X,Y,Z",
            "Direction that is up in the picture [default: 0,0,1 for LAMMPS, GSD and LAS files and 0,1,0 for others, or \
             another one in a view along it]";
        "--fov" "camera.*.vertical_fov", Number, "DEGREES",
            "Vertical field of view in degrees (pinhole, thin-lens) [default: 30]";
        "--distance" "camera.*.distance", Number, "D",
            "Distance from the eye to the view plane in scene units, with --half-extent (pinhole, thin-lens) [default: 1]";
        "--half-extent" "camera.*.half_extent", Numbers(2), "HX,HY",
            "Half width and half height of the view plane in scene units, instead of --fov (pinhole, thin-lens, \
             orthographic)";
        "--aperture-radius" "camera.*.aperture_radius", Number, "R",
            "Radius of the lens in scene units (thin-lens)";
        "--f-stop" "camera.*.f_stop", Number, "N",
            "F-number of the lens: focal length over diameter, with --focal-length, instead of --aperture-radius \
             (thin-lens)";
        "--focal-length" "camera.*.focal_length", Number, "F",
            "Focal length of the lens in scene units, used only to turn --f-stop into an aperture (thin-lens)";
        "--focus-distance" "camera.*.focus_distance", Number, "D",
            "Distance along the direction of view at which things are sharp, in scene units (thin-lens) [default: that of \
             --look-at, or of the middle of the scene]";
        "--focus-on" "camera.*.focus_on", Numbers(3), "X,Y,Z",
            "Point that is sharp, instead of --focus-distance (thin-lens)";
        "--angle" "camera.*.angle", Number, "DEGREES",
            "Full angle of view across the disk in degrees (fisheye) [default: 180]";
        "--separation" "camera.*.stereo.separation", Number, "S",
            "Distance between two eyes in scene units, which renders a stereo pair (pinhole, panorama); see --stereo";
        "--convergence" "camera.*.stereo.convergence", Number, "D",
            "Distance in scene units at which things appear at the depth of the screen, with --separation [default: \
             infinite]";
    }
    Structure {
        "--select" "select", Text, "EXPRESSION",
            "Render only the spheres for which an expression is true, such as 'protein and not hydrogen', 'name CA CB and \
             resid 5 to 10', 'byres within 5 of resname HEM' or 'species == O and z > 3 and |v| < 2': the words of VMD, \
             and columns as for --color-by";
        "--define" "selections", Keys(words::define), "NAME=EXPRESSION",
            "Give a selection a name, which other selections may use, such as 'pocket=byres within 5 of resname HEM'; may \
             be repeated";
        "--show" "show", Keys(words::show), "[EXPRESSION =] STYLE[, KEY=VALUE]...",
            "Draw the spheres for which an expression is true in a style, such as 'resname HEM = sticks, carbon=orange', \
             'protein = trace, color=chain' or 'rest = ghost': spacefill, balls, sticks, lines, points, trace, ghost or \
             hidden; keys: radius=, scale=, stick=, color= (CSS, element or a column), carbon=, opacity=, material=; may be \
             repeated, and the last for a sphere counts";
        "--hide" "show", Keys(words::hide), "EXPRESSION",
            "Do not draw the spheres for which an expression is true; they still count for distances in selections";
        "--ghost" "show", Keys(words::ghost), "EXPRESSION",
            "Draw the spheres for which an expression is true faintly";
        "--replicate" "replicate", Text, "AxBxC",
            "Repeat the spheres of a periodic cell this many times along its edges, such as 2x2x1; `faces` repeats those at a \
             face of the cell at the opposite one, `wrap` only moves all into the cell, and `whole` puts molecules \
             together that faces cut";
        "--focus" "focus", Text, "EXPRESSION",
            "Frame only the spheres for which an expression is true, whatever else is drawn";
        "--box" "box", Words(words::cell), "WIDTH" (""),
            "Draw the edges of the file's periodic cell, or of the box around all spheres if it has none, with this width; \
             --no-box draws none [without a width: 1/300 of the diagonal]";
        "--bonds" "bonds", Words(words::bonds), "FACTOR" (""),
            "Draw balls and sticks: bonds between atoms that are closer than FACTOR times the sum of their covalent radii, \
             except between hydrogens; atoms become smaller unless their radii are given [without a factor: 1.2]";
        "--bond-length" "bonds", Words(words::bond_length), "LENGTH",
            "Draw bonds between all spheres that are closer than this length, whatever they are";
        "--arrows" "arrows", Words(words::arrows), "VECTOR[,KEY=VALUE]...",
            "Draw an arrow for the vector of each sphere, such as forces for the columns forces.x, forces.y and forces.z; \
             scale=LENGTH of an arrow for a vector of length 1, radius=, color=, min= length of a vector, at=start or middle; \
             spheres become smaller unless their radii are given; --legend explains the length";
    }
    Color {
        "--color-by" "color_by.column", Text, "COLUMN",
            "Color the spheres by a column of the data: its name, or index, radius, x, y or z, or \"|v|\" for the length \
             of a vector with the columns v.x, v.y and v.z";
        "--cmap" "color_by.map", Text, "NAME",
            "Color map or palette, such as viridis, turbo, batlow, vik, okabe-ito or tol-muted; the ending _r reverses it \
             [default: viridis; okabe-ito for text and few whole numbers]";
        "--cmap-reverse" "color_by.reverse", Switch, "BOOL" ("true"),
            "Reverse the color map";
        "--range" "color_by.range", Words(words::range), "LO,HI",
            "Numbers with the first and the last color: numbers, percentiles, or nothing for the end of the data, such as \
             0,5 or 2%,98% or 0, [default: those of the data]";
        "--log" "color_by.log", Switch, "BOOL" ("true"),
            "Let colors follow the logarithm of the numbers";
        "--missing-color" "color_by.missing", Text, "CSS",
            "CSS color of spheres without a value [default: #808080]";
        "--radius-by" "radius_by", Words(words::with_factor), "COLUMN[*F]",
            "Take the radii from a column of the data, which may be followed by a factor, such as diameter*0.5";
        "--radius-scale" "radius_scale", Number, "FACTOR",
            "Multiply all radii by this factor";
        "--opacity" "opacity", Number, "PART",
            "Opacity of all spheres, from 0 (clear) to 1 (opaque)";
        "--opacity-by" "opacity_by", Text, "COLUMN",
            "Take the opacities from a column of the data, from 0 (clear) to 1 (opaque)";
        "--emission-by" "emission_by", Words(words::with_factor), "COLUMN[*F]",
            "Let spheres emit light of the strength that a column of the data has, which may be followed by a factor";
    }
    Annotation {
        "--legend" "legend", Keys(words::legend), "POSITION" ("right"),
            "Show what the colors of --color-by mean, at a position: top-left, top, top-right, left, right, bottom-left, \
             bottom, bottom-right, or fractions of the width and height such as 0.9,0.5 [without a position: right]";
        "--legend-title" "legend.title", Text, "TEXT",
            "Title of the legend, which is shown if this is given [default: the name of the column]";
        "--scale-bar" "scale_bar", Keys(words::scale_bar), "LENGTH UNIT[@POSITION]" (""),
            "Show how long a length is; write the length, the unit, or both, such as --scale-bar=\"20 Å\", and a position \
             after an @ [without a length: a round one] [without a position: bottom-left]";
        "--axes" "axes", Keys(words::axes), "POSITION" (""),
            "Show the directions of x, y and z as arrows, at a position as for --legend [without a position: bottom-left]";
        "--label" "labels", Keys(words::label), "TEXT[@POSITION]",
            "Write a text at a position, such as \"a@top-right\"; may be repeated [without a position: top-left]";
        "--text-scale" "text.scale", Number, "F",
            "Size of the text, as a factor of 1/36 of the picture's height";
        "--text-color" "text.color", Text, "CSS",
            "CSS color of text and lines [default: black or white, whichever can be read]";
        "--panel" "text.panel", OneOf(panels), "PANEL",
            "Whether a translucent panel lies behind annotations [default: auto]";
        "--dpi" "output.dpi", Number, "N",
            "Pixels per inch at which a PNG is to be printed; changes no pixel [default: the scene's, or none]";
    }
    Look {
        "--style" "style", OneOf(styles), "STYLE",
            "Look of the picture: light, lines and background. Values that a scene gives itself stay, and a note says \
             which [default: the scene's; for data files: default, or the one that suits --integrator]";
        "--background" "background", Text, "CSS",
            "CSS color of the background [default: the scene's, or the style's]";
        "--integrator" "integrator", OneOf(integrators), "INTEGRATOR",
            "How the light is computed [default: the scene's, or the style's]";
        "--samples" "sampling.samples", Whole, "N",
            "Samples per pixel, from 1 to 16777216: how smooth the picture is [default: the scene's, or the style's]";
        "--seed" "sampling.seed", Whole, "N",
            "Seed of the random numbers; another seed gives other noise [default: the scene's, or 0]";
        "--filter" "sampling.filter", OneOf(filters), "FILTER",
            "Pixel filter, which weights the samples around the center of a pixel [default: the scene's, or \
             blackman-harris]";
        "--ao" "studio.occlusion.samples", Whole, "RAYS" ("4"),
            "Ambient occlusion with this number of rays per sample, from 1 to 1024 (studio) [without a number: 4]";
        "--outline" "studio.outline.width", Number, "PIXELS",
            "Outlines around shapes with this width in pixels, from 0.5 to 64, or 0 for none (studio)";
        "--denoise" "sampling.denoise", Switch, "BOOL" ("true"),
            "Remove noise with a filter that is guided by shapes and colors [default: the scene's, or the style's]";
    }
    Output {
        "--bits" "output.bits", Whole, "N",
            "Bits per channel of a PNG, 8 or 16 [default: the scene's, or 8]";
        "--transparent" "output.transparent", Switch, "BOOL" ("true"),
            "Make the background transparent: write RGBA, with alpha from the spheres [default: the scene's, or false]";
        "--exposure" "output.exposure", Number, "STOPS",
            "Exposure of a PNG in stops from -32 to 32; each stop doubles the brightness [default: the scene's, or 0]";
        "--tone" "output.tone", OneOf(tones), "TONE",
            "Tone curve of a PNG, which brings light that is brighter than white into range [default: the scene's, or \
             none]";
    }
}
