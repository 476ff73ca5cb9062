//! Selections with names, which other selections may use.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use super::parse::{Parsed, parse};
use super::words::{all_words, is_joint};

/// Selections with names. A selection that uses a name has the spheres of the selection with this name. Names may use each
/// other, but not in a circle.
///
/// ```
/// use pinhole_data::select::NamedSelections;
///
/// let names = NamedSelections::new([("pocket", "byres within 5 of heme"), ("heme", "resname HEM")])?;
/// let selection = names.selection("pocket and not heme")?;
/// assert_eq!(selection.to_string(), "pocket and not heme");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct NamedSelections(Arc<BTreeMap<String, Named>>);

/// The selection with a name.
#[derive(Clone, Debug)]
pub(super) struct Named {
    pub(super) text: String,
    pub(super) parsed: Parsed,
}

/// The reason why a name cannot have its selection.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{problem}")]
#[non_exhaustive]
pub struct NameError {
    /// The name.
    pub name: String,
    /// Description of the fault.
    pub problem: String,
}

/// The most names that use one another in a row, so that the stack suffices.
const LONGEST: usize = 16;

impl PartialEq for NamedSelections {
    fn eq(&self, other: &Self) -> bool {
        let texts = |all: &Self| -> Vec<(String, String)> {
            all.0.iter().map(|(name, named)| (name.clone(), named.text.clone())).collect()
        };
        Arc::ptr_eq(&self.0, &other.0) || texts(self) == texts(other)
    }
}

impl NamedSelections {
    /// Reads names, each with the text of its selection. A later text takes the place of an earlier one of the same name.
    ///
    /// # Errors
    /// Returns an error for a name that is a word of the language or has other characters than a-z, 0-9 and _, for a text
    /// that is no selection, and for names that use each other in a circle.
    pub fn new<'a>(texts: impl IntoIterator<Item = (&'a str, &'a str)>) -> Result<Self, NameError> {
        let texts: BTreeMap<&str, &str> = texts.into_iter().collect();
        let error = |name: &str, problem: String| NameError { name: name.to_owned(), problem };
        if let Some((name, problem)) = texts.keys().find_map(|name| Some((name, problem_of(name)?))) {
            return Err(error(name, problem));
        }
        let is_name = |name: &str| texts.contains_key(name);
        let named = |(name, text): (&&str, &&str)| {
            let parsed = parse(text, &is_name).map_err(|problem| error(name, problem.to_string()))?;
            Ok(((*name).to_owned(), Named { text: (*text).to_owned(), parsed }))
        };
        let all: BTreeMap<String, Named> = texts.iter().map(named).collect::<Result<_, NameError>>()?;
        let mut known = HashMap::new();
        for name in all.keys() {
            follow(name, &all, &mut Vec::new(), &mut known).map_err(|problem| error(name, problem))?;
        }
        Ok(Self(Arc::new(all)))
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.0.contains_key(name)
    }

    pub(super) fn get(&self, name: &str) -> Option<&Named> {
        self.0.get(name)
    }
}

/// Says why a word cannot be a name.
fn problem_of(name: &str) -> Option<String> {
    let is_plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    if !(name.starts_with(|c: char| c.is_ascii_lowercase()) && name.chars().all(is_plain)) {
        return Some("a name of a selection has the characters a-z, 0-9 and _, and begins with a letter".to_owned());
    }
    let is_known = is_joint(name) || name == "rest" || all_words().any(|word| word.eq_ignore_ascii_case(name));
    is_known.then(|| format!("`{name}` is a word of selections; choose another name, such as my_{name}"))
}

/// Follows the names that a selection uses, and returns how many follow each other. `path` has those that lead here, and
/// `known` those that were followed.
fn follow<'a>(
    name: &'a str,
    all: &'a BTreeMap<String, Named>,
    path: &mut Vec<&'a str>,
    known: &mut HashMap<&'a str, usize>,
) -> Result<usize, String> {
    if path.contains(&name) {
        path.push(name);
        return Err(format!("names use each other in a circle: {}", path.join(" -> ")));
    }
    let too_long = || format!("more than {LONGEST} names use one another in a row");
    let below = match known.get(name) {
        Some(below) => *below,
        None if path.len() == LONGEST => return Err(too_long()),
        None => {
            path.push(name);
            let mut below = 0;
            for used in all.get(name).iter().flat_map(|named| &named.parsed.uses) {
                below = below.max(1 + follow(used, all, path, known)?);
            }
            path.pop();
            known.insert(name, below);
            below
        }
    };
    if path.len() + below >= LONGEST { Err(too_long()) } else { Ok(below) }
}
