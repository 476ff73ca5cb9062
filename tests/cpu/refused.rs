//! Files of data and scene files that are refused: those of the cases in `tests/files/refused`, with the error that each must give. The tests
//! of the program run the same cases, and rewrite them; see CONTRIBUTING.md.

use std::path::Path;

use pinhole::load::{self, Options};
use pinhole::scene_file::{IntegratorKind, SceneFile, SceneFileError};

use crate::cases::{Case, answered};

#[test]
fn refused_files() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/files/refused");
    for entry in std::fs::read_dir(folder).unwrap() {
        let file = entry.unwrap().path();
        let text = std::fs::read_to_string(&file).unwrap().replace("\r\n", "\n");
        let found = answered(&text, answer);
        for (found, expected) in found.lines().zip(text.lines()) {
            assert_eq!(found, expected, "{}", file.display());
        }
        assert_eq!(found.len(), text.len(), "{}", file.display());
    }
}

/// The first error, whether it appears in parsing, in the scene, in its camera or in the settings.
fn scene_file_error(text: &str) -> Option<SceneFileError> {
    let settings = || {
        let file = SceneFile::parse(text)?;
        let scene = file.scene(&[])?;
        let camera = file.camera(&file.film, &scene)?;
        let kind = file.integrator().unwrap_or(IntegratorKind::Studio);
        file.settings(kind, &scene, camera.as_ref(), None)
    };
    settings().err()
}

/// What the program says to a file that cannot be read.
fn answer(Case { files, arguments }: &Case<'_>) -> String {
    let [(name, bytes)] = &files[..] else { panic!("{arguments}: not one file") };
    if name.ends_with(".toml") {
        let error = scene_file_error(str::from_utf8(bytes).unwrap()).unwrap();
        return format!("exit code 1\nerror: {name}: {error}\n");
    }
    let words = arguments.split(' ');
    let flag = |name| words.clone().skip_while(|word| *word != name).nth(1);
    let mut options = Options::default();
    options.frame = flag("--frame").map(|frame| frame.parse().unwrap());
    options.radius = flag("--radius").map(|radius| radius.parse().unwrap());
    options.columns = flag("--columns")
        .map_or_else(Vec::new, |names| names.split(',').map(str::to_owned).collect());
    let error = load::from_bytes(bytes, name, &options).unwrap_err();
    // A radius that contradicts the file is wrong usage.
    let code = if options.radius.is_some() { 2 } else { 1 };
    format!("exit code {code}\nerror: {name}: {error}\n")
}
