//! Pages for people: every link has a target, and every page is linked.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The Markdown files at the top, and those in the folders that have some.
fn pages() -> Vec<PathBuf> {
    let folders =
        ["", "cli", "docs", "examples/hosts", "python", "python/gallery", "shaders", "viewer"];
    let entries = folders.iter().flat_map(|folder| fs::read_dir(root().join(folder)).unwrap());
    let paths = entries.map(|entry| entry.unwrap().path());
    let mut pages: Vec<PathBuf> =
        paths.filter(|path| path.extension().is_some_and(|extension| extension == "md")).collect();
    pages.sort();
    pages
}

/// The lines that are not in fenced blocks of code.
fn lines(text: &str) -> impl Iterator<Item = &str> {
    let mut is_code = false;
    text.lines().filter(move |line| {
        let is_fence = line.starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence
    })
}

/// The links of a page. Code in backticks has no links.
fn links(text: &str) -> Vec<String> {
    let prose: Vec<String> =
        lines(text).map(|line| line.split('`').step_by(2).collect::<String>()).collect();
    let prose = prose.join("\n");
    let ends = prose.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    ends.map(str::to_owned).collect()
}

/// The names that GitHub gives a page's headings in links: small letters, hyphens for blanks, no punctuation.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings = lines(text).filter_map(|line| line.strip_prefix('#'));
    headings
        .map(|heading| {
            let words = heading.trim_start_matches('#').trim().to_lowercase();
            let kept = words.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
            kept.map(|c| if c == ' ' { '-' } else { c }).collect()
        })
        .collect()
}

/// The fault of a link of a page.
fn fault(page: &Path, link: &str) -> Option<&'static str> {
    if link.contains("://") || link.starts_with("mailto:") {
        return None;
    }
    let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
    // A package page puts the repository's address before a link.
    if file.starts_with('/') {
        return Some("is not relative");
    }
    let target = if file.is_empty() { page.to_owned() } else { page.parent().unwrap().join(file) };
    if !target.exists() {
        return Some("leads nowhere");
    }
    let is_heading = || anchors(&fs::read_to_string(&target).unwrap()).contains(anchor);
    (!anchor.is_empty() && !is_heading()).then_some("names no heading")
}

#[test]
fn links_lead_somewhere() {
    let mut count = 0;
    for page in pages() {
        for link in links(&fs::read_to_string(&page).unwrap()) {
            if let Some(fault) = fault(&page, &link) {
                panic!("{}: {link} {fault}", page.display());
            }
            count += 1;
        }
    }
    assert!(count > 60, "{count}");
}

/// Files of Rust and WGSL that a page names in backticks exist, by their path from the top, or in one of the folders
/// that a page may leave out.
#[test]
fn named_files_exist() {
    let mut count = 0;
    for page in pages().iter().filter(|page| !page.ends_with("CHANGELOG.md")) {
        let text = fs::read_to_string(page).unwrap();
        for line in lines(&text) {
            for name in line.split('`').skip(1).step_by(2) {
                let is_file = name.ends_with(".rs") || name.ends_with(".wgsl");
                if !is_file
                    || !name.contains('/')
                    || name.contains(['*', ' '])
                    || name.contains("NAME")
                {
                    continue;
                }
                let folders = ["", "src", "shaders", "cli", "cli/src"];
                let is_there = folders.iter().any(|folder| root().join(folder).join(name).exists());
                assert!(is_there, "{}: {name} is not there", page.display());
                count += 1;
            }
        }
    }
    assert!(count > 100, "{count}");
}

#[test]
fn broken_links_are_found() {
    let page = root().join("README.md");
    assert_eq!(links("[a](b.md) `[c](d)`\n```\n[e](f)\n```\n[g](#h)"), ["b.md", "#h"]);
    for (link, expected) in [
        ("docs/verify.md", None),
        ("#two-commands", None),
        ("https://example.com/no#such", None),
        ("/docs/verify.md", Some("is not relative")),
        ("docs/none.md", Some("leads nowhere")),
        ("docs/verify.md#none", Some("names no heading")),
    ] {
        assert_eq!(fault(&page, link), expected, "{link}");
    }
}

#[test]
fn the_readme_leads_to_every_page() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    for page in pages().iter().filter(|page| page.parent() == Some(&root().join("docs"))) {
        let name = page.file_name().unwrap().to_str().unwrap();
        assert!(readme.contains(&format!("](docs/{name})")), "README.md does not link to {name}");
    }
}
