//! Habits of people who use other programs. Before clap parses the words of a command line, values after a blank are
//! joined to their flags, other names of flags are replaced, and a file alone is rendered.

use std::collections::VecDeque;
use std::ffi::{OsStr, OsString};
use std::path::Path;

use clap::{Arg, Command, CommandFactory};

use self::asked::Asked;
use self::hints::Hint;
use self::names::{SAME, SHORT, frames_of, same};
use crate::command_line::Arguments;
use crate::terminal::failure::Failure;
use crate::terminal::text::in_quotes;
use pinhole_data::show::ShowStyle;
use pinhole_figure::settings::flags::{Flag, Value};

mod asked;
mod files;
mod hints;
mod names;
mod values;

/// Flags with a selection, which has blanks.
const SELECTIONS: [&str; 6] = ["select", "focus", "show", "hide", "ghost", "define"];

/// The width of outlines if nobody says it, in pixels.
const LINES: &str = "1.5";

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
            if rest.front().is_some_and(|word| word == "help") {
                return Err(Failure::usage(
                    "help: `pinhole --help` lists the commands, and `pinhole render --help` all flags of pictures with their \
                     values",
                ));
            }
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
            (text == "-" || name.starts_with("no-") || names::said(&text).is_some())
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

/// A value may begin with a number, but not with a letter after the hyphen.
fn is_flag(word: &OsStr) -> bool {
    let bytes = word.as_encoded_bytes();
    bytes.starts_with(b"--") || bytes.first() == Some(&b'-') && bytes.get(1).is_some_and(u8::is_ascii_alphabetic)
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
                Some(text) if names::said(text).is_some() && self.is_unknown(text) => {
                    let words = names::said(text).unwrap_or_default();
                    return Err(Failure::usage(format!("{text}: {words}")));
                }
                _ => self.other(word),
            }
        }
        self.give_back_file();
        self.order_rules();
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

    fn is_unknown(&self, short: &str) -> bool {
        self.find("show").is_some() && !self.command.get_arguments().any(|arg| is_short(arg, short))
    }

    fn find(&self, name: &str) -> Option<&Arg> {
        self.command.get_arguments().find(|arg| arg.get_long() == Some(name))
    }

    fn flag(&mut self, text: &str) -> Result<(), Failure> {
        let (name, value) = text.split_once('=').map_or((text, None), |(name, value)| (name, Some(value)));
        let written = name.replace('_', "-");
        let is_bare = value.is_none() && self.rest.front().is_none_or(|word| word.as_encoded_bytes().starts_with(b"-"));
        if is_bare && ["center", "centre"].contains(&name) {
            let words = "pictures are centered on what they show; leave it out";
            return Err(Failure::usage(format!("--{name}: {words}")));
        }
        if self.find(name).is_none() && self.of_value(&written, value)? {
            return Ok(());
        }
        let name = if self.find(name).is_some() { name } else { same(&written) };
        if self.find(name).is_some() {
            return self.own(name, value);
        }
        let is_switch = |flag: &Flag| {
            (matches!(flag.value, Value::Switch) || flag.name() == "box") && self.find(flag.name()).is_some()
        };
        let switched = name.strip_prefix("no-").map(same);
        // These are drawn only if they are asked for.
        if switched.is_some_and(|name| ["axes", "arrows", "label", "legend", "scale-bar"].contains(&name)) {
            return Ok(());
        }
        if let Some(flag) = switched.and_then(Flag::of_name).filter(|flag| is_switch(flag)) {
            self.give(flag.name(), "false");
            return Ok(());
        }
        let Some((_, of)) = SHORT.iter().find(|(short, of)| *short == name && self.find(of).is_some()) else {
            return match hints::of(name, self.find("show").is_some()) {
                Hint::Flag(flag, mut value) => {
                    // A style may have its selection.
                    let is_selection = |word: &&OsString| {
                        !is_flag(word) && word.as_encoded_bytes().contains(&b' ') && !Path::new(word).is_file()
                    };
                    if flag == "show" && self.rest.front().filter(is_selection).is_some() {
                        let selection = self.rest.pop_front().unwrap_or_default();
                        value = format!("{} = {value}", selection.to_string_lossy());
                    }
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
        let follows = self.rest.front().is_some_and(|word| !is_flag(word));
        let next = if value.is_none() && follows { self.rest.pop_front() } else { None };
        let value = value.map(str::to_owned).or(next.and_then(|word| word.into_string().ok()));
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

    /// Takes a flag of another program whose value has another meaning here. Returns false if it is none.
    fn of_value(&mut self, name: &str, value: Option<&str>) -> Result<bool, Failure> {
        let next = value.or_else(|| self.rest.front().and_then(|word| word.to_str()));
        let Some(text) = next.map(str::to_owned) else { return Ok(false) };
        let Some(found) = values::replaced(name, &text)? else { return Ok(false) };
        if value.is_none() {
            self.rest.pop_front();
        }
        self.plain.push(found.into());
        Ok(true)
    }

    /// Puts styles for all before rules for a part, which they would cancel.
    fn order_rules(&mut self) {
        let is_rule = |word: &OsString| {
            let text = word.to_string_lossy();
            ["--show=", "--hide=", "--ghost="].iter().any(|start| text.starts_with(start))
        };
        let is_for_all = |word: &OsString| {
            let text = word.to_string_lossy();
            let style = text.strip_prefix("--show=").and_then(|rule| rule.split(',').next());
            style.is_some_and(|style| ShowStyle::of_name(style.trim()).is_some())
        };
        let places: Vec<usize> = (0..self.plain.len()).filter(|place| is_rule(&self.plain[*place])).collect();
        let mut rules: Vec<OsString> = places.iter().map(|place| self.plain[*place].clone()).collect();
        rules.sort_by_key(|rule| !is_for_all(rule));
        for (place, rule) in places.into_iter().zip(rules) {
            self.plain[place] = rule;
        }
    }

    /// Takes a flag of the command, with its value.
    fn own(&mut self, name: &str, value: Option<&str>) -> Result<(), Failure> {
        let may_be_value = |word: &OsStr, arg: &Arg| {
            let begins = |with: &[u8]| word.as_encoded_bytes().starts_with(with);
            let has_hyphen = begins(b"-") && word != "-";
            let is_flag = SELECTIONS.contains(&name) && is_flag(word);
            match arg.is_require_equals_set() {
                true => !has_hyphen && !Path::new(word).is_file(),
                false => !has_hyphen || arg.is_allow_hyphen_values_set() && !begins(b"--") && !is_flag,
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
        if is_doubtful {
            self.doubtful.push(self.plain.len());
        }
        let (name, text) = values::meant(name, &text, |name| self.find(name).is_some())?;
        if name == "select" && self.plain.iter().any(|word| word.to_string_lossy().starts_with("--select=")) {
            return Err(Failure::usage(
                "--select twice: join them with `or`; --show 'protein = trace' --show 'resname HEM = sticks' draws parts \
                 otherwise",
            ));
        }
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

    /// The value of a flag that was given before, which is taken away.
    fn taken(&mut self, name: &str) -> Option<String> {
        let start = format!("--{name}=");
        let place = self.plain.iter().position(|word| word.to_str().is_some_and(|word| word.starts_with(&start)))?;
        Some(self.plain.remove(place).to_str()?[start.len()..].to_owned())
    }
}

#[cfg(test)]
mod tests;
