//! Habits of people who use other programs. Before clap parses the words of a command line, values after a blank are
//! joined to their flags, other names of flags are replaced, and a file alone is rendered.

use std::collections::VecDeque;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use clap::{Arg, Command, CommandFactory};
use strsim::normalized_levenshtein;

use self::asked::Asked;
use self::hints::Hint;
use self::names::{SAME, SHORT, frames_of, same};
use crate::command_line::Arguments;
use crate::terminal::failure::Failure;
use crate::terminal::text::in_quotes;
use pinhole_data::css;
use pinhole_data::load::{FileSet, Format};
use pinhole_data::show::ShowStyle;
use pinhole_figure::settings::flags::{Flag, Value};

mod asked;
mod hints;
mod names;

/// Flags with a selection, which has blanks.
const SELECTIONS: [&str; 6] = ["select", "focus", "show", "hide", "ghost", "define"];

/// Endings of pictures, which a shell puts among the files of a pattern.
const PICTURES: [&str; 6] = ["apng", "exr", "gif", "json", "mp4", "png"];

/// The width of outlines if nobody says it, in pixels.
const LINES: &str = "1.5";

/// Frequent colors, to tell a misspelt one from a column.
const COLORS: [&str; 13] = [
    "black",
    "white",
    "gray",
    "grey",
    "green",
    "yellow",
    "orange",
    "purple",
    "brown",
    "tomato",
    "steelblue",
    "skyblue",
    "lightgray",
];

/// The words that clap parses, for the words that a user typed. The first is the name of the program.
///
/// # Errors
/// Says what to type in the place of words that have no meaning.
pub(crate) fn plain_words(words: Vec<OsString>) -> Result<Vec<OsString>, Failure> {
    let program = Arguments::command();
    let mut rest = VecDeque::from(words);
    let mut plain: Vec<OsString> = rest.pop_front().into_iter().collect();
    let mut command = &program;
    while let Some(inner) = rest.front().and_then(|word| command.find_subcommand(word)) {
        command = inner;
        plain.extend(rest.pop_front());
    }
    if command.has_subcommands() {
        let render = program.find_subcommand("render").filter(|render| {
            let is_first = plain.len() == 1;
            is_first && rest.front().is_some_and(|word| is_for(render, word))
        });
        let Some(render) = render else {
            plain.extend(rest);
            return Ok(plain);
        };
        plain.push("render".into());
        command = render;
    }
    Reader { command, rest, plain, files: Vec::new(), doubtful: Vec::new(), asked: Asked::default() }.read()
}

/// Returns true if a word that is not the name of a command may be a file or a flag for this command.
fn is_for(command: &Command, word: &OsStr) -> bool {
    let text = word.to_string_lossy();
    match text.strip_prefix('-') {
        Some(flag) => {
            let name = flag.trim_start_matches('-').split('=').next().unwrap_or_default();
            let is_other = |(other, _): &(&str, &str)| *other == name;
            name.starts_with("no-")
                || command.get_arguments().any(|arg| arg.get_long() == Some(name) || is_short(arg, &text))
                || SAME.iter().chain(SHORT).any(is_other)
                || !matches!(hints::of(name, true), Hint::None)
        }
        None => text.contains(['.', '/', '\\']) || Path::new(word).is_file(),
    }
}

fn is_short(arg: &Arg, word: &str) -> bool {
    arg.get_short().is_some_and(|short| word.strip_prefix('-') == Some(short.encode_utf8(&mut [0; 4])))
}

/// Reads words one by one.
struct Reader<'a> {
    command: &'a Command,
    rest: VecDeque<OsString>,
    plain: Vec<OsString>,
    /// The places in `plain` of words that belong to no flag.
    files: Vec<usize>,
    /// Values of flags that need none: their places in `plain`. If nothing else is the file, one of them is.
    doubtful: Vec<usize>,
    asked: Asked,
}

impl Reader<'_> {
    fn read(mut self) -> Result<Vec<OsString>, Failure> {
        while let Some(word) = self.rest.pop_front() {
            if word == "--" {
                let start = self.plain.len() + 1;
                self.files.extend((0..self.rest.len()).map(|place| start + place));
                self.rest.push_front(word);
                break;
            }
            match word.to_str() {
                Some(text) if text.len() > 2 && text.starts_with("--") => self.flag(&text[2..])?,
                Some("-s") if self.find("size").is_some() => self.flag("size")?,
                _ => self.other(word),
            }
        }
        self.give_back_file();
        self.name_topology();
        self.join_files();
        self.refuse_more_files()?;
        let asked = std::mem::take(&mut self.asked);
        for (name, value) in asked.flags(|name| self.taken(name))? {
            self.give(name, &value);
        }
        self.plain.extend(self.rest);
        Ok(self.plain)
    }

    /// Takes a word that is no long flag: a file, or a flag of one letter with its value.
    fn other(&mut self, word: OsString) {
        let text = word.to_string_lossy().into_owned();
        if let Some((file, flag, frames)) = frames_of(&text)
            && self.find(flag).is_some()
        {
            self.plain.push(file.into());
            self.files.push(self.plain.len() - 1);
            self.give(flag, frames);
            return;
        }
        self.plain.push(word);
        let needs_value = |arg: &&Arg| is_short(arg, &text) && arg.get_action().takes_values();
        if self.command.get_arguments().any(|arg| needs_value(&arg)) {
            self.plain.extend(self.rest.pop_front());
        } else if !text.starts_with('-') || text == "-" {
            self.files.push(self.plain.len() - 1);
        }
    }

    fn find(&self, name: &str) -> Option<&Arg> {
        self.command.get_arguments().find(|arg| arg.get_long() == Some(name))
    }

    fn flag(&mut self, text: &str) -> Result<(), Failure> {
        let (name, value) = text.split_once('=').map_or((text, None), |(name, value)| (name, Some(value)));
        let name = if self.find(name).is_some() { name } else { same(name) };
        if self.find(name).is_some() {
            return self.own(name, value);
        }
        let is_switch = |flag: &Flag| {
            (matches!(flag.value, Value::Switch) || flag.name() == "box") && self.find(flag.name()).is_some()
        };
        let switched = name.strip_prefix("no-").map(same);
        if let Some(flag) = switched.and_then(Flag::of_name).filter(|flag| is_switch(flag)) {
            self.give(flag.name(), "false");
            return Ok(());
        }
        let Some((_, of)) = SHORT.iter().find(|(short, of)| *short == name && self.find(of).is_some()) else {
            return match hints::of(name, self.find("show").is_some()) {
                Hint::Flag(flag, value) => {
                    self.give(flag, &value);
                    Ok(())
                }
                Hint::Say(words) => Err(Failure::usage(format!("--{name}: {words}"))),
                Hint::None => {
                    self.plain.push(format!("--{text}").into());
                    Ok(())
                }
            };
        };
        let value = value.map(str::to_owned).or_else(|| self.rest.pop_front()?.into_string().ok());
        let value = value.ok_or_else(|| Failure::usage(format!("--{name} needs a value")))?;
        match name {
            "title" => self.give(of, &format!("{value}@top")),
            "clip" => return Err(Failure::usage("--clip: spheres are not cut; --select 'x < 5' keeps a part")),
            "exclude" => {
                self.check_quotes(name, &value)?;
                self.asked.take(name, value)?;
            }
            _ => self.asked.take(name, value)?,
        }
        Ok(())
    }

    /// Takes a flag of the command, with its value.
    fn own(&mut self, name: &str, value: Option<&str>) -> Result<(), Failure> {
        let may_be_value = |word: &OsStr, arg: &Arg| {
            let begins = |with: &[u8]| word.as_encoded_bytes().starts_with(with);
            let has_hyphen = begins(b"-") && word != "-";
            match arg.is_require_equals_set() {
                true => !has_hyphen && !Path::new(word).is_file(),
                false => !has_hyphen || arg.is_allow_hyphen_values_set() && !begins(b"--"),
            }
        };
        let arg = self.find(name).filter(|arg| arg.get_action().takes_values());
        let is_doubtful = value.is_none() && arg.is_some_and(Arg::is_require_equals_set);
        let needs_value = arg.is_some_and(|arg| !arg.is_require_equals_set());
        let follows = arg.is_some_and(|arg| self.rest.front().is_some_and(|word| may_be_value(word, arg)));
        let value = match value {
            Some(value) => Some(value.into()),
            None if follows => self.rest.pop_front(),
            None => None,
        };
        let flag = format!("--{name}");
        let Some(value) = value else {
            match name {
                "outline" => self.give(name, LINES),
                _ if needs_value && !self.rest.is_empty() => {
                    return Err(Failure::usage(format!("{flag} needs a value; `pinhole render --help` says which")));
                }
                _ => self.plain.push(flag.into()),
            }
            return Ok(());
        };
        let Some(text) = value.to_str() else {
            self.plain.extend([flag.into(), value]);
            return Ok(());
        };
        let text = self.joined(name, text);
        if SELECTIONS.contains(&name) {
            self.check_quotes(name, &text)?;
        }
        if ["color", "radius"].contains(&name) && text.contains('=') {
            return Err(Failure::usage(format!(
                "--{name} {text}: this is one {name} for all; for each kind: --set 'elements.NAME.{name}=VALUE'"
            )));
        }
        if is_doubtful {
            self.doubtful.push(self.plain.len());
        }
        // A name that is not a color is a column, unless it is nearly one.
        let is_color =
            || css::color(&text).is_ok() || COLORS.iter().any(|color| normalized_levenshtein(color, &text) > 0.7);
        let is_of_show = ShowStyle::of_name(&text).is_some() || text.eq_ignore_ascii_case("cpk");
        let is_column = name == "color" && self.find("color-by").is_some() && !is_color();
        let name = match name {
            "color" if is_column => "color-by",
            // A style of other programs is one of what is drawn.
            "style" if is_of_show && self.find("show").is_some() => "show",
            // The camera of some programs is called a view.
            "view" if text == "perspective" => {
                self.give("camera", "pinhole");
                return Ok(());
            }
            name => name,
        };
        // What is off is as if it were not asked for, but for a cell, which kinds of data may draw.
        if is_doubtful && ["off", "none", "no"].contains(&text.as_str()) {
            if name == "box" {
                self.give(name, "false");
            }
            return Ok(());
        }
        if name == "background" && text == "transparent" && self.find("transparent").is_some() {
            self.plain.push("--transparent".into());
            return Ok(());
        }
        self.give(name, &text);
        Ok(())
    }

    fn give(&mut self, name: &str, value: &str) {
        self.plain.push(format!("--{name}={value}").into());
    }

    /// Joins numbers that follow a number, for a flag that takes several: `--range 0 50` is `--range 0,50`.
    fn joined(&mut self, name: &str, first: &str) -> String {
        let Some(flag) = Flag::of_name(name) else { return first.to_owned() };
        let most = match flag.value {
            Value::Numbers(count) => count,
            _ if ["range", "size", "view"].contains(&name) => 2,
            _ if name == "replicate" => 3,
            _ => 1,
        };
        let is_number = |text: &str| text.trim_end_matches('%').parse::<f64>().is_ok();
        let rest = self.rest.iter().map_while(|word| word.to_str());
        let rest = rest.take_while(|word| is_number(word) && !Path::new(word).is_file());
        let numbers: Vec<&str> = [first].into_iter().chain(rest).take(most).collect();
        let text = numbers.join(",");
        if most == 1 || numbers.len() < most || !is_number(first) || flag.layer(&text, "pinhole").is_err() {
            return first.to_owned();
        }
        self.rest.drain(..most - 1);
        text
    }

    /// Refuses a selection that goes on after its first word, because a shell divided it.
    fn check_quotes(&self, name: &str, first: &str) -> Result<(), Failure> {
        let is_file = |word: &OsString| Path::new(word).is_file();
        let is_bare = |word: &OsString| !word.as_encoded_bytes().starts_with(b"-") && !is_file(word);
        let bare: Vec<_> =
            self.rest.iter().take_while(|word| is_bare(word)).map(|word| word.to_string_lossy()).collect();
        let mut pairs = self.rest.iter().zip(self.rest.iter().skip(1));
        let follows_flag = |before: &OsString| before.as_encoded_bytes().starts_with(b"-");
        // A word alone may be a file that does not exist.
        let is_file_elsewhere =
            !self.files.is_empty() || pairs.any(|(before, word)| is_file(word) && !follows_flag(before));
        let Some(word) = bare.first().filter(|_| is_file_elsewhere || bare.len() > 1) else { return Ok(()) };
        let whole = in_quotes(&format!("{first} {}", bare.join(" ")));
        Err(Failure::usage(format!("`{word}` is no file; quote it: --{name} {whole}")))
    }

    /// If no other word is the file, turns the value of a flag that needs none into it.
    fn give_back_file(&mut self) {
        if !self.files.is_empty() || self.command.get_positionals().next().is_none() {
            return;
        }
        let parts = |place: &usize| {
            let text = self.plain.get(*place)?.to_str()?;
            let (flag, value) = text.split_once('=')?;
            Some((*place, flag.to_owned(), value.to_owned()))
        };
        let all: Vec<_> = self.doubtful.iter().filter_map(parts).collect();
        let fits = |name: &str, value: &str| {
            Flag::of_name(name.trim_start_matches('-')).is_some_and(|flag| flag.layer(value, "pinhole").is_ok())
        };
        let unfit = all.iter().rev().find(|(_, flag, value)| !fits(flag, value));
        if let Some((place, flag, value)) = unfit.or(all.last()) {
            self.plain[*place] = flag.into();
            self.plain.insert(*place + 1, value.into());
        }
    }

    /// Takes the one other file beside trajectories of positions alone as their topology.
    fn name_topology(&mut self) {
        let has_topology = |word: &OsString| word.to_str().is_some_and(|word| word.starts_with("--topology"));
        if self.find("topology").is_none() || self.plain.iter().any(has_topology) {
            return;
        }
        let needs_it = |place: usize| {
            let format = self.plain.get(place).and_then(|word| Format::of_path(Path::new(word)).ok()?);
            format.is_some_and(|format| format.needs_topology)
        };
        let (trajectories, others): (Vec<usize>, Vec<usize>) = self.files.iter().partition(|place| needs_it(**place));
        let &[place] = &others[..] else { return };
        if trajectories.is_empty() {
            return;
        }
        if let Some(word) = self.plain.get_mut(place).filter(|word| word.to_str().is_some()) {
            *word = format!("--topology={}", word.to_string_lossy()).into();
        }
    }

    /// Takes several files whose names differ in a number as the frames of a trajectory, and others together.
    fn join_files(&mut self) {
        if self.command.get_positionals().count() != 1 {
            return;
        }
        let is_file = |place: &&usize| self.plain.get(**place).is_some_and(|word| Path::new(word).is_file());
        let files: Vec<usize> = self.files.iter().filter(is_file).copied().collect();
        let paths: Vec<PathBuf> = files.iter().filter_map(|place| self.plain.get(*place).map(PathBuf::from)).collect();
        let are_data = paths.iter().all(|path| matches!(Format::of_path(path), Ok(Some(_))));
        let name = FileSet::name_of(&paths).or_else(|| FileSet::name_together(&paths).filter(|_| are_data));
        let (Some(name), Some((first, others))) = (name, files.split_first()) else { return };
        self.plain[*first] = name.into();
        for place in others.iter().rev() {
            self.plain.remove(*place);
        }
        // Words after `--` are not among the plain ones yet, so places are not needed any more but that of the set.
        self.files = vec![*first];
    }

    /// Refuses a second file, which clap would call an unexpected argument.
    fn refuse_more_files(&self) -> Result<(), Failure> {
        let most = self.command.get_positionals().count();
        let files = self.files.iter().filter_map(|place| self.plain.get(*place));
        let is_topology = |word: &&OsString| word.to_string_lossy().starts_with("--topology");
        let files: Vec<&OsString> = files.filter(|word| !is_topology(word)).collect();
        let paths = files.iter().map(PathBuf::from);
        let ending = |path: &PathBuf| path.extension().and_then(OsStr::to_str).map(str::to_ascii_lowercase);
        let is_picture = |path: &PathBuf| ending(path).is_some_and(|ending| PICTURES.contains(&ending.as_str()));
        let (pictures, others): (Vec<_>, Vec<_>) = paths.partition(is_picture);
        if let (Some(picture), Some(name)) = (pictures.first(), FileSet::name_of(&others)) {
            return Err(Failure::usage(format!(
                "{}: this is a picture, not a frame; quote the name of all frames: {}",
                picture.display(),
                in_quotes(&name.to_string_lossy())
            )));
        }
        match files.get(most) {
            Some(word) if most == 1 && Path::new(*word).is_file() => Err(Failure::usage(format!(
                "{}: only files of data, without commas and braces in their names, are seen together; render each file",
                word.to_string_lossy()
            ))),
            Some(word) if most == 1 && matches!(Format::of_path(Path::new(word)), Ok(Some(_))) => {
                Err(Failure::usage(format!("{}: there is no such file", word.to_string_lossy())))
            }
            _ => Ok(()),
        }
    }

    /// The value of a flag that was given before, which is taken away.
    fn taken(&mut self, name: &str) -> Option<String> {
        let start = format!("--{name}=");
        let place = self.plain.iter().position(|word| word.to_str().is_some_and(|word| word.starts_with(&start)))?;
        Some(self.plain.remove(place).to_str()?[start.len()..].to_owned())
    }
}

#[cfg(test)]
mod tests;
