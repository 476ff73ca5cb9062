//! Files on a command line: which words are files, and what several of them are together.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use super::Reader;
use crate::terminal::failure::Failure;
use crate::terminal::text::in_quotes;
use pinhole_data::load::{FileSet, Format};
use pinhole_figure::settings::flags::Flag;

/// Endings of pictures, which a shell puts among the files of a pattern.
const PICTURES: [&str; 6] = ["apng", "exr", "gif", "json", "mp4", "png"];

impl Reader<'_> {
    /// If no other word is the file, turns the value of a flag that needs none into it.
    pub(super) fn give_back_file(&mut self) {
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
    pub(super) fn name_topology(&mut self) {
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
    pub(super) fn join_files(&mut self) {
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
    pub(super) fn refuse_more_files(&self) -> Result<(), Failure> {
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
}
