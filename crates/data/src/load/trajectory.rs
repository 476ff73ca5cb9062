//! Trajectories: the frames of a file, or of several files.

use std::path::{Path, PathBuf};

use super::dataset::Dataset;
use super::error::{LoadError, LoadErrorKind, Place};
use super::file_set::FileSet;
use super::format::{Format, Options};
use super::open::{OpenFile, open_file};
use super::together::open_together;

/// Reads a file of spheres. Its format is the one in the options, or else follows from the extension, or else from the
/// content. Only the wanted frame of a file with several frames, or of a [`FileSet`], is in memory; [`Trajectory`] reads
/// several. The files of a set that are no frames are put together, unless the options ask for a frame.
///
/// # Errors
/// Returns an error if the file cannot be read, its format is not known, or an option does not apply to it.
pub fn open(path: impl AsRef<Path>, options: &Options) -> Result<Dataset, LoadError> {
    let path = path.as_ref();
    if let Some(set) = FileSet::together(path).filter(|_| options.frame.is_none()) {
        return open_together(&set, options);
    }
    let frame = options.frame.unwrap_or_default();
    if FileSet::is_one(path) || frame > 0 {
        match Trajectory::open_up_to(path, options) {
            Err(error) if error.kind == LoadErrorKind::NoFrames => {}
            found => return found?.into_frame(frame),
        }
    }
    open_file(path, options)
}

/// The frames of a file, or of the files of a [`FileSet`]. [`Trajectory::frame`] reads one of them; the others are not in
/// memory.
#[derive(Debug)]
pub struct Trajectory {
    /// Is true if one name stands for the files.
    is_set: bool,
    files: Vec<FileFrames>,
    options: Options,
    /// The place of the file that was opened last, which is open if it has frames.
    last: (usize, Option<OpenFile>),
    problem: Option<LoadError>,
    /// The radius of all spheres in the first frame and the note about it, if the file gives none. So they keep their sizes.
    radius: Option<(f64, String)>,
}

/// The frames of one file.
#[derive(Debug)]
struct FileFrames {
    path: PathBuf,
    /// Is true if the file is of a format that has frames. Others are one frame of several files.
    has_frames: bool,
    /// The number of frames of the files before.
    before: usize,
    count: usize,
    /// The bytes of the largest frame.
    bytes: u64,
}

impl Trajectory {
    /// Opens a file or a [`FileSet`], and finds its frames, in one pass over each file. Its format is the one in the
    /// options, or else follows from the extension, or else from the content. The other options apply to every frame.
    ///
    /// If a file ends within a frame, such as one that a program is still writing, the frames before it can be read, and
    /// [`Trajectory::problem`] has the error.
    ///
    /// # Errors
    /// Returns an error if a file cannot be read, its format is not known or has no frames, an option does not apply
    /// to it, or not even the first frame is complete.
    pub fn open(path: impl AsRef<Path>, options: &Options) -> Result<Self, LoadError> {
        Self::find(path.as_ref(), options, None)
    }

    /// Opens a file like [`Trajectory::open`], and finds its frames up to the one in the options or else the first.
    ///
    /// # Errors
    /// Returns an error if there is no such frame, or for the reasons of [`Trajectory::open`].
    pub fn open_up_to(path: impl AsRef<Path>, options: &Options) -> Result<Self, LoadError> {
        let wanted = options.frame.unwrap_or_default();
        let found = Self::find(path.as_ref(), options, Some(wanted))?;
        let frames = found.len();
        if wanted < frames {
            return Ok(found);
        }
        Err(found.problem.unwrap_or_else(|| LoadError::no_such_frame(wanted, frames)))
    }

    fn find(path: &Path, options: &Options, last: Option<usize>) -> Result<Self, LoadError> {
        let options = Options { frame: None, ..options.clone() };
        let set = FileSet::of(path)?;
        let is_set = set.is_some();
        // Files that are no frames of one trajectory have formats of their own.
        let format = options.format.filter(|_| set.as_ref().is_none_or(FileSet::are_frames));
        let options = Options { format, ..options };
        let mut found = Self { is_set, files: Vec::new(), options, last: (0, None), problem: None, radius: None };
        match set {
            None => found.add(path, last)?,
            Some(set) => {
                for file in set.files() {
                    let is_enough = last.is_some_and(|last| last < found.len());
                    if is_enough || found.problem.is_some() {
                        break;
                    }
                    let added = found.add_of_set(file, last.map(|last| last - found.len()));
                    match added {
                        // A program may have begun to write the last file.
                        Err(problem) if !found.is_empty() && problem.kind != LoadErrorKind::Io => {
                            found.problem = Some(problem);
                        }
                        added => added?,
                    }
                }
            }
        }
        Ok(found)
    }

    /// Adds a file, and finds its frames up to the last that is wanted.
    fn add(&mut self, path: &Path, last: Option<usize>) -> Result<(), LoadError> {
        let file = OpenFile::find(path, &self.options, last).map_err(|error| self.named(path, error))?;
        let (before, count) = (self.len(), file.len());
        let bytes = (0..count).filter_map(|frame| file.frame_bytes(frame)).max().unwrap_or_default();
        self.problem = file.problem().map(|problem| self.named(path, problem.clone()));
        self.last = (self.files.len(), Some(file));
        self.files.push(FileFrames { path: path.to_path_buf(), has_frames: true, before, count, bytes });
        Ok(())
    }

    /// Adds a file of several, which is one frame if its format has none.
    fn add_of_set(&mut self, path: &Path, last: Option<usize>) -> Result<(), LoadError> {
        let in_file = |error: std::io::Error| LoadError::from(error).in_file(path);
        let format = self.options.format.map_or_else(|| Format::of_path(path), |format| Ok(Some(format)));
        if format.map_err(in_file)?.is_none_or(Format::has_frames) {
            return self.add(path, last);
        }
        let bytes = path.metadata().map_err(in_file)?.len();
        let file = FileFrames { path: path.to_path_buf(), has_frames: false, before: self.len(), count: 1, bytes };
        self.files.push(file);
        Ok(())
    }

    /// Number of complete frames.
    #[must_use]
    pub fn len(&self) -> usize {
        self.files.last().map_or(0, |file| file.before + file.count)
    }

    /// Returns true if there is no frame, which is so of no trajectory that was opened.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The files, in the order of their frames.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(|file| file.path.as_path())
    }

    /// The error after the last complete frame, if there is one.
    #[must_use]
    pub fn problem(&self) -> Option<&LoadError> {
        self.problem.as_ref()
    }

    /// Number of bytes of a frame, or of the largest in its file; `None` if there is no such frame.
    #[must_use]
    pub fn frame_bytes(&self, index: usize) -> Option<u64> {
        let place = self.place(index).ok()?;
        let (file, within) = (&self.files[place], index - self.files[place].before);
        let of_open = self.last.1.as_ref().filter(|_| self.last.0 == place).and_then(|open| open.frame_bytes(within));
        Some(of_open.unwrap_or(file.bytes))
    }

    /// The file of a frame.
    fn place(&self, index: usize) -> Result<usize, LoadError> {
        let place = self.files.partition_point(|file| file.before + file.count <= index);
        (place < self.files.len()).then_some(place).ok_or_else(|| LoadError::no_such_frame(index, self.len()))
    }

    /// An error of one of several files, with its name.
    fn named(&self, path: &Path, error: LoadError) -> LoadError {
        match error.place {
            Place::File(_) => error,
            _ if self.is_set => LoadError::new(format!("{}: {error}", path.display())).of_kind(error.kind),
            _ => error,
        }
    }

    /// Reads one frame, counted from 0.
    ///
    /// # Errors
    /// Returns an error if there is no such frame, or it cannot be read. Lines are counted from the start of the file.
    pub fn frame(&mut self, index: usize) -> Result<Dataset, LoadError> {
        let mut loaded = self.read(index)?;
        self.keep_radius(index, &mut loaded)?;
        Ok(loaded)
    }

    /// Gives spheres of a frame without radii those of the first frame.
    fn keep_radius(&mut self, index: usize, loaded: &mut Dataset) -> Result<(), LoadError> {
        if loaded.guessed_radius().is_none() {
            return Ok(());
        }
        if self.radius.is_none() {
            self.radius = match index {
                0 => loaded.guessed_radius(),
                _ => self.read(0)?.guessed_radius(),
            };
        }
        if let Some((radius, note)) = &self.radius {
            loaded.give_radius(Some(*radius));
            loaded.notes.push(note.clone());
        }
        Ok(())
    }

    fn read(&mut self, index: usize) -> Result<Dataset, LoadError> {
        let place = self.place(index)?;
        let file = &self.files[place];
        let read = match &mut self.last {
            _ if !file.has_frames => open_file(&file.path, &self.options),
            (last, Some(open)) if *last == place => open.frame(index - file.before),
            last => OpenFile::find(&file.path, &self.options, None).and_then(|mut open| {
                let loaded = open.frame(index - file.before);
                *last = (place, Some(open));
                loaded
            }),
        };
        let mut loaded = read.map_err(|error| self.named(&self.files[place].path, error))?;
        if self.is_set {
            // A file does not know how many others have.
            loaded.frames = None;
        }
        Ok(loaded)
    }

    /// Reads one frame, counted from 0, and checks that the frames are followed by the end of the file or by another
    /// frame, because a wrong number of atoms shows there. A fault after complete frames of binary data is only a note.
    ///
    /// # Errors
    /// Returns the errors of [`Trajectory::frame`], and then [`Trajectory::problem`].
    pub fn into_frame(mut self, index: usize) -> Result<Dataset, LoadError> {
        let place = self.place(index)?;
        let mut loaded = match self.last.1.take_if(|_| self.last.0 == place) {
            Some(open) => {
                let file = &self.files[place];
                let read = open.into_frame(index - file.before);
                read.map_err(|error| self.named(&file.path, error))?
            }
            None => self.read(index)?,
        };
        self.keep_radius(index, &mut loaded)?;
        Ok(loaded)
    }
}
