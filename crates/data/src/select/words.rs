//! The words of the language: keys with their aliases, classes, operators and functions.

use super::tree::Step;
use crate::keys::{KEYS, key_of};

const CLASSES: &[&str] = &[
    "all",
    "none",
    "protein",
    "nucleic",
    "dna",
    "rna",
    "polymer",
    "polymer.protein",
    "polymer.nucleic",
    "hetero",
    "hetatm",
    "het",
    "backbone",
    "bb.",
    "sidechain",
    "sc.",
    "alpha",
    "guide",
    "water",
    "waters",
    "solvent",
    "ion",
    "ions",
    "lipid",
    "sugar",
    "ligand",
    "organic",
    "inorganic",
    "hydrogen",
    "hydrogens",
    "hydro",
    "noh",
    "heavy",
    "metal",
    "metals",
    "acidic",
    "basic",
    "charged",
    "polar",
    "hydrophobic",
    "aromatic",
    "aliphatic",
    "small",
    "purine",
    "pyrimidine",
    "helix",
    "sheet",
    "coil",
];

/// The words of operators.
const OPERATORS: &[&str] = &[
    "and",
    "or",
    "not",
    "in",
    "of",
    "to",
    "as",
    "within",
    "exwithin",
    "pbwithin",
    "beyond",
    "near_to",
    "around",
    "expand",
    "extend",
    "withinbonds",
    "nearest",
    "bonded",
    "bound_to",
    "neighbor",
    "same",
    "byres",
    "bychain",
    "bymol",
    "byfrag",
    "byseg",
    "lt",
    "le",
    "gt",
    "ge",
    "eq",
    "ne",
    "prop",
];

/// The class that a word names, in upper or lower case.
pub(super) fn class_of(word: &str) -> Option<&'static str> {
    CLASSES.iter().find(|class| class.eq_ignore_ascii_case(word)).copied()
}

/// Returns true for `and`, `or` and `not`, in upper or lower case.
pub(super) fn is_joint(word: &str) -> bool {
    ["and", "or", "not"].iter().any(|joint| joint.eq_ignore_ascii_case(word))
}

/// Returns true for words that end a list of values.
pub(super) fn is_reserved(word: &str) -> bool {
    let is_lower = !word.chars().any(|c| c.is_ascii_uppercase());
    is_joint(word) || is_lower && (OPERATORS.contains(&word) || class_of(word).is_some() || key_of(word).is_some())
}

/// The words that a user may have meant by a word: keys, classes and operators.
pub(super) fn all_words<'a>() -> impl Iterator<Item = &'a str> {
    let keys = KEYS.iter().flat_map(|key| [key.name].into_iter().chain(key.aliases.iter().copied()));
    keys.chain(CLASSES.iter().copied()).chain(OPERATORS.iter().copied())
}

/// The word that is spelled most alike, if it is near enough.
pub(super) fn nearest<'a>(word: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let word: String = word.to_lowercase().chars().take(40).collect();
    let likeness = |known: &str| strsim::jaro_winkler(known, &word);
    let best = known.map(|known| (likeness(known), known)).reduce(|a, b| if b.0 > a.0 { b } else { a })?;
    (best.0 > 0.8).then_some(best.1)
}

/// The step of a function of this name, and the number of its arguments. Functions of any number take two at a time.
pub(super) fn function(name: &str) -> Option<(Step, Arguments)> {
    let unary: fn(f64) -> f64 = match name {
        "abs" => f64::abs,
        "sqr" => |x| x * x,
        "sqrt" => f64::sqrt,
        "exp" => f64::exp,
        "log" => f64::ln,
        "log10" => f64::log10,
        "sin" => f64::sin,
        "cos" => f64::cos,
        "tan" => f64::tan,
        "asin" => f64::asin,
        "acos" => f64::acos,
        "atan" => f64::atan,
        "floor" => f64::floor,
        "ceil" => f64::ceil,
        "round" => f64::round,
        _ => return binary(name),
    };
    Some((Step::Unary(unary), Arguments::One))
}

/// The number of arguments of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Arguments {
    One,
    Two,
    AtLeastTwo,
}

fn binary(name: &str) -> Option<(Step, Arguments)> {
    // Of NaN and a number, NaN: what is missing stays missing.
    let (binary, arguments): (fn(f64, f64) -> f64, _) = match name {
        "atan2" => (f64::atan2, Arguments::Two),
        "hypot" => (f64::hypot, Arguments::AtLeastTwo),
        "min" => (|a, b| if a < b || a.is_nan() { a } else { b }, Arguments::AtLeastTwo),
        "max" => (|a, b| if a > b || a.is_nan() { a } else { b }, Arguments::AtLeastTwo),
        _ => return None,
    };
    Some((Step::Binary(binary), arguments))
}
