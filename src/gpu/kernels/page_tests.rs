//! Tests of the comments at the start of parts, and of the tables in `shaders/README.md` that are generated from them.
//!
//! The comment of a part contains its purpose, then `provides:` and `needs:`, and for an entry point `dispatched:`.
//! After a change of parts, `PINHOLE_UPDATE_SHADERS=1 cargo test -p pinhole --lib kernels::page` generates the lists
//! and the tables.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use super::all_sources;
use super::declarations::Declarations;
use super::tests::files;
use crate::gpu::shader::{VARIANT, variants};

type Names = BTreeSet<String>;

/// Maximum width of a generated line.
const WIDTH: usize = 120;

/// The names and entry points of a part, found from the kernels that use it.
#[derive(Default)]
struct PartNames {
    provides: Names,
    needs: Names,
    entry_points: Names,
}

fn known_parts() -> BTreeMap<String, PartNames> {
    let mut known: BTreeMap<String, PartNames> = BTreeMap::new();
    for kernel in all_sources() {
        let parts: Vec<_> = kernel.parts.iter().map(|part| (part.name, Declarations::of(&part.source))).collect();
        for (name, own) in &parts {
            let part = known.entry((*name).to_owned()).or_default();
            part.entry_points.insert(kernel.entry_point.to_owned());
            let is_entry = |name: &&String| *name == kernel.entry_point;
            part.provides.extend(own.global.iter().filter(is_entry).cloned());
            for (_, other) in parts.iter().filter(|(other, _)| other != name) {
                part.provides.extend(own.global.intersection(&other.used).cloned());
                part.needs.extend(own.used.intersection(&other.global).cloned());
            }
        }
    }
    known
}

/// A comment with a word and a list of names, wrapped.
fn list(word: &str, names: &Names) -> String {
    if names.is_empty() {
        return String::new();
    }
    let mut text = format!("// {word}:");
    let mut width = text.len();
    for (i, name) in names.iter().enumerate() {
        let comma = if i + 1 < names.len() { "," } else { "" };
        if width + name.len() + 2 > WIDTH {
            text += "\n//  ";
            width = 4;
        }
        write!(text, " {name}{comma}").unwrap();
        width += name.len() + 1 + comma.len();
    }
    text + "\n"
}

/// A source without its lists of provided and needed names.
fn without_lists(source: &str) -> String {
    let mut is_list = false;
    source
        .lines()
        .filter(|line| {
            is_list = line.starts_with("// provides:")
                || line.starts_with("// needs:")
                || (is_list && line.starts_with("//   "));
            !is_list
        })
        .flat_map(|line| [line, "\n"])
        .collect()
}

/// A source with the lists of provided and needed names after its first comment.
fn with_lists(source: &str, known: &PartNames) -> String {
    let source = without_lists(source);
    let comment: usize = source.split_inclusive('\n').take_while(|line| line.starts_with("//")).map(str::len).sum();
    let (comment, rest) = source.split_at(comment);
    let lists = list("provides", &known.provides) + &list("needs", &known.needs);
    let blank = if rest.starts_with('\n') { "" } else { "\n" };
    format!("{comment}{lists}{blank}{rest}")
}

fn expected_file(file: &str, text: &str, known: &BTreeMap<String, PartNames>) -> String {
    let variants: Vec<_> = variants(text).collect();
    if variants.is_empty() {
        return with_lists(text, &known[file]);
    }
    let head = &text[..text.find(&format!("\n{VARIANT}")).unwrap() + 1];
    variants.iter().fold(head.to_owned(), |all, (name, source, _)| {
        let part = with_lists(source, &known[&format!("{file}#{name}")]);
        format!("{all}{VARIANT}{name}\n{part}")
    })
}

/// The first sentence of a comment, on one line.
fn first_sentence(comment: &str) -> String {
    let lines = comment.lines().map_while(|line| line.strip_prefix("//"));
    let lines = lines.map(str::trim).take_while(|line| !line.is_empty() && !line.contains(": by "));
    let text = lines.collect::<Vec<_>>().join(" ");
    let end = text.find(". ").map_or(text.len(), |at| at + 1);
    text[..end].trim_end_matches('.').to_owned()
}

fn code(names: &Names) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// The rest of the first line that starts with `start`.
fn after<'a>(text: &'a str, start: &str) -> &'a str {
    text.lines().find_map(|line| line.strip_prefix(start)).unwrap_or_default().trim_end_matches('.')
}

fn kernel_table(known: &BTreeMap<String, PartNames>, files: &BTreeMap<String, String>) -> String {
    let mut table = "| entry point | file | what it finds or does | dispatched |\n|---|---|---|---|\n".to_owned();
    let entry_points: Names = all_sources().iter().map(|k| k.entry_point.to_owned()).collect();
    for entry_point in entry_points {
        let (file, _) = known.iter().find(|(_, part)| part.provides.contains(&entry_point)).unwrap();
        let dispatched = after(&files[file], "// dispatched: ");
        assert!(!dispatched.is_empty(), "{file} does not say when it is dispatched");
        let what = first_sentence(&files[file]);
        writeln!(table, "| `{entry_point}` | `{file}` | {what} | {dispatched} |").unwrap();
    }
    table
}

fn part_table(known: &BTreeMap<String, PartNames>, files: &BTreeMap<String, String>) -> String {
    let mut table = "| part | what it is | provides | needs | in |\n|---|---|---|---|---|\n".to_owned();
    for (name, part) in known {
        let (file, variant) = name.split_once('#').unwrap_or((name, ""));
        let text = &files[file];
        let source = variants(text).find(|(found, ..)| *found == variant).map(|(_, text, _)| text);
        let what = first_sentence(source.unwrap_or(text));
        assert!(!what.is_empty(), "{name} does not say what it is");
        let [provides, needs, kernels] = [&part.provides, &part.needs, &part.entry_points].map(code);
        writeln!(table, "| `{name}` | {what} | {provides} | {needs} | {kernels} |").unwrap();
    }
    table
}

fn binding_table() -> String {
    type Row = (u32, u32, String);
    let mut rows: BTreeMap<Row, (String, Names)> = BTreeMap::new();
    for kernel in all_sources() {
        for part in &kernel.parts {
            let lines: Vec<&str> = part.source.lines().collect();
            for (at, line) in lines.iter().enumerate() {
                let Some(rest) = line.strip_prefix("@group(") else { continue };
                let (group, rest) = rest.split_once(") @binding(").unwrap();
                let (binding, rest) = rest.split_once(") ").unwrap();
                let name = rest.split_once(':').unwrap().0.rsplit(' ').next().unwrap();
                let comment = lines[..at].iter().rev().take_while(|line| line.starts_with("//"));
                let first = at - comment.count();
                let what = first_sentence(&(lines[first..at].join("\n") + "\n"));
                assert!(!what.is_empty(), "{}: {name} has no comment", part.name);
                let key = (group.parse().unwrap(), binding.parse().unwrap(), name.to_owned());
                let row = rows.entry(key).or_insert((what.clone(), Names::new()));
                if what.len() > row.0.len() {
                    row.0 = what;
                }
                row.1.insert(kernel.entry_point.to_owned());
            }
        }
    }
    let mut table = "| group, binding | name | holds | in |\n|---|---|---|---|\n".to_owned();
    for ((group, binding, name), (what, kernels)) in rows {
        let kernels = code(&kernels);
        writeln!(table, "| {group}, {binding} | `{name}` | {what} | {kernels} |").unwrap();
    }
    table
}

/// The page with its tables, each of which is between a pair of marks.
fn expected_page(page: &str, tables: &[(&str, String)]) -> String {
    tables.iter().fold(page.to_owned(), |page, (name, table)| {
        let (start, end) = (format!("<!-- {name} -->\n"), "<!-- end -->");
        let (head, rest) = page.split_once(&start).unwrap_or_else(|| panic!("no mark {name}"));
        let (_, tail) = rest.split_once(end).unwrap();
        format!("{head}{start}{table}{end}{tail}")
    })
}

#[test]
fn parts_say_what_they_provide_and_need_and_the_readme_lists_them() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let (known, files) = (known_parts(), files());
    let mut expected: Vec<(PathBuf, String)> =
        files.iter().map(|(file, text)| (root.join(file), expected_file(file, text, &known))).collect();
    let page = std::fs::read_to_string(root.join("README.md")).unwrap();
    let tables = [
        ("kernels", kernel_table(&known, &files)),
        ("parts", part_table(&known, &files)),
        ("bindings", binding_table()),
    ];
    expected.push((root.join("README.md"), expected_page(&page, &tables)));
    for (path, text) in expected {
        if std::fs::read_to_string(&path).unwrap() == text {
            continue;
        }
        assert!(
            std::env::var_os("PINHOLE_UPDATE_SHADERS").is_some(),
            "{} is not up to date; run this test with PINHOLE_UPDATE_SHADERS=1",
            path.display()
        );
        std::fs::write(&path, text).unwrap();
    }
}

#[test]
fn lists_are_replaced() {
    let known = PartNames {
        provides: ["a".to_owned()].into(),
        needs: (0..40).map(|i| format!("name_{i:02}")).collect(),
        entry_points: Names::new(),
    };
    let source = "// What it is.\n// provides: old\n// needs: older,\n//   oldest\n\nfn a() {}\n";
    let found = with_lists(source, &known);
    assert!(found.starts_with("// What it is.\n// provides: a\n// needs: name_00,"), "{found}");
    assert!(found.ends_with("name_39\n\nfn a() {}\n") && !found.contains("old"), "{found}");
    assert!(found.lines().all(|line| line.len() <= WIDTH));
    assert_eq!(with_lists(&found, &known), found);
    assert_eq!(first_sentence("// One thing. Another.\n"), "One thing");
}
