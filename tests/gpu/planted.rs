//! Faults that are planted into shaders: their list, and devices with one of them.

use std::path::Path;
use std::sync::LazyLock;

use libtest_mimic::{Failed, Trial};
use pinhole::gpu::{Headless, HeadlessOptions, Wait};
use pinhole::internals::ShaderEdit;

use crate::support::effort::share;

/// The suites that have faults.
const SUITES: [&str; 12] = [
    "primary",
    "render",
    "paths",
    "paths_by_id",
    "studio",
    "denoised",
    "small",
    "one_pass",
    "samples",
    "composite",
    "limit",
    "live",
];

static LIST: LazyLock<Result<Vec<Fault>, String>> = LazyLock::new(|| parse(include_str!("faults.txt")));

/// A fault of a shader.
#[derive(Clone, Debug)]
pub(crate) struct Fault {
    suite: &'static str,
    pub(crate) name: &'static str,
    /// Other words that its suite needs, such as the scene in which the fault is visible.
    pub(crate) setup: Vec<&'static str>,
    pub(crate) edit: ShaderEdit,
}

impl Fault {
    /// Returns its setup, which must have `COUNT` words.
    pub(crate) fn setup<const COUNT: usize>(&self) -> [&'static str; COUNT] {
        let setup = self.setup.as_slice().try_into();
        setup.unwrap_or_else(|_| panic!("{}: {:?} are not {COUNT} words", self.name, self.setup))
    }

    /// A device that has the fault.
    pub(crate) fn device(&self) -> Result<Headless, Failed> {
        faulty(&self.edit.file, &self.edit.find, &self.edit.replace)
    }
}

/// The faults of a suite.
pub(crate) fn planted(suite: &str) -> impl Iterator<Item = Fault> {
    assert!(SUITES.contains(&suite), "{suite}");
    let all = LIST.as_ref().unwrap_or_else(|refused| panic!("{refused}"));
    all.iter().filter(move |fault| fault.suite == suite).cloned()
}

/// The value with this name in a table.
pub(crate) fn named<T: Copy>(table: &[(&str, T)], name: &str) -> T {
    let found = table.iter().find(|(other, _)| *other == name);
    found.unwrap_or_else(|| panic!("nothing is named {name}")).1
}

/// Tests for some faults, an eighth of which runs by default. Each test opens a device and renders.
pub(crate) fn trials(
    group: &str,
    faults: impl Iterator<Item = Fault>,
    is_found: impl Fn(&Fault) -> Result<(), Failed> + Copy + Send + 'static,
) -> impl Iterator<Item = Trial> {
    share(faults).map(move |fault| Trial::test(format!("{group}{}", fault.name), move || is_found(&fault)))
}

/// Opens a device with an edit of one part of its shaders. `file` may name a variant: `file.wgsl#variant`.
pub(crate) fn faulty(file: &str, find: &str, replace: &str) -> Result<Headless, Failed> {
    check_text(file, find)?;
    let edit = ShaderEdit { file: file.into(), find: find.into(), replace: replace.into() };
    Ok(Headless::open(&HeadlessOptions { edits: vec![edit], ..HeadlessOptions::default() }).wait()?)
}

/// Returns an error if a text to edit is not in its file.
fn check_text(file: &str, text: &str) -> Result<(), Failed> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders").join(file.split('#').next().unwrap_or(file));
    match std::fs::read_to_string(path)?.contains(text) {
        true => Ok(()),
        false => Err(format!("{file} has no `{text}`").into()),
    }
}

fn parse(text: &'static str) -> Result<Vec<Fault>, String> {
    let mut faults: Vec<Fault> = Vec::new();
    let mut suite = None;
    for (number, line) in (1..).zip(text.lines()) {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let refused = |what: &str| format!("faults.txt, line {number}: {what}: {line}");
        if let Some(name) = line.strip_prefix('[') {
            let name = name.strip_suffix(']').filter(|name| SUITES.contains(name));
            suite = Some(name.ok_or_else(|| refused("no suite"))?);
            continue;
        }
        let suite = suite.ok_or_else(|| refused("a fault of no suite"))?;
        let fault = parse_fault(suite, line).ok_or_else(|| refused("not a fault"))?;
        if faults.iter().any(|other| (other.suite, other.name) == (suite, fault.name)) {
            return Err(refused("a name that an earlier fault has"));
        }
        faults.push(fault);
    }
    Ok(faults)
}

/// Reads ``NAME SETUP... FILE `TEXT` => `REPLACEMENT` ``.
fn parse_fault(suite: &'static str, line: &'static str) -> Option<Fault> {
    let (words, texts) = line.strip_suffix('`')?.split_once(" `")?;
    let (find, replace) = texts.split_once("` => `")?;
    let mut words: Vec<&str> = words.split(' ').collect();
    let file = words.pop().filter(|file| file.contains(".wgsl"))?;
    let name = (!words.is_empty()).then(|| words.remove(0))?;
    let [find, replace] = [find, replace].map(|text| text.replace("\\n", "\n"));
    let is_text = !find.is_empty() && find != replace && !(find.clone() + &replace).contains(['`', '\\']);
    let is_word = |word: &&str| !word.is_empty() && !word.contains(".wgsl");
    let edit = ShaderEdit { file: file.to_owned(), find, replace };
    (is_text && is_word(&name) && words.iter().all(is_word)).then_some(Fault { suite, name, setup: words, edit })
}

/// Tests that all faults can be planted, including those that do not run, and that the parser refuses malformed lists.
pub(crate) fn checks() -> Vec<Trial> {
    let fit = Trial::test("planted::every_fault_can_be_planted", || {
        let mut all = SUITES.into_iter().flat_map(planted);
        all.try_for_each(|fault| check_text(&fault.edit.file, &fault.edit.find))
    });
    let refused = Trial::test("planted::malformed_lines_are_refused", || {
        let good = "[live]\na b c/d.wgsl#e `f\\ng` => ``\n# why\nh c/d.wgsl `i` => `j`";
        let [first, second] = parse(good)?.try_into().map_err(|other| format!("{other:?}"))?;
        assert_eq!(first.setup::<1>(), ["b"]);
        assert_eq!((first.edit.find.as_str(), first.edit.replace.as_str()), ("f\ng", ""));
        assert_eq!((second.suite, second.name, second.setup::<0>()), ("live", "h", []));
        for bad in [
            "a c.wgsl `b` => `d`",
            "[alive]",
            "[live",
            "[live]\na c.wgsl `b` => `d`\na c.wgsl `e` => `f`",
            "[live]\na c.wgsl `b` => `b`",
            "[live]\na c.wgsl `` => `d`",
            "[live]\na c.wgsl `b => d`",
            "[live]\na c.wgsl `b` => `d",
            "[live]\na c.wgsl b` => `d`",
            "[live]\na c.wgsl `b`d` => `e`",
            "[live]\na c.wgsl `b\\t` => `e`",
            "[live]\na  c.wgsl `b` => `e`",
            "[live]\na c `b` => `e`",
            "[live]\nc.wgsl `b` => `e`",
            "[live]\na c.wgsl d.wgsl `b` => `e`",
        ] {
            assert!(parse(bad).is_err(), "{bad}");
        }
        Ok(())
    });
    vec![fit, refused]
}
