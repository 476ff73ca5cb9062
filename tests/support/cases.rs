//! Cases in text files: the files that a command reads, the command, and its answer.
//!
//! ```text
//! $ cat short.xyz
//! 4
//!
//! O 0 0 0
//! $ pinhole render short.xyz -o out.png
//! error: short.xyz: line 1: frame 0 declares 4 atoms, but the file ends after 1
//! ```
//!
//! The text below `$ cat NAME` is that of a file, up to the next line that starts with `$ `. The text below `$ printf
//! NAME` has escapes (`\n`, `\r`, `\t`, `\\`, `\xff`), and the end of its last line is not part of it. The text below
//! `$ pinhole` is the answer. An empty line separates cases.

#![allow(dead_code, reason = "each test program uses some of it")]

use std::path::Path;

/// A command line, and the files that belong to it.
#[derive(Default)]
pub(crate) struct Case<'a> {
    pub(crate) files: Vec<(&'a str, Vec<u8>)>,
    pub(crate) arguments: &'a str,
}

/// Returns the text of a file of cases in which the text below each command is what `answer` returns.
pub(crate) fn answered(text: &str, mut answer: impl FnMut(&Case<'_>) -> String) -> String {
    let starts = text.match_indices("$ ").map(|(at, _)| at);
    let starts = starts.filter(|at| *at == 0 || text[..*at].ends_with('\n'));
    let bounds: Vec<usize> = starts.chain([text.len()]).collect();
    let mut found = String::new();
    let mut case = Case::default();
    for bound in bounds.windows(2) {
        let block = &text[bound[0]..bound[1]];
        let (command, body) = block.split_once('\n').unwrap();
        if let Some(arguments) = command.strip_prefix("$ pinhole ") {
            case.arguments = arguments;
            let end = if bound[1] == text.len() { "" } else { "\n" };
            found += &format!("{command}\n{}{end}", answer(&std::mem::take(&mut case)));
            continue;
        }
        found += block;
        case.files.push(match command.strip_prefix("$ cat ") {
            Some(name) => (name, body.as_bytes().to_vec()),
            None => (command.strip_prefix("$ printf ").unwrap(), bytes(body.trim_end_matches('\n'))),
        });
    }
    assert!(case.files.is_empty(), "the last file belongs to no command");
    found
}

/// The bytes that a text with escapes stands for.
fn bytes(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut letters = text.bytes();
    while let Some(letter) = letters.next() {
        let mut next = || letters.next().unwrap();
        bytes.push(match letter {
            b'\\' => match next() {
                b'n' => b'\n',
                b'r' => b'\r',
                b't' => b'\t',
                b'\\' => b'\\',
                b'x' => {
                    let digits = String::from_iter([next(), next()].map(char::from));
                    u8::from_str_radix(&digits, 16).unwrap()
                }
                other => panic!("\\{} is not an escape", char::from(other)),
            },
            letter => letter,
        });
    }
    bytes
}

/// Compares all files of cases in a folder with what `answer` returns, or rewrites them.
pub(crate) fn compare(folder: &Path, mut answer: impl FnMut(&Case<'_>) -> String) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let file = entry.unwrap().path();
        let text = std::fs::read_to_string(&file).unwrap().replace("\r\n", "\n");
        assert!(text.contains("$ pinhole "), "{} has no cases", file.display());
        let found = answered(&text, &mut answer);
        if std::env::var_os("PINHOLE_UPDATE_SNAPSHOTS").is_some_and(|value| value == "1") {
            std::fs::write(&file, &found).unwrap();
            continue;
        }
        for (found, expected) in found.lines().zip(text.lines()) {
            assert_eq!(found, expected, "{}", file.display());
        }
        assert_eq!(found.len(), text.len(), "{}", file.display());
    }
}
