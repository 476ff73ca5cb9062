//! The flags that reach settings, as clap parses them. Their rows are in `pinhole_figure::settings::flags`.

use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Args, Command, FromArgMatches};

use crate::terminal::failure::Failure;
use pinhole_figure::settings::Layer;
use pinhole_figure::settings::flags::{EXCLUSIVE, FLAGS, Flag, Group, Value};

/// The groups of flags that say how a file is read and from where it is seen.
pub(crate) const VIEW: u32 = Group::Input as u32 | Group::Camera as u32;

/// The group of flags about light and style.
pub(crate) const LOOK: u32 = Group::Look as u32;

/// The groups of flags that say how a picture looks and how it is written.
pub(crate) const PICTURE: u32 =
    LOOK | Group::Structure as u32 | Group::Color as u32 | Group::Annotation as u32 | Group::Output as u32;

/// The flags of some groups that were given.
#[derive(Clone, Debug, Default)]
pub(crate) struct SettingArgs<const GROUPS: u32> {
    pub(crate) given: Given,
}

/// Flags that were given, with their values.
#[derive(Clone, Debug, Default)]
pub(crate) struct Given(Vec<(&'static Flag, String)>);

impl Given {
    /// Adds a flag.
    pub(crate) fn with(mut self, name: &str, value: Option<String>) -> Self {
        self.0.extend(Flag::of_name(name).zip(value));
        self
    }

    /// The flags, for work on the spheres as they are, whatever kind of data they are.
    pub(crate) fn plain(self) -> Self {
        self.with("kind", Some("plain".to_owned()))
    }

    /// The flags without one of them.
    pub(crate) fn without(&self, name: &str) -> Self {
        Self(self.0.iter().filter(|(flag, _)| flag.name() != name).cloned().collect())
    }

    /// The names of all flags, without dashes, and their values.
    pub(crate) fn all(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.0.iter().map(|(flag, value)| (flag.name(), &**value))
    }

    /// The flags of both, of which `other` takes precedence.
    pub(crate) fn and(mut self, other: &Self) -> Self {
        self.0.extend(other.0.iter().cloned());
        self
    }

    /// The value of a flag, which is named without dashes.
    pub(crate) fn get(&self, name: &str) -> Option<&str> {
        let mut last_first = self.0.iter().rev();
        last_first.find(|(flag, _)| flag.name() == name).map(|(_, value)| &**value)
    }

    /// The first of some flags that was given.
    pub(crate) fn first_of(&self, names: &[&str]) -> Option<&'static str> {
        let mut given = self.0.iter().map(|(flag, _)| *flag);
        given.find(|flag| names.contains(&flag.name())).map(|flag| flag.flag)
    }

    /// The first flag of some groups that was given.
    pub(crate) fn first_in(&self, groups: u32) -> Option<&'static str> {
        let mut given = self.0.iter().map(|(flag, _)| *flag);
        given.find(|flag| flag.group as u32 & groups != 0).map(|flag| flag.flag)
    }

    /// Returns true if a flag gives a key, a key within its table, or a key of a camera with this name.
    pub(crate) fn has_key(&self, key: &str) -> bool {
        let is = |flag: &Flag| {
            let (first, last) = (flag.key.split('.').next(), flag.key.strip_prefix("camera.*."));
            first == Some(key) || last == Some(key)
        };
        let is_set = |value: &str| {
            let path = value.split('=').next().unwrap_or_default().trim();
            let last = path.strip_prefix("camera.").and_then(|path| path.rsplit('.').next());
            path.split('.').next() == Some(key) || last == Some(key)
        };
        self.0.iter().any(|(flag, value)| if flag.name() == "set" { is_set(value) } else { is(flag) })
    }

    /// The settings that the flags give.
    pub(crate) fn layers(&self) -> Result<Vec<Layer>, Failure> {
        let camera = self.get("camera").unwrap_or("pinhole");
        let layer = |(flag, value): &(&'static Flag, String)| {
            let layer = flag.layer(value, camera);
            layer.map_err(|error| Failure::usage(format!("{} {value}: {error}", flag.flag)))
        };
        self.0.iter().map(layer).collect()
    }
}

impl<const GROUPS: u32> Args for SettingArgs<GROUPS> {
    fn augment_args(command: Command) -> Command {
        command.args(flags(GROUPS).map(argument))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl<const GROUPS: u32> FromArgMatches for SettingArgs<GROUPS> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let (mut given, mut rules) = (Given::default(), Vec::new());
        for flag in flags(GROUPS) {
            if matches.value_source(flag.name()) == Some(ValueSource::CommandLine) {
                let values = matches.get_many::<String>(flag.name()).into_iter().flatten();
                let places = matches.indices_of(flag.name()).into_iter().flatten();
                let values = values.zip(places).map(|(value, place)| (place, (flag, value.clone())));
                // Rules that several flags give apply in the order in which they were written.
                if flag.key == "show" { rules.extend(values) } else { given.0.extend(values.map(|(_, value)| value)) }
            }
        }
        rules.sort_by_key(|(place, _)| *place);
        given.0.extend(rules.into_iter().map(|(_, rule)| rule));
        Ok(Self { given })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

fn flags(groups: u32) -> impl Iterator<Item = &'static Flag> {
    FLAGS.iter().filter(move |flag| flag.group as u32 & groups != 0)
}

/// The names of the flags of some groups, which are also clap's ids.
pub(crate) fn names(groups: u32) -> impl Iterator<Item = &'static str> {
    flags(groups).map(Flag::name)
}

fn argument(flag: &'static Flag) -> Arg {
    let arg = Arg::new(flag.name()).long(flag.name()).value_name(flag.shown).help(flag.help);
    let arg = match heading(flag.group) {
        "" => arg,
        heading => arg.help_heading(heading),
    };
    let arg = match flag.value {
        Value::OneOf(names) => {
            let name = |(name, help): (&'static str, &'static str)| match help {
                "" => PossibleValue::new(name),
                help => PossibleValue::new(name).help(help),
            };
            arg.value_parser(PossibleValuesParser::new(names().into_iter().map(name)))
        }
        // The kind of camera changes no value of another flag.
        _ => arg.value_parser(move |text: &str| flag.layer(text, "pinhole").map(|_| text.to_owned())),
    };
    let arg = match flag.alone {
        Some(value) => arg.num_args(0..=1).require_equals(true).default_missing_value(value),
        None => arg.allow_hyphen_values(
            !matches!(flag.value, Value::Text | Value::OneOf(_)) || ["select", "focus"].contains(&flag.name()),
        ),
    };
    let exclusive = EXCLUSIVE.iter().filter(|(name, _)| *name == flag.flag);
    let excluded = exclusive.flat_map(|(_, others)| others.iter());
    let arg = arg.conflicts_with_all(excluded.map(|other| other.trim_start_matches('-')));
    if flag.is_list() { arg.action(ArgAction::Append) } else { arg }
}

/// The heading of flags about light and style.
pub(crate) const LOOK_HEADING: &str = "Light and style";

/// Arguments that are not settings, with the headings under which the help of `render` lists them.
const HEADINGS: &[(&str, &str)] = &[
    ("output", OUTPUT_HEADING),
    ("layers", OUTPUT_HEADING),
    ("stereo", OUTPUT_HEADING),
    ("certify", OUTPUT_HEADING),
    ("print_scene", OUTPUT_HEADING),
    ("save_scene", OUTPUT_HEADING),
    ("keep_partial", LOOK_HEADING),
    ("quiet", OUTPUT_HEADING),
    ("backend", DEVICE_HEADING),
    ("adapter", DEVICE_HEADING),
    ("limits", DEVICE_HEADING),
    ("accel", DEVICE_HEADING),
    ("profile", DEVICE_HEADING),
];

const OUTPUT_HEADING: &str = "Output";
const DEVICE_HEADING: &str = "Device";

/// The arguments that `render -h` lists, which fits on one screen.
const BRIEF: &[&str] = &[
    "path",
    "frame",
    "size",
    "select",
    "bonds",
    "style",
    "background",
    "samples",
    "color-by",
    "cmap",
    "legend",
    "scale-bar",
    "view",
    "zoom",
    "frames",
    "turntable",
    "output",
    "transparent",
    "print_scene",
    "backend",
    "set",
];

/// Puts an argument of `render` under the heading of its task, and into the short help with its first words.
pub(crate) fn arranged(arg: Arg) -> Arg {
    let id = arg.get_id().as_str().to_owned();
    let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
    let heading = HEADINGS.iter().find(|(other, _)| *other == id).map(|(_, heading)| *heading);
    let arg = match heading {
        Some(heading) => arg.help_heading(heading),
        None => arg,
    };
    if !BRIEF.contains(&id.as_str()) {
        return arg.hide_short_help(true);
    }
    let ends = [": ", "; ", " [", ", such as", " (", ", or "].iter().filter_map(|end| help.find(end));
    let brief = help[..ends.min().unwrap_or(help.len())].to_owned();
    let arg = if arg.get_long_help().is_some() { arg } else { arg.long_help(help) };
    arg.help(brief)
}

/// The heading under which the help lists a group; empty for none.
fn heading(group: Group) -> &'static str {
    match group {
        Group::Input => "Input",
        Group::Output => OUTPUT_HEADING,
        Group::Structure => "Selection, box and bonds",
        Group::Color => "Colors, radii and opacities from data",
        Group::Look => LOOK_HEADING,
        Group::Camera => "Camera (any of these flags replaces the camera of the scene)",
        Group::Annotation => "Annotations (drawn on a PNG, after exposure and tone)",
    }
}
