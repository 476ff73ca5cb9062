//! Parses operators that stand before a selection, such as `within 5 of` and `same residue as`.

use super::error::{SelectError, error_at};
use super::parse::Parser;
use super::tree::{Bonded, Near, Node, Place, Word};
use super::words::is_joint;
use pinhole::internals::text::{one_line, shortened};

/// The most notes about one selection.
const MOST_NOTES: usize = 5;

impl Parser<'_> {
    /// Parses an operator before a selection, and the selection.
    pub(super) fn before(&mut self) -> Result<Option<Node>, SelectError> {
        let name = self.scanner.name();
        let at = self.scanner.at;
        if name.is_empty() || self.is_operand(name) {
            return Ok(None);
        }
        self.scanner.at += name.len();
        let node = match name {
            "within" => self.near(Near::Within, name, at)?,
            "exwithin" | "near_to" | "around" => self.near(Near::Around, name, at)?,
            "pbwithin" => self.near(Near::Periodic, name, at)?,
            "beyond" => self.near(Near::Beyond, name, at)?,
            "bonded" => {
                self.scanner.take_word("to");
                self.bonded(Bonded::To, 1, at)?
            }
            "bound_to" => self.bonded(Bonded::To, 1, at)?,
            "neighbor" => self.bonded(Bonded::Neighbor, 1, at)?,
            "withinbonds" => {
                let steps = self.scanner.count(name)?;
                self.take_joint(at, "of")?;
                self.bonded(Bonded::Within, steps, at)?
            }
            "nearest" => {
                let count = self.scanner.count(name)?;
                self.take_joint(at, "to")?;
                Node::Nearest { count, of: Box::new(self.place(at)?), at }
            }
            "same" => {
                let key = self.scanner.name();
                if key.is_empty() || is_joint(key) || key == "as" {
                    return Err(self.scanner.wanted("a key, such as residue,"));
                }
                let word = Word { text: key.to_owned(), at: self.scanner.at };
                self.scanner.at += key.len();
                self.take_joint(at, "as")?;
                Node::Same { key: word, of: Box::new(self.argument(at)?) }
            }
            "byres" => self.by("residue", at)?,
            "bychain" => self.by("chain", at)?,
            "bymol" => self.by("mol", at)?,
            "byfrag" => self.by("fragment", at)?,
            "byseg" => self.by("segid", at)?,
            "expand" | "extend" => {
                self.scanner.at = at;
                return Err(self.scanner.error(format!("{name} stands behind a selection, such as name CA {name} 2")));
            }
            _ => {
                self.scanner.at = at;
                return Ok(None);
            }
        };
        Ok(Some(node))
    }

    fn near(&mut self, kind: Near, name: &str, at: usize) -> Result<Node, SelectError> {
        let reach = self.scanner.distance(name)?;
        if name != "around" {
            self.take_joint(at, "of")?;
        } else {
            self.scanner.take_word("of");
        }
        Ok(Node::Near { kind, reach, of: Box::new(self.place(at)?), at })
    }

    fn bonded(&mut self, kind: Bonded, steps: usize, at: usize) -> Result<Node, SelectError> {
        Ok(Node::Bonded { kind, steps, of: Box::new(self.argument(at)?), at })
    }

    fn by(&mut self, key: &str, at: usize) -> Result<Node, SelectError> {
        let key = Word { text: key.to_owned(), at };
        Ok(Node::Same { key, of: Box::new(self.argument(at)?) })
    }

    /// Takes the word between an operator and its selection.
    fn take_joint(&mut self, at: usize, joint: &str) -> Result<(), SelectError> {
        if self.scanner.take_word(joint) {
            return Ok(());
        }
        let before = shortened(self.scanner.text.get(at..self.scanner.at).unwrap_or_default().trim());
        let rest = shortened(self.scanner.rest().trim_end());
        let rest = if rest.is_empty() { "..." } else { &rest };
        Err(error_at(self.scanner.text, at, format!("write: {before} {joint} {rest}")))
    }

    /// Parses a point or a selection.
    fn place(&mut self, at: usize) -> Result<Place, SelectError> {
        let start = self.scanner.at;
        let mut point = [0.0; 3];
        let is_point = ["(", ",", ","].into_iter().zip(&mut point).all(|(sign, place)| {
            let has_sign = self.scanner.take(sign);
            let is_negative = self.scanner.take("-");
            let number = self.scanner.number();
            *place = number.unwrap_or_default() * if is_negative { -1.0 } else { 1.0 };
            has_sign && number.is_some()
        });
        if is_point && self.scanner.take(")") {
            return Ok(Place::Point(point));
        }
        self.scanner.at = start;
        self.argument(at).map(Place::Spheres)
    }

    /// Parses the selection of an operator, which takes all up to the next parenthesis that closes.
    fn argument(&mut self, at: usize) -> Result<Node, SelectError> {
        self.scanner.rest();
        let start = self.scanner.at;
        let close = self.scanner.raw().starts_with('(').then(|| self.scanner.closing()).flatten();
        let node = self.selection()?;
        let end = self.scanner.at;
        let text = self.scanner.text;
        let [operator, argument] = [&text[at..start], &text[start..end]].map(|part| one_line(part.trim()));
        let is_whole = close.is_some_and(|close| text[close..end].trim().is_empty());
        if matches!(node, Node::All(_) | Node::Any(_)) && !is_whole && self.notes.len() < MOST_NOTES {
            let reading = format!("read as {operator} ({argument})");
            if let (Node::All(_), Some((first, others))) = (&node, split_at_and(&argument)) {
                self.remedy = Some(format!("{reading}; write: {others} and {operator} {first}"));
            }
            self.notes.push(reading);
        }
        Ok(node)
    }
}

/// Splits a text at the first `and` outside parentheses.
fn split_at_and(text: &str) -> Option<(&str, &str)> {
    let mut depth = 0_usize;
    let at = text.char_indices().find(|(at, c)| {
        depth += usize::from(*c == '(');
        depth = depth.saturating_sub(usize::from(*c == ')'));
        depth == 0 && text[*at..].starts_with(" and ")
    })?;
    Some((text[..at.0].trim(), text[at.0 + 5..].trim()))
}
