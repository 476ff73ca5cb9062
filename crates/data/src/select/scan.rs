//! Takes words, numbers and signs from the text of a selection.

use super::error::{SelectError, error_at};
use super::tree::{Operator, Value, ValueKind};
use super::words::is_joint;
use pinhole::internals::text::shortened;

/// The text, and the offset of the next byte.
pub(super) struct Scanner<'a> {
    pub(super) text: &'a str,
    pub(super) at: usize,
}

/// Parses a word as a number. Words such as `inf` and `nan` are names.
pub(super) fn number(word: &str) -> Option<f64> {
    let unsigned = word.strip_prefix(['+', '-']).unwrap_or(word);
    let is_number = unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    is_number.then(|| word.parse().ok()).flatten()
}

/// Parses a range such as `5-10`, `-5--1`, `5:10` or `5..10`.
pub(super) fn range(word: &str) -> Option<(f64, f64)> {
    let signs = word.char_indices().skip(1).filter(|(_, c)| "-:.".contains(*c));
    signs.into_iter().find_map(|(at, _)| {
        let rest = word.get(at..)?;
        let rest = rest.strip_prefix("..").or_else(|| rest.strip_prefix(['-', ':']))?;
        Some((number(word.get(..at)?)?, number(rest)?))
    })
}

/// The length of the number with which a text starts, without a sign; 0 if there is none.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| text[from..].bytes().take_while(u8::is_ascii_digit).count();
    let mut end = digits(0);
    let mut all = end;
    // Two points are a range.
    if text[end..].starts_with('.') && !text[end..].starts_with("..") {
        let fraction = digits(end + 1);
        end += 1 + fraction;
        all += fraction;
    }
    if all == 0 {
        return 0;
    }
    if text[end..].starts_with(['e', 'E']) {
        let sign = usize::from(text[end + 1..].starts_with(['+', '-']));
        let exponent = digits(end + 1 + sign);
        end += if exponent > 0 { 1 + sign + exponent } else { 0 };
    }
    end
}

/// Returns true for characters that end values of lists.
fn ends_value(c: char) -> bool {
    c.is_whitespace() || "()[],&|!<>=\"`".contains(c)
}

/// Returns true for characters that end names in arithmetic.
fn ends_name(c: char) -> bool {
    ends_value(c) || "+-*/%^".contains(c)
}

impl<'a> Scanner<'a> {
    /// The remaining text, as it stands.
    pub(super) fn raw(&self) -> &'a str {
        self.text.get(self.at..).unwrap_or_default()
    }

    /// Skips white space, and returns the remaining text.
    pub(super) fn rest(&mut self) -> &'a str {
        let rest = self.raw();
        let trimmed = rest.trim_start();
        self.at += rest.len() - trimmed.len();
        trimmed
    }

    pub(super) fn error(&self, problem: impl Into<String>) -> SelectError {
        error_at(self.text, self.at, problem)
    }

    pub(super) fn wanted(&mut self, wanted: &str) -> SelectError {
        let rest = self.rest();
        let found = match (self.value_word(), rest.chars().next()) {
            ("", None) => "the end".to_owned(),
            ("", Some(sign)) => format!("`{sign}`"),
            (word, _) => format!("`{}`", shortened(word)),
        };
        self.error(format!("{wanted} belongs here, but {found} stands here"))
    }

    /// The next name, which is not taken; empty if there is none. LAMMPS has names such as `c_stress[1]`.
    pub(super) fn name(&mut self) -> &'a str {
        let rest = self.rest();
        let mut end = rest.find(ends_name).unwrap_or(rest.len());
        if rest[..end].starts_with(|c: char| c.is_ascii_digit()) {
            return "";
        }
        let is_key = crate::keys::key_of(&rest[..end]).is_some();
        if let Some(inside) = rest[end..].strip_prefix('[').filter(|_| end > 0 && !is_key) {
            let digits = inside.bytes().take_while(u8::is_ascii_digit).count();
            if digits > 0 && inside[digits..].starts_with(']') {
                end += digits + 2;
            }
        }
        &rest[..end]
    }

    /// Takes a name, if it is one of these in lower case, in the letters of the text or not.
    pub(super) fn take_word(&mut self, word: &str) -> bool {
        let is_next = self.name() == word || (is_joint(word) && self.name().eq_ignore_ascii_case(word));
        self.at += if is_next { word.len() } else { 0 };
        is_next
    }

    pub(super) fn take(&mut self, sign: &str) -> bool {
        let is_next = self.rest().starts_with(sign);
        self.at += if is_next { sign.len() } else { 0 };
        is_next
    }

    /// Takes the next operator of comparisons.
    pub(super) fn operator(&mut self) -> Option<Operator> {
        let name = self.name();
        let rest = self.rest();
        let is_next = |sign: &str| match sign.starts_with(|c: char| c.is_alphabetic()) {
            true => name == sign,
            false => rest.starts_with(sign),
        };
        let (sign, operator) = Operator::ALL.into_iter().find(|(sign, _)| is_next(sign))?;
        self.at += sign.len();
        Some(operator)
    }

    /// Returns true if an operator of comparisons comes next.
    pub(super) fn is_before_operator(&mut self) -> bool {
        let at = self.at;
        let is_there = self.operator().is_some();
        self.at = at;
        is_there
    }

    /// Takes a number without a sign that no letter follows.
    pub(super) fn number(&mut self) -> Option<f64> {
        let rest = self.rest();
        let length = number_length(rest);
        let is_end = rest[length..].chars().next().is_none_or(|c| ends_name(c) || c == ':' || c == '.');
        let number = rest[..length].parse().ok().filter(|_| is_end)?;
        self.at += length;
        Some(number)
    }

    /// Takes a whole number.
    pub(super) fn count(&mut self, after: &str) -> Result<usize, SelectError> {
        let rest = self.rest();
        let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
        let is_end = rest[digits..].chars().next().is_none_or(ends_value);
        let Some(count) = rest[..digits].parse().ok().filter(|_| is_end) else {
            return Err(self.wanted(&format!("a whole number after {after}")));
        };
        self.at += digits;
        Ok(count)
    }

    /// Takes a distance, perhaps in Å.
    pub(super) fn distance(&mut self, after: &str) -> Result<f64, SelectError> {
        let rest = self.rest();
        let start = self.at;
        let length = number_length(rest);
        let Some(distance) = rest[..length].parse::<f64>().ok().filter(|distance| distance.is_finite()) else {
            return Err(self.wanted(&format!("a distance after {after}, such as {after} 5,")));
        };
        self.at += length;
        if let Some(problem) = self.wrong_unit(distance) {
            self.at = start;
            return Err(self.error(problem));
        }
        let end = start + length;
        let unit = ["Å", "A", "Å"].into_iter().find(|unit| self.raw().starts_with(unit));
        let end_of_unit = self.at + unit.map_or(0, str::len);
        let is_end = |at: usize| self.text[at..].chars().next().is_none_or(ends_value);
        self.at = if unit.is_some() && is_end(end_of_unit) { end_of_unit } else { end };
        match is_end(self.at) {
            true => Ok(distance),
            false => Err(self.wanted(&format!("a blank after the distance of {after}"))),
        }
    }

    /// The remedy if nanometres come next.
    pub(super) fn wrong_unit(&mut self, value: f64) -> Option<String> {
        let unit = self.name();
        (unit == "nm")
            .then(|| format!("numbers are in the file's unit, Å: write {} in the place of {value} nm", 10.0 * value))
    }

    /// Takes the text between two equal marks, the first of which comes next.
    pub(super) fn quoted(&mut self, mark: char) -> Result<&'a str, SelectError> {
        let inside = self.rest().get(mark.len_utf8()..).unwrap_or_default();
        let Some(length) = inside.find(mark) else {
            return Err(self.error(format!("there is no closing {mark}")));
        };
        self.at += length + 2 * mark.len_utf8();
        Ok(&inside[..length])
    }

    /// The next value without quotation marks, which is not taken; empty if there is none.
    pub(super) fn value_word(&mut self) -> &'a str {
        let rest = self.rest();
        let word = &rest[..rest.find(ends_value).unwrap_or(rest.len())];
        let is_sign = word.chars().all(|c| "+-/%^".contains(c)) || word == "**";
        if is_sign || word.starts_with('\'') { "" } else { word }
    }

    /// Takes the next value of a list or of one side of a comparison, if there is one.
    pub(super) fn value(&mut self) -> Result<Option<Value>, SelectError> {
        let rest = self.rest();
        let at = self.at;
        let kind = match rest.chars().next() {
            Some('\'') => ValueKind::Literal,
            Some('"') => ValueKind::Pattern,
            _ => ValueKind::Word,
        };
        let text = match rest.chars().next() {
            Some(mark @ ('\'' | '"')) => self.quoted(mark)?,
            _ => {
                let word = self.value_word();
                self.at += word.len();
                word
            }
        };
        let is_there = kind != ValueKind::Word || !(text.is_empty() || is_joint(text));
        if !is_there {
            self.at = at;
        }
        Ok(is_there.then(|| Value { text: text.to_owned(), at, kind }))
    }

    /// Takes the second number of a range whose parts are separate, such as `5 to 10`.
    pub(super) fn end_of_range(&mut self) -> Option<f64> {
        let before = self.at;
        let has_blank = self.raw().starts_with(char::is_whitespace);
        let rest = self.rest();
        let is_word = self.name() == "to";
        let sign =
            if is_word { "to" } else { ["..", ":", "-"].into_iter().find(|sign| rest.starts_with(sign)).unwrap_or("") };
        self.at += sign.len();
        // In `5 -3` the sign belongs to the second value.
        let is_sign = sign == "-" && has_blank && !self.raw().starts_with(char::is_whitespace);
        let word = self.value_word();
        match number(word).filter(|_| !sign.is_empty() && !is_sign) {
            Some(number) => {
                self.at += word.len();
                Some(number)
            }
            None => {
                self.at = before;
                None
            }
        }
    }

    /// The offset behind the parenthesis that closes the one that comes next.
    pub(super) fn closing(&mut self) -> Option<usize> {
        let (mut depth, mut quote, mut before) = (0_usize, None, ' ');
        for (at, c) in self.rest().char_indices() {
            match (quote, c) {
                (Some(mark), _) if c == mark => quote = None,
                (Some(_), _) => {}
                // Within a word, as in O5', a mark is a letter.
                (None, '\'') if !ends_value(before) => {}
                (None, '\'' | '"' | '`') => quote = Some(c),
                (None, '(') => depth += 1,
                (None, ')') if depth == 1 => return Some(self.at + at + 1),
                (None, ')') => depth -= 1,
                _ => {}
            }
            before = c;
        }
        None
    }

    /// The offset behind the last character that was taken, without white space that was skipped.
    pub(super) fn end(&self) -> usize {
        self.text.get(..self.at).map_or(0, |taken| taken.trim_end().len())
    }
}
