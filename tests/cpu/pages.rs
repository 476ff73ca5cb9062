//! Pages for people: every link has a target, and every page is linked.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Markdown files: those in some folders, and all below `docs`.
fn pages() -> Vec<PathBuf> {
    let folders = ["", "cli", "docs", "examples/hosts", "python", "python/gallery", "shaders", "viewer"];
    let mut folders = folders.map(|folder| root().join(folder)).to_vec();
    let mut pages = Vec::new();
    while let Some(folder) = folders.pop() {
        let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let (below, files): (Vec<_>, Vec<_>) = paths.partition(|path| path.is_dir());
        folders.extend(below.into_iter().filter(|path| path.starts_with(root().join("docs"))));
        pages.extend(files.into_iter().filter(|path| path.extension().is_some_and(|e| e == "md")));
    }
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
    let prose: Vec<String> = lines(text).map(|line| line.split('`').step_by(2).collect::<String>()).collect();
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

/// The file that a link of a page names.
fn target(page: &Path, link: &str) -> PathBuf {
    let (file, _) = link.split_once('#').unwrap_or((link, ""));
    if file.is_empty() { page.to_owned() } else { page.parent().unwrap().join(file) }
}

/// What is wrong with a link of a page.
fn fault(page: &Path, link: &str) -> Option<&'static str> {
    if link.contains("://") || link.starts_with("mailto:") {
        return None;
    }
    let (_, anchor) = link.split_once('#').unwrap_or((link, ""));
    // A package page puts the repository's address before a link.
    if link.starts_with('/') {
        return Some("is not relative");
    }
    let target = target(page, link);
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

/// Files of Rust and WGSL that a page names in backticks are there: by their path from the top, from `src` or `shaders`.
#[test]
fn named_files_exist() {
    let mut count = 0;
    for page in pages().iter().filter(|page| !page.ends_with("CHANGELOG.md")) {
        let text = fs::read_to_string(page).unwrap();
        for line in lines(&text) {
            for name in line.split('`').skip(1).step_by(2) {
                let is_file = name.ends_with(".rs") || name.ends_with(".wgsl");
                if !is_file || !name.contains('/') || name.contains(['*', ' ']) || name.contains("NAME") {
                    continue;
                }
                let folders = ["", "src", "shaders"];
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
        ("docs/how-to/verify.md", None),
        ("#two-commands", None),
        ("https://example.com/no#such", None),
        ("/docs/how-to/verify.md", Some("is not relative")),
        ("docs/none.md", Some("leads nowhere")),
        ("docs/how-to/verify.md#none", Some("names no heading")),
    ] {
        assert_eq!(fault(&page, link), expected, "{link}");
    }
}

/// The README, the pages that it links to, the pages that these link to, and so on, are all pages below `docs`.
#[test]
fn the_readme_leads_to_every_page() {
    let (mut found, mut next) = (BTreeSet::new(), vec![root().join("README.md")]);
    while let Some(page) = next.pop().map(|page| page.canonicalize()) {
        // Addresses are not files.
        let Ok(page) = page else { continue };
        if page.extension().is_some_and(|e| e == "md") && found.insert(page.clone()) {
            let text = fs::read_to_string(&page).unwrap();
            next.extend(links(&text).iter().map(|link| target(&page, link)));
        }
    }
    let docs = root().join("docs");
    for page in pages().iter().filter(|page| page.starts_with(&docs)) {
        let is_found = found.contains(&page.canonicalize().unwrap());
        assert!(is_found, "no link leads from README.md to {}", page.display());
    }
}
