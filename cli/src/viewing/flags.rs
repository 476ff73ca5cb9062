//! A file and flags of `pinhole render`, as texts.

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use clap::parser::ValueSource;
use clap::{CommandFactory, Parser};

use super::ViewError;
use crate::command_line::Arguments;
use crate::commands::render;
use crate::flags::render::{RenderArgs, RenderCommand, RenderLine};
use crate::render::Job;
use crate::terminal::explain::{explain, one_message};
use crate::terminal::habits::plain_words;
use crate::terminal::text::in_quotes;
use pinhole_figure::settings::flags::{Flag, Group};

/// A file and flags of `pinhole render`, which are the whole state of a view.
///
/// Every flag occurs once, except `--label`, in the order of `pinhole render --help`. Flags that are set later follow.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenderFlags {
    path: String,
    /// Names without dashes, with values, which are empty for flags without a value.
    flags: Vec<(String, String)>,
}

/// The effect of a flag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Decides {
    /// The spheres and their colours.
    Data,
    Camera,
    /// The light, which scene files also give to their spheres.
    Light,
    /// The film, the encoding, and annotations.
    Picture,
}

impl RenderFlags {
    /// Parses the arguments of this process, which are those of `pinhole view`. Prints the help, the version, or an
    /// error, as `pinhole` does.
    pub fn of_process() -> Result<Self, ExitCode> {
        let words = std::env::args_os().skip(1);
        let mut arguments: Vec<String> = words.map(|word| word.to_string_lossy().into()).collect();
        arguments.insert(0, "view".to_owned());
        Self::matched(std::env::args_os().skip(1)).map_err(|error| match error {
            Refusal::Clap(error) => explain(&error, &arguments),
            Refusal::Other(error) => {
                super::print_error(&error);
                error.exit_code()
            }
        })
    }

    /// Parses words: a file and flags, as they follow `pinhole view`.
    pub fn parse<W: Into<OsString>>(words: impl IntoIterator<Item = W>) -> Result<Self, ViewError> {
        Self::matched(words.into_iter().map(Into::into)).map_err(|error| match error {
            Refusal::Clap(error) => of_clap(&error),
            Refusal::Other(error) => error,
        })
    }

    fn matched(words: impl Iterator<Item = OsString>) -> Result<Self, Refusal> {
        let mut program = Arguments::command();
        program.build();
        let start = ["pinhole", "view"].map(OsString::from);
        let words = plain_words(start.into_iter().chain(words).collect());
        let words = words.map_err(|failure| Refusal::Other(failure.into()))?;
        let matches = program.clone().try_get_matches_from(&words).map_err(Refusal::Clap)?;
        let (Some(matches), Some(view)) = (matches.subcommand_matches("view"), program.find_subcommand("view")) else {
            return Err(Refusal::Other(ViewError::usage("there is nothing to show; name a file")));
        };
        let mut found = Self { path: String::new(), flags: Vec::new() };
        for argument in view.get_arguments() {
            let id = argument.get_id().as_str();
            if matches.value_source(id) != Some(ValueSource::CommandLine) {
                continue;
            }
            let raw = matches.get_raw(id).into_iter().flatten();
            let values: Vec<String> = raw.map(text).collect::<Result<_, _>>().map_err(Refusal::Other)?;
            let Some(name) = argument.get_long() else {
                found.path = values.into_iter().next().unwrap_or_default();
                continue;
            };
            if !argument.get_action().takes_values() {
                found.flags.push((name.to_owned(), String::new()));
            } else if argument.get_value_delimiter().is_some() {
                found.flags.push((name.to_owned(), values.join(",")));
            } else {
                found.flags.extend(values.into_iter().map(|value| (name.to_owned(), value)));
            }
        }
        if found.path == "-" {
            return Err(Refusal::Other(ViewError::usage(
                "-: the viewer reads its file more than once, which standard input cannot give; name a file",
            )));
        }
        // `render` makes the same checks before it reads anything.
        found.job().map_err(Refusal::Other)?;
        Ok(found)
    }

    /// The path of the file.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The value of a flag, named without dashes. It is empty for flags without a value; `None` if the flag is absent.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.flags.iter().find(|(other, _)| other == name).map(|(_, value)| value.as_str())
    }

    /// Sets the value of a flag, which is empty for a flag without one. It is checked when the flags are used.
    pub fn set(&mut self, name: &str, value: &str) {
        match self.flags.iter_mut().find(|(other, _)| other == name) {
            Some((_, old)) => value.clone_into(old),
            None => self.flags.push((name.to_owned(), value.to_owned())),
        }
    }

    /// Removes a flag.
    pub fn remove(&mut self, name: &str) {
        self.flags.retain(|(other, _)| other != name);
    }

    /// Removes all flags of the camera.
    pub fn remove_camera(&mut self) {
        self.flags.retain(|(name, _)| decides(name) != Decides::Camera);
    }

    /// Whether both have the same spheres in the same colours, so that only camera, light or film may differ.
    pub fn has_data_of(&self, other: &Self) -> bool {
        // Scene files also give light to spheres.
        let is_scene = self.path.to_ascii_lowercase().ends_with(".toml");
        let of_data = |flags: &Self| -> Vec<(String, String)> {
            let is_kept = |name: &str| match decides(name) {
                Decides::Data => true,
                Decides::Light => is_scene,
                Decides::Camera | Decides::Picture => false,
            };
            let mut kept: Vec<_> = flags.flags.iter().filter(|(n, _)| is_kept(n)).cloned().collect();
            kept.sort();
            kept
        };
        self.path == other.path && of_data(self) == of_data(other)
    }

    /// Whether both read the same file in the same way, though perhaps other frames of it.
    pub(super) fn has_file_of(&self, other: &Self) -> bool {
        let reading = ["format", "topology", "columns", "radius"];
        self.path == other.path && reading.iter().all(|name| self.get(name) == other.get(name))
    }

    /// The words after `pinhole render`, without the output.
    pub fn words(&self) -> Vec<String> {
        let path = if self.path.starts_with('-') { format!("./{}", self.path) } else { self.path.clone() };
        let flag = |(name, value): &(String, String)| match value.as_str() {
            "" => format!("--{name}"),
            value => format!("--{name}={value}"),
        };
        [path].into_iter().chain(self.flags.iter().map(flag)).collect()
    }

    /// The command that renders this view, for a shell.
    pub fn command_line(&self, output: &str) -> String {
        let end = ["-o".to_owned(), output.to_owned()];
        let words: Vec<String> = self.words().iter().chain(&end).map(|word| in_quotes(word)).collect();
        format!("pinhole render {}", words.join(" "))
    }

    /// Renders and writes the picture, as `pinhole render` does with the same flags.
    pub fn save(&self, output: &str) -> Result<(), ViewError> {
        // A name that starts with a dash is a file here, and `-` is not standard output.
        let output = if output.starts_with('-') { format!("./{output}") } else { output.to_owned() };
        Ok(render::run(&*self.render_args(&output)?)?)
    }

    /// Checks the flags as far as is possible before the file is read.
    pub fn check(&self) -> Result<(), ViewError> {
        self.job().map(drop)
    }

    pub(super) fn render_args(&self, output: &str) -> Result<Box<RenderArgs>, ViewError> {
        let start = ["pinhole", "render"].map(str::to_owned);
        let end = ["-o".to_owned(), output.to_owned()];
        let words = start.into_iter().chain(self.words()).chain(end);
        let line = RenderLine::try_parse_from(words).map_err(|error| of_clap(&error))?;
        let RenderCommand::Render(args) = line.command;
        Ok(args)
    }

    /// The job of `pinhole render` with these flags.
    pub(super) fn job(&self) -> Result<Job, ViewError> {
        let job = Job::new(&*self.render_args("-")?, Path::new("-"))?;
        Ok(Job { source: job.source.without_bricks("the viewer")?, ..job })
    }
}

enum Refusal {
    Clap(clap::Error),
    Other(ViewError),
}

fn of_clap(error: &clap::Error) -> ViewError {
    let text = error.to_string();
    let message = one_message(&text);
    ViewError::usage(message.strip_prefix("error: ").unwrap_or(message))
}

fn text(word: &std::ffi::OsStr) -> Result<String, ViewError> {
    word.to_str().map(str::to_owned).ok_or_else(|| {
        ViewError::usage(format!(
            "{}: the viewer cannot write this name into a command, because it is not UTF-8; rename it",
            word.to_string_lossy()
        ))
    })
}

/// What a flag decides.
fn decides(name: &str) -> Decides {
    let decides = |flag: &Flag| match flag.group {
        Group::Camera => Decides::Camera,
        Group::Look => Decides::Light,
        Group::Annotation | Group::Output => Decides::Picture,
        _ if flag.name() == "size" => Decides::Picture,
        // `--set` may give any key.
        Group::Input | Group::Structure | Group::Color => Decides::Data,
    };
    let of_device = ["backend", "adapter", "limits", "accel"].contains(&name);
    let other = if of_device { Decides::Picture } else { Decides::Data };
    Flag::of_name(name).map_or(other, decides)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::failure::USAGE;

    fn parsed(words: &[&str]) -> RenderFlags {
        RenderFlags::parse(words).unwrap()
    }

    #[test]
    fn flags_survive_being_written_and_read() {
        let all = [
            "a.pdb",
            "--eye=1,2,-3",
            "--look-at",
            "0,0,-1e-7",
            "--fov",
            "22.5",
            "--style",
            "path",
            "--samples=3",
            "--select",
            "chain == A and z > -3",
            "--bonds",
            "--box=0.2",
            "--color-by",
            "b_factor",
            "--range",
            "-1,5",
            "--label",
            "it's @ 5",
            "--label=two",
            "--legend",
            "--scale-bar",
            "--transparent",
            "--ao",
            "--denoise=false",
            "--cmap-reverse",
            "--frame=0",
            "--size",
            "640x480",
        ];
        let flags = parsed(&all);
        assert_eq!(parsed(&flags.words().iter().map(String::as_str).collect::<Vec<_>>()), flags);
        assert_eq!(flags.get("bonds"), Some(""));
        assert_eq!(flags.get("ao"), Some("4"));
        assert_eq!(flags.get("look-at"), Some("0,0,-1e-7"));
        assert_eq!(flags.words().iter().filter(|word| word.starts_with("--label")).count(), 2);
    }

    #[test]
    fn a_shell_reads_the_words_back() {
        let flags = parsed(&["my file.pdb", "--select", "name == 'C1' or name == $x", "--label", "50% \"a\""]);
        let line = flags.command_line("out put.png");
        let expected = r#"pinhole render 'my file.pdb' '--select=name == '\''C1'\'' or name == $x' '--label=50% "a"' -o 'out put.png'"#;
        assert!(cfg!(windows) || line == expected, "{line}");
    }

    #[test]
    fn only_some_flags_change_the_spheres() {
        let plain = parsed(&["a.pdb"]);
        for flag in ["--style=path", "--view=iso", "--size=9x9", "--legend-title=a", "--bits=16", "--samples=2"] {
            assert!(parsed(&["a.pdb", flag]).has_data_of(&plain), "{flag}");
        }
        for flag in ["--select=x > 1", "--bonds", "--color-by=x", "--frame=1", "--radius=1"] {
            assert!(!RenderFlags { flags: parsed(&["a.xyz", flag]).flags, ..plain.clone() }.has_data_of(&plain));
        }
        let scene = parsed(&["a.toml"]);
        assert!(!parsed(&["a.toml", "--style=path"]).has_data_of(&scene));
        assert!(parsed(&["a.toml", "--zoom=2"]).has_data_of(&scene));
    }

    #[test]
    fn wrong_words_are_refused_in_one_line() {
        for words in [
            &["a.pdb", "--styel", "path"][..],
            &["a.pdb", "--style", "no"],
            &["a.pdb", "--size", "x"],
            &["src/lib.rs"],
            &["-"],
            &["a.pdb", "--eye", "1,2"],
            &["a.pdb", "-o", "a.png"],
            &[],
        ] {
            let error = RenderFlags::parse(words).unwrap_err();
            assert!(!error.to_string().contains('\n') && error.exit_code() == USAGE.into(), "{error}");
        }
    }
}
