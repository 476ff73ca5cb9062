//! Runs the program in an empty folder.

use std::path::PathBuf;
use std::process::{Command, Output};

use tempfile::TempDir;

pub(crate) const WATER: &str = "3\nwater\nO 0 0 0.1\nH 0.76 0 -0.5\nH -0.76 0 -0.5\n";

pub(crate) const SCENE: &str = "[film]\nwidth = 40\nheight = 30\n\
                                [[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = 'red'\n";

/// A separate folder for each test, which is removed at the end.
pub(crate) struct Folder {
    folder: TempDir,
}

/// The results of a run of the program.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) code: i32,
    pub(crate) stdout: Vec<u8>,
    /// Standard error without the line about the picture.
    pub(crate) stderr: String,
    /// The line about the picture: input, look and time.
    pub(crate) said: Option<String>,
}

impl Folder {
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    pub(crate) fn with(files: &[(&str, &str)]) -> Self {
        let folder = Self::new();
        for (name, contents) in files {
            std::fs::write(folder.path(name), contents).unwrap();
        }
        folder
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap()
    }

    /// Names of all files, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(self.folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    /// Runs `pinhole` with arguments that are separated by spaces.
    pub(crate) fn run(&self, arguments: &str) -> Run {
        let output = self.command(arguments).output().unwrap();
        Run::new(output)
    }

    /// Runs `pinhole`, which must end with this exit code and one line that has these words, and change no file.
    #[track_caller]
    pub(crate) fn refuses(&self, arguments: &str, code: i32, words: &str) {
        let before = self.files();
        self.run(arguments).refused(code, words);
        assert_eq!(self.files(), before, "{arguments}");
    }

    /// Runs `pinhole` like [`Folder::run`], but the Vulkan loader finds no driver.
    pub(crate) fn run_without_drivers(&self, arguments: &str) -> Run {
        let mut command = self.command(arguments);
        for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
            command.env(variable, self.path("no-driver.json"));
        }
        Run::new(command.output().unwrap())
    }

    /// Runs `pinhole` while files may have this number of blocks, of 512 or 1024 bytes, as on a full disk.
    #[cfg(unix)]
    pub(crate) fn run_with_blocks(&self, blocks: u32, arguments: &str) -> Run {
        let program = env!("CARGO_BIN_EXE_pinhole");
        let script = format!("ulimit -f {blocks}; exec {program} {arguments}");
        let mut shell = Command::new("sh");
        Run::new(shell.args(["-c", &script]).current_dir(self.path("")).output().unwrap())
    }

    pub(crate) fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pinhole"));
        command.current_dir(self.folder.path()).args(arguments.split_whitespace());
        // These variables may be set so that the tests of adapters run on another one.
        for variable in ["WGPU_ADAPTER_NAME", "WGPU_BACKEND", "WGPU_POWER_PREF"] {
            command.env_remove(variable);
        }
        command
    }
}

impl Run {
    fn new(output: Output) -> Self {
        let text = String::from_utf8(output.stderr).unwrap();
        let is_said = |line: &&str| {
            !line.starts_with("note: ") && line.ends_with(" s") && (line.contains(" sphere") || line.contains(" atom"))
        };
        let said = text.lines().last().filter(is_said).map(str::to_owned);
        let length = said.as_ref().map_or(0, |line| line.len() + 1);
        Self {
            code: output.status.code().unwrap_or_else(|| panic!("killed by a signal")),
            stdout: output.stdout,
            stderr: text[..text.len() - length].to_owned(),
            said,
        }
    }

    /// Checks that the run ended with this exit code and one line that has these words.
    #[track_caller]
    pub(crate) fn refused(&self, code: i32, words: &str) -> &Self {
        let said = &self.stderr;
        assert_eq!(self.code, code, "{said}");
        assert!(said.starts_with("error: ") && said.contains(words), "{said} lacks {words}");
        assert_eq!(said.lines().count(), 1, "{said}");
        self
    }

    #[track_caller]
    pub(crate) fn succeeded(self) -> Self {
        assert_eq!(self.code, 0, "{}", self.stderr);
        self
    }
}

/// Sends a signal to a process.
#[cfg(unix)]
pub(crate) fn send(signal: &str, to: &std::process::Child) {
    let status = Command::new("kill").args([signal, &to.id().to_string()]).status().unwrap();
    assert!(status.success());
}

/// Width, height and RGB bytes of a PNG.
pub(crate) fn decode(png: &[u8]) -> (u32, u32, Vec<u8>) {
    let image = image::load_from_memory_with_format(png, image::ImageFormat::Png).unwrap().to_rgb8();
    (image.width(), image.height(), image.into_raw())
}
