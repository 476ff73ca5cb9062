//! Limits on the size of the code. `budgets.txt` has a number for each folder, and for other things that tend to grow
//! unnoticed. A change may lower a number. Anyone who raises one must write a reason behind it.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::circles::circles;
use super::sources::{ROOT, sources};

const FILE: &str = "tests/guards/budgets.txt";

/// Returns the current amount for a budget, by its name, and a list that helps to reduce it, which may be empty.
fn amount(what: &str) -> (usize, String) {
    let lines = |folder: &str| -> usize { sources(folder).iter().map(|(_, text)| text.lines().count()).sum() };
    match what.split_once(' ').unwrap_or((what, "")) {
        ("lines", folder) => (lines(folder), String::new()),
        ("files", folder) => (sources(folder).len(), String::new()),
        ("circles", folder) => circles(folder),
        ("features", _) => {
            let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
            let features = manifest.split("\n[features]\n").nth(1).unwrap();
            let features = features.split("\n[").next().unwrap().lines();
            let is_feature = |line: &&str| line.contains(" = ") && !line.starts_with(['#', ' ']);
            (features.filter(is_feature).filter(|line| !line.starts_with("default ")).count(), String::new())
        }
        _ => panic!("{FILE}: `{what}` is not a budget"),
    }
}

fn root() -> &'static Path {
    Path::new(ROOT)
}

/// With `PINHOLE_UPDATE_BUDGETS=1`, numbers are lowered to the current amounts.
#[test]
fn nothing_is_larger_than_its_budget() {
    let text = fs::read_to_string(root().join(FILE)).unwrap();
    let (mut lowered, mut wrong) = (String::new(), String::new());
    let mut seen = BTreeMap::new();
    for (index, line) in text.lines().enumerate() {
        if line.is_empty() || line.starts_with('#') {
            lowered += &format!("{line}\n");
            continue;
        }
        let place = format!("{FILE}:{}", index + 1);
        let (row, reason) = line.split_once('#').unwrap_or((line, ""));
        let (what, most) = row.trim_end().rsplit_once(' ').expect("a budget and its number");
        let what = what.trim_end();
        let most: usize = most.parse().unwrap_or_else(|_| panic!("{place}: a number is missing"));
        assert!(seen.insert(what, most).is_none(), "{place}: `{what}` stands there twice");
        let (now, list) = amount(what);
        if now > most {
            wrong += &format!("{place}: {what}: {now}, of which {most} are allowed\n{list}");
        } else if now + most / 20 + 20 < most {
            wrong += &format!("{place}: {what}: {now}; lower the budget of {most}\n");
        }
        let reason = if reason.is_empty() { String::new() } else { format!(" #{reason}") };
        lowered += &format!("{what} {}{reason}\n", now.min(most));
    }
    if std::env::var_os("PINHOLE_UPDATE_BUDGETS").is_some() {
        fs::write(root().join(FILE), lowered).unwrap();
        return;
    }
    assert!(wrong.is_empty(), "{wrong}PINHOLE_UPDATE_BUDGETS=1 lowers numbers to what there is");
}
