//! Parses expressions, by recursive descent.

use std::cmp::Ordering;

use pinhole::internals::text::one_line;

/// Maximum depth of nested parentheses, so that the stack suffices.
const DEEPEST: usize = 100;

/// A part of an expression. Negations are moved into the operators, so that missing values match neither a
/// comparison nor its opposite.
#[derive(Clone, Debug)]
pub(super) enum Expression {
    /// All of these must match.
    All(Vec<Self>),
    /// At least one of these must match.
    Any(Vec<Self>),
    Compare(Comparison),
}

#[derive(Clone, Debug)]
pub(super) struct Comparison {
    pub(super) sides: [Operand; 2],
    pub(super) operator: Operator,
}

#[derive(Clone, Debug)]
pub(super) struct Operand {
    pub(super) value: Value,
    /// Offset of its first byte.
    pub(super) at: usize,
}

#[derive(Clone, Debug)]
pub(super) enum Value {
    /// A number, the name of a column, or a text without quotation marks, depending on the other side.
    Word(String),
    /// A text in quotation marks.
    Text(String),
    /// The name of a column, such as `|v|`, or in backquotes.
    Column(String),
}

/// The orders of its two sides that a comparison accepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Operator {
    less: bool,
    equal: bool,
    greater: bool,
}

impl Operator {
    pub(super) const EQUAL: Self = Self::new(false, true, false);

    /// All signs. A sign comes before its own prefixes.
    const SIGNS: [(&'static str, Self); 6] = [
        ("==", Self::EQUAL),
        ("!=", Self::new(true, false, true)),
        ("<=", Self::new(true, true, false)),
        (">=", Self::new(false, true, true)),
        ("<", Self::new(true, false, false)),
        (">", Self::new(false, false, true)),
    ];

    const fn new(less: bool, equal: bool, greater: bool) -> Self {
        Self { less, equal, greater }
    }

    /// Returns the operator that holds exactly where this one does not.
    fn opposite(self) -> Self {
        Self::new(!self.less, !self.equal, !self.greater)
    }

    /// Returns the operator for exchanged sides.
    pub(super) fn mirrored(self) -> Self {
        Self::new(self.greater, self.equal, self.less)
    }

    /// Whether a comparison asks only if the sides are equal.
    pub(super) fn is_equality(self) -> bool {
        self.less == self.greater
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

pub(super) fn parse(text: &str) -> Result<Expression, SelectError> {
    let mut parser = Parser { text, at: 0, depth: 0 };
    let parsed = parser.any(false)?;
    match parser.rest() {
        "" => Ok(parsed),
        _ => Err(parser.wanted("`and`, `or` or the end")),
    }
}

pub(super) fn error_at(text: &str, at: usize, problem: impl Into<String>) -> SelectError {
    let character = text.get(..at).unwrap_or_default().chars().count() + 1;
    SelectError::At { expression: one_line(text), character, problem: problem.into() }
}

struct Parser<'a> {
    text: &'a str,
    /// Offset of the next byte.
    at: usize,
    depth: usize,
}

fn ends_word(c: char) -> bool {
    c.is_whitespace() || "()<>=!&|\"'`".contains(c)
}

impl<'a> Parser<'a> {
    /// Skips white space, and returns the remaining text.
    fn rest(&mut self) -> &'a str {
        let rest = self.text.get(self.at..).unwrap_or_default();
        let trimmed = rest.trim_start();
        self.at += rest.len() - trimmed.len();
        trimmed
    }

    fn error(&self, problem: impl Into<String>) -> SelectError {
        error_at(self.text, self.at, problem)
    }

    fn wanted(&mut self, wanted: &'static str) -> SelectError {
        let rest = self.rest();
        let found = match (self.word(), rest.chars().next()) {
            ("", None) => "the end".to_owned(),
            ("", Some(sign)) => format!("`{sign}`"),
            (word, _) => format!("`{}`", pinhole::internals::text::shortened(word)),
        };
        self.error(format!("{wanted} belongs here, but {found} stands here"))
    }

    /// Takes the next word; empty if there is none.
    fn word(&mut self) -> &'a str {
        let rest = self.rest();
        &rest[..rest.find(ends_word).unwrap_or(rest.len())]
    }

    fn take(&mut self, sign: &str) -> bool {
        let is_next = self.rest().starts_with(sign);
        self.at += if is_next { sign.len() } else { 0 };
        is_next
    }

    /// Takes a word, or the sign with the same meaning.
    fn take_either(&mut self, word: &str, sign: &str) -> bool {
        if self.word().eq_ignore_ascii_case(word) {
            self.at += word.len();
            return true;
        }
        self.take(sign)
    }

    /// Parses parts that are joined by `or`, or the negation of that.
    fn any(&mut self, is_negated: bool) -> Result<Expression, SelectError> {
        let mut parts = vec![self.all(is_negated)?];
        while self.take_either("or", "||") {
            parts.push(self.all(is_negated)?);
        }
        if self.rest().starts_with('|') {
            return Err(self.error("write ||, or the word"));
        }
        Ok(joined(parts, if is_negated { Expression::All } else { Expression::Any }))
    }

    /// Parses parts that are joined by `and`, or the negation of that.
    fn all(&mut self, is_negated: bool) -> Result<Expression, SelectError> {
        let mut parts = vec![self.one(is_negated)?];
        while self.take_either("and", "&&") {
            parts.push(self.one(is_negated)?);
        }
        if self.rest().starts_with('&') {
            return Err(self.error("write &&, or the word"));
        }
        Ok(joined(parts, if is_negated { Expression::Any } else { Expression::All }))
    }

    /// Parses a comparison or an expression in parentheses, with or without negations.
    fn one(&mut self, is_negated: bool) -> Result<Expression, SelectError> {
        let mut is_negated = is_negated;
        while !self.rest().starts_with("!=") && self.take_either("not", "!") {
            is_negated = !is_negated;
        }
        let open = self.at;
        if !self.take("(") {
            return self.comparison(is_negated);
        }
        if self.depth == DEEPEST {
            self.at = open;
            return Err(self.error(format!("parentheses lie in more than {DEEPEST} others; simplify the expression")));
        }
        self.depth += 1;
        let inside = self.any(is_negated)?;
        self.depth -= 1;
        match self.rest() {
            "" => {
                self.at = open;
                Err(self.error("there is no closing )"))
            }
            _ if self.take(")") => Ok(inside),
            _ => Err(self.wanted("`and`, `or` or `)`")),
        }
    }

    fn comparison(&mut self, is_negated: bool) -> Result<Expression, SelectError> {
        let left = self.operand()?;
        let operator = self.operator()?;
        let Some(operator) = operator else {
            return Err(self.wanted("a comparison, such as ==, != or <,"));
        };
        let right = self.operand()?;
        let before = self.at;
        if self.operator()?.is_some() {
            self.at = before;
            self.rest();
            return Err(
                self.error("a comparison has two sides; join two comparisons with `and`, such as 1 < z and z < 3")
            );
        }
        let operator = if is_negated { operator.opposite() } else { operator };
        Ok(Expression::Compare(Comparison { sides: [left, right], operator }))
    }

    fn operator(&mut self) -> Result<Option<Operator>, SelectError> {
        if let Some((_, found)) = Operator::SIGNS.into_iter().find(|(sign, _)| self.take(sign)) {
            return Ok(Some(found));
        }
        match self.rest().starts_with('=') {
            true => Err(self.error("write == to compare")),
            false => Ok(None),
        }
    }

    fn operand(&mut self) -> Result<Operand, SelectError> {
        const WANTED: &str = "a column, a number or a text";
        let rest = self.rest();
        let at = self.at;
        let value = match rest.chars().next() {
            Some(mark @ ('"' | '\'')) => Value::Text(self.quoted(mark)?.to_owned()),
            Some('`') => Value::Column(self.quoted('`')?.to_owned()),
            Some('|') => Value::Column(format!("|{}|", self.quoted('|')?.trim())),
            _ => {
                let word = self.word();
                let is_joint = ["and", "or", "not"].iter().any(|joint| word.eq_ignore_ascii_case(joint));
                if word.is_empty() || is_joint {
                    return Err(self.wanted(WANTED));
                }
                self.at += word.len();
                Value::Word(word.to_owned())
            }
        };
        Ok(Operand { value, at })
    }

    /// Takes the text between two equal marks, the first of which comes next.
    fn quoted(&mut self, mark: char) -> Result<&'a str, SelectError> {
        let inside = self.rest().get(mark.len_utf8()..).unwrap_or_default();
        let Some(length) = inside.find(mark) else {
            return Err(self.error(format!("there is no closing {mark}")));
        };
        self.at += length + 2 * mark.len_utf8();
        Ok(&inside[..length])
    }
}

/// Joins parts. A single part stays as it is.
fn joined(mut parts: Vec<Expression>, joint: fn(Vec<Expression>) -> Expression) -> Expression {
    match (parts.len(), parts.pop()) {
        (1, Some(one)) => one,
        (_, last) => {
            parts.extend(last);
            joint(parts)
        }
    }
}

/// The reason why a selection cannot be read, or does not apply to the data.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SelectError {
    /// A part of the expression is wrong.
    #[error("character {character} of `{expression}`: {problem}")]
    At {
        /// The expression.
        expression: String,
        /// The character at which the wrong part begins, counted from 1.
        character: usize,
        /// Description of the fault.
        problem: String,
    },
    /// No sphere matches.
    #[error("`{expression}` selects none of the {of} spheres{hint}")]
    Nothing {
        /// The expression.
        expression: String,
        /// The number of spheres.
        of: usize,
        /// A possible reason, after a semicolon; empty if none is known.
        hint: String,
    },
}
