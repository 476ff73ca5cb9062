//! A selection as a tree.

use std::cmp::Ordering;

/// A part of a selection. No path from the root is longer than a few hundred nodes, so recursion is safe.
#[derive(Clone, Debug)]
pub(super) enum Node {
    /// All of these must match.
    All(Vec<Self>),
    /// At least one of these must match.
    Any(Vec<Self>),
    Not(Box<Self>),
    /// Neighbouring sides are compared, such as `3 < z <= 9`.
    Compare {
        sides: Vec<Side>,
        operators: Vec<Operator>,
    },
    /// A value of the key must be one of the list.
    List {
        key: Word,
        values: Vec<Value>,
        is_negated: bool,
    },
    /// A word alone that is neither a key nor a class.
    Unknown(Word),
    Class(Word),
    /// The selection with this name.
    Named(Word),
    /// Spheres at some distance from others.
    Near {
        kind: Near,
        reach: f64,
        of: Box<Place>,
        at: usize,
    },
    /// This many spheres that are nearest to others.
    Nearest {
        count: usize,
        of: Box<Place>,
        at: usize,
    },
    /// Spheres that bonds connect to others.
    Bonded {
        kind: Bonded,
        steps: usize,
        of: Box<Self>,
        at: usize,
    },
    /// Spheres that have the same value of a key as one of others.
    Same {
        key: Word,
        of: Box<Self>,
    },
}

/// From where distances are measured.
#[derive(Clone, Debug)]
pub(super) enum Place {
    Spheres(Node),
    Point([f64; 3]),
}

/// The spheres that a distance chooses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Near {
    Within,
    /// Within the distance, without the others themselves.
    Around,
    /// Within the distance, and the others themselves.
    Expand,
    Beyond,
    /// Within the distance across the borders of the cell, whatever the file says about it.
    Periodic,
}

/// The spheres that bonds choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bonded {
    /// Those with a bond to one of the others.
    To,
    /// The same, without the others themselves.
    Neighbor,
    /// At most some bonds away, and the others themselves.
    Within,
}

/// A word of the text, and the offset of its first byte.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Word {
    pub(super) text: String,
    pub(super) at: usize,
}

/// A value of a list.
#[derive(Clone, Debug)]
pub(super) struct Value {
    pub(super) text: String,
    pub(super) at: usize,
    pub(super) kind: ValueKind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ValueKind {
    /// A number, a text, texts joined by `+`, a range, or a text with wildcards, depending on the key.
    Word,
    /// A range whose parts are separate.
    Range(f64, f64),
    /// A text in quotation marks.
    Literal,
    /// A text, or else a regular expression for the whole text.
    Pattern,
    /// A regular expression for the whole text.
    Regex,
}

/// A side of a comparison. At least one of its readings is there.
#[derive(Clone, Debug)]
pub(super) struct Side {
    pub(super) at: usize,
    pub(super) value: Option<Value>,
    pub(super) expression: Option<Expression>,
}

impl Side {
    /// The column that is the whole side.
    pub(super) fn column(&self) -> Option<&Word> {
        match self.expression.as_ref()?.steps.as_slice() {
            [Step::Column(word)] => Some(word),
            _ => None,
        }
    }
}

/// Arithmetic in the order of its evaluation: a step takes its operands from a stack, and leaves its result there.
#[derive(Clone, Debug, Default)]
pub(super) struct Expression {
    pub(super) steps: Vec<Step>,
}

#[derive(Clone, Debug)]
pub(super) enum Step {
    Number(f64),
    Column(Word),
    Unary(fn(f64) -> f64),
    Binary(fn(f64, f64) -> f64),
}

/// The orders of its two sides that a comparison accepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Operator {
    less: bool,
    equal: bool,
    greater: bool,
    /// Is true if the right side is a regular expression.
    pub(super) is_regex: bool,
}

impl Operator {
    pub(super) const EQUAL: Self = Self::new(false, true, false);
    pub(super) const UNEQUAL: Self = Self::new(true, false, true);

    /// All signs and words. A sign comes before its own prefixes.
    pub(super) const ALL: [(&'static str, Self); 15] = [
        ("==", Self::EQUAL),
        ("!=", Self::UNEQUAL),
        ("<>", Self::UNEQUAL),
        ("=~", Self { is_regex: true, ..Self::EQUAL }),
        ("<=", Self::new(true, true, false)),
        (">=", Self::new(false, true, true)),
        ("<", Self::new(true, false, false)),
        (">", Self::new(false, false, true)),
        ("=", Self::EQUAL),
        ("lt", Self::new(true, false, false)),
        ("le", Self::new(true, true, false)),
        ("gt", Self::new(false, false, true)),
        ("ge", Self::new(false, true, true)),
        ("eq", Self::EQUAL),
        ("ne", Self::UNEQUAL),
    ];

    const fn new(less: bool, equal: bool, greater: bool) -> Self {
        Self { less, equal, greater, is_regex: false }
    }

    /// Returns the operator that holds exactly where this one does not.
    pub(super) fn opposite(self) -> Self {
        Self { is_regex: self.is_regex, ..Self::new(!self.less, !self.equal, !self.greater) }
    }

    /// Returns true if a comparison asks only if the sides are equal.
    pub(super) fn is_equality(self) -> bool {
        self.less == self.greater
    }

    /// Returns true if equal sides match.
    pub(super) fn accepts_equal(self) -> bool {
        self.equal
    }

    /// Compares two numbers. NaN never matches.
    pub(super) fn holds(self, a: f64, b: f64) -> bool {
        a.partial_cmp(&b).is_some_and(|order| match order {
            Ordering::Less => self.less,
            Ordering::Equal => self.equal,
            Ordering::Greater => self.greater,
        })
    }
}
