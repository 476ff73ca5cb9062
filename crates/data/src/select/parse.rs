//! Parses selections: operators between terms, and those before and after them.

use super::error::{SelectError, error_at};
use super::foreign;
use super::scan::Scanner;
use super::tree::{Bonded, Near, Node, Place, Step, Word};
use super::words::{class_of, is_joint};
use crate::keys::key_of;
use pinhole::internals::text::{one_line, shortened};

/// The deepest nesting, so that the stack suffices.
const DEEPEST: usize = 100;

/// A selection that was read.
#[derive(Clone, Debug)]
pub(super) struct Parsed {
    pub(super) node: Node,
    pub(super) notes: Vec<String>,
    /// The remedy if nothing is selected, because an operator takes all that follows.
    pub(super) remedy: Option<String>,
    /// The names of other selections that it uses.
    pub(super) uses: Vec<String>,
}

/// Parses a selection that may use other selections, those of which `is_name` knows the names.
pub(super) fn parse(text: &str, is_name: &dyn Fn(&str) -> bool) -> Result<Parsed, SelectError> {
    let (steps, notes, uses) = (Vec::new(), Vec::new(), Vec::new());
    let mut parser = Parser { scanner: Scanner { text, at: 0 }, depth: 0, steps, notes, remedy: None, is_name, uses };
    let node = parser.selection()?;
    match parser.scanner.rest() {
        "" => Ok(Parsed { node, notes: parser.notes, remedy: parser.remedy, uses: parser.uses }),
        _ => Err(parser.scanner.wanted("`and`, `or` or the end")),
    }
}

pub(super) struct Parser<'a> {
    pub(super) scanner: Scanner<'a>,
    depth: usize,
    /// The arithmetic that is being read.
    pub(super) steps: Vec<Step>,
    pub(super) notes: Vec<String>,
    pub(super) remedy: Option<String>,
    is_name: &'a dyn Fn(&str) -> bool,
    uses: Vec<String>,
}

/// Terms that are joined by `and`.
struct Joined {
    node: Node,
    /// Their start and their end.
    span: [usize; 2],
    /// The end of the first term and the start of the second, if no `and` stands between them.
    silent: Option<[usize; 2]>,
}

impl Parser<'_> {
    /// Parses what is nested.
    pub(super) fn nested<T>(
        &mut self,
        parse: impl FnOnce(&mut Self) -> Result<T, SelectError>,
    ) -> Result<T, SelectError> {
        if self.depth == DEEPEST {
            return Err(self
                .scanner
                .error(format!("parentheses lie in more than {DEEPEST} others; simplify the expression")));
        }
        self.depth += 1;
        let parsed = parse(self);
        self.depth -= 1;
        parsed
    }

    /// The error that a parenthesis is not closed.
    pub(super) fn unclosed(&self, open: usize) -> String {
        let character = self.scanner.text.get(..open).unwrap_or_default().chars().count() + 1;
        format!("the parenthesis at {character} is not closed: there is no closing )")
    }

    /// Takes the parenthesis that closes the one at `open`.
    pub(super) fn close(&mut self, open: usize) -> Result<(), SelectError> {
        match self.scanner.rest() {
            "" => Err(error_at(self.scanner.text, open, self.unclosed(open))),
            _ if self.scanner.take(")") => Ok(()),
            _ => Err(self.scanner.wanted("`and`, `or` or `)`")),
        }
    }

    /// Parses a selection up to its end or the next parenthesis that closes.
    pub(super) fn selection(&mut self) -> Result<Node, SelectError> {
        self.nested(|parser| {
            let mut node = parser.any()?;
            for _ in 0..DEEPEST {
                let (made, is_after) = parser.after(node)?;
                node = match is_after {
                    false => return Ok(made),
                    true if parser.take_and() => Node::All(vec![made, parser.any()?]),
                    true if parser.take_or() => Node::Any(vec![made, parser.any()?]),
                    true => made,
                };
            }
            Err(parser
                .scanner
                .error(format!("more than {DEEPEST} operators follow each other; simplify the expression")))
        })
    }

    /// Parses terms that are joined by `or`.
    fn any(&mut self) -> Result<Node, SelectError> {
        let first = self.all()?;
        let [start, end] = first.span;
        let mut silent = first.silent.map(|split| (first.span, split));
        let (mut parts, mut last) = (vec![first.node], [start, end]);
        loop {
            let at = self.scanner.at;
            if !self.take_or() {
                break;
            }
            let next = self.all()?;
            silent = silent.or(next.silent.map(|split| (next.span, split)));
            if let Some((span, split)) = silent {
                return Err(self.two_readings(at, span, split, if span == next.span { last } else { next.span }));
            }
            parts.push(next.node);
            last = next.span;
        }
        Ok(joined(parts, Node::Any))
    }

    /// The error that `or` stands beside terms that are joined without a word.
    fn two_readings(&mut self, at: usize, span: [usize; 2], split: [usize; 2], other: [usize; 2]) -> SelectError {
        let text = |start: usize, end: usize| shortened(self.scanner.text.get(start..end).unwrap_or_default().trim());
        let (a, b, c) = (text(span[0], split[0]), text(split[1], span[1]), text(other[0], other[1]));
        let problem = match span[0] < other[0] {
            true => format!("two readings: write {a} and ({b} or {c}), or ({a} and {b}) or {c}"),
            false => format!("two readings: write {c} or ({a} and {b}), or ({c} or {a}) and {b}"),
        };
        self.scanner.at = at;
        self.scanner.rest();
        self.scanner.error(problem)
    }

    /// Parses terms that are joined by `and`, or stand side by side.
    fn all(&mut self) -> Result<Joined, SelectError> {
        self.scanner.rest();
        let start = self.scanner.at;
        let mut parts = vec![self.negated()?];
        let (mut end, mut silent) = (self.scanner.end(), None);
        loop {
            let has_and = self.take_and();
            self.scanner.rest();
            let next = self.scanner.at;
            if !has_and && !self.starts_term() {
                break;
            }
            parts.push(self.negated()?);
            if !has_and {
                silent = silent.or(Some([end, next]));
            }
            end = self.scanner.end();
        }
        Ok(Joined { node: joined(parts, Node::All), span: [start, end], silent })
    }

    fn take_and(&mut self) -> bool {
        self.scanner.take_word("and") || self.scanner.take("&&") || self.scanner.take("&")
    }

    fn take_or(&mut self) -> bool {
        self.scanner.take_word("or") || self.scanner.take("||") || self.scanner.take("|")
    }

    /// Returns true if a term comes next, and not an operator between terms or after them.
    fn starts_term(&mut self) -> bool {
        let rest = self.scanner.rest();
        let name = self.scanner.name();
        match name {
            "expand" | "extend" => self.is_operand(name),
            "around" => {
                let at = self.scanner.at;
                self.scanner.at += name.len();
                let is_before = self.scanner.distance(name).is_ok() && self.scanner.take_word("of");
                self.scanner.at = at;
                is_before
            }
            "" => rest.starts_with(|c: char| "(!~`'\"/:#@.".contains(c) || c.is_ascii_digit() || c == '*' || c == '-'),
            "of" | "as" | "to" | "in" => self.is_operand(name),
            _ => !is_joint(name) || name.eq_ignore_ascii_case("not"),
        }
    }

    /// Returns true if a comparison follows the next word, which is therefore a column.
    pub(super) fn is_operand(&mut self, name: &str) -> bool {
        let at = self.scanner.at;
        self.scanner.at += name.len();
        let is_before_operator = self.scanner.is_before_operator();
        self.scanner.at = at;
        is_before_operator
    }

    /// Parses an operator after a selection. Returns false with the selection if there is none.
    fn after(&mut self, node: Node) -> Result<(Node, bool), SelectError> {
        self.scanner.rest();
        let at = self.scanner.at;
        let name = self.scanner.name();
        let kind = match name {
            "around" => Near::Around,
            "expand" => Near::Expand,
            "extend" => {
                self.scanner.at += name.len();
                let steps = self.scanner.count("extend")?;
                return Ok((Node::Bonded { kind: Bonded::Within, steps, of: Box::new(node), at }, true));
            }
            _ => return Ok((node, false)),
        };
        self.scanner.at += name.len();
        let reach = self.scanner.distance(name)?;
        Ok((Node::Near { kind, reach, of: Box::new(Place::Spheres(node)), at }, true))
    }

    /// Parses a term or an operator before a selection, with or without negations.
    fn negated(&mut self) -> Result<Node, SelectError> {
        let mut is_negated = false;
        loop {
            let is_not = self.scanner.take_word("not") || self.scanner.take("~");
            if !is_not && (self.scanner.rest().starts_with("!=") || !self.scanner.take("!")) {
                break;
            }
            is_negated = !is_negated;
        }
        let node = match self.before()? {
            Some(node) => node,
            None => self.term()?,
        };
        Ok(if is_negated { Node::Not(Box::new(node)) } else { node })
    }

    /// Parses a class, a list, a comparison or a selection in parentheses.
    fn term(&mut self) -> Result<Node, SelectError> {
        let rest = self.scanner.rest();
        let at = self.scanner.at;
        if rest.starts_with('(') {
            let Some(end) = self.scanner.closing() else {
                return Err(error_at(self.scanner.text, at, self.unclosed(at)));
            };
            self.scanner.at = end;
            let is_side =
                self.scanner.is_before_operator() || self.scanner.rest().starts_with(['+', '-', '*', '/', '%', '^']);
            self.scanner.at = at;
            if !is_side {
                self.scanner.at += 1;
                let node = self.selection()?;
                return self.close(at).map(|()| node);
            }
        }
        if self.scanner.take("*") {
            return Ok(Node::Class(Word { text: "all".to_owned(), at }));
        }
        if self.scanner.name() == "prop" && !self.is_operand("prop") {
            self.scanner.take_word("prop");
        }
        let name = self.scanner.name();
        let at = self.scanner.at;
        if class_of(name).is_some() && key_of(name).is_none() && !self.is_operand(name) {
            self.scanner.at += name.len();
            return Ok(Node::Class(Word { text: name.to_lowercase(), at }));
        }
        if (self.is_name)(name) && !self.is_operand(name) {
            self.scanner.at += name.len();
            self.uses.push(name.to_owned());
            return Ok(Node::Named(Word { text: name.to_owned(), at }));
        }
        let starts_foreign = rest.starts_with(['/', ':', '#', '@']) || (rest.starts_with('.') && !name.is_empty());
        match foreign::remedy(rest).filter(|_| starts_foreign) {
            Some(problem) => Err(self.scanner.error(one_line(&problem))),
            None => self.list_or_comparison(),
        }
    }
}

/// Joins parts. A single part stays as it is.
fn joined(mut parts: Vec<Node>, joint: fn(Vec<Node>) -> Node) -> Node {
    match (parts.len(), parts.pop()) {
        (1, Some(one)) => one,
        (_, last) => {
            parts.extend(last);
            joint(parts)
        }
    }
}
