//! Splits the text of a CIF file into tokens, as its syntax 1.1 describes them.

use memchr::memchr;
use memchr::memmem;

use crate::load::error::{self, LoadError};

/// A token, without its quotes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Token<'a> {
    Value(&'a [u8]),
    /// The name of an item, with the `_` in front.
    Name(&'a [u8]),
    Loop,
    /// Begins a data block.
    Data,
    /// Any other reserved word.
    Other,
}

/// The tokens of a text.
#[derive(Clone, Debug)]
pub(super) struct Tokens<'a> {
    text: &'a [u8],
    /// Where the next token is searched.
    pub(super) at: usize,
    /// Number of line ends before that.
    lines: usize,
    /// Where the line of the next token begins.
    line_start: usize,
}

/// Where a token begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) offset: usize,
    /// Number of lines before it.
    pub(super) lines_before: usize,
    /// Number of bytes before it in its line.
    pub(super) column: usize,
}

impl Place {
    pub(super) fn of_error(self) -> error::Place {
        error::Place::Column { line: self.lines_before + 1, column: self.column + 1 }
    }
}

impl<'a> Tokens<'a> {
    pub(super) fn new(text: &'a [u8], lines_before: usize) -> Self {
        Self { text, at: 0, lines: lines_before, line_start: 0 }
    }

    /// Goes on at the start of a line.
    pub(super) fn go_to(&mut self, offset: usize, lines_before: usize) {
        (self.at, self.lines, self.line_start) = (offset, lines_before, offset);
    }

    /// Skips white space and comments. Returns where the next token begins.
    #[inline]
    pub(super) fn place(&mut self) -> Place {
        while let Some(byte) = self.text.get(self.at) {
            match byte {
                b'\n' => {
                    self.at += 1;
                    self.lines += 1;
                    self.line_start = self.at;
                }
                b' ' | b'\t' | b'\r' => self.at += 1,
                b'#' => {
                    let rest = &self.text[self.at..];
                    self.at += memchr(b'\n', rest).unwrap_or(rest.len());
                }
                _ => break,
            }
        }
        Place { offset: self.at, lines_before: self.lines, column: self.at - self.line_start }
    }

    /// Returns the next token; `None` at the end of the text.
    #[inline]
    pub(super) fn next(&mut self) -> Result<Option<Token<'a>>, LoadError> {
        let place = self.place();
        self.next_at(place)
    }

    /// Returns the token at the place that [`Tokens::place`] has found.
    #[inline]
    pub(super) fn next_at(&mut self, place: Place) -> Result<Option<Token<'a>>, LoadError> {
        let rest = &self.text[self.at..];
        let Some(first) = rest.first() else { return Ok(None) };
        match first {
            b'\'' | b'"' => return self.quoted(*first, place).map(Some),
            b';' if place.column == 0 => return self.lines_of_text(place).map(Some),
            _ => {}
        }
        let end = rest.iter().position(|byte| *byte <= b' ').unwrap_or(rest.len());
        let word = &rest[..end];
        // No other byte ends a token, so a control character is not skipped either.
        self.at += end.max(1);
        Ok(Some(match first {
            b'_' => Token::Name(word),
            b'd' | b'D' | b'l' | b'L' | b's' | b'S' | b'g' | b'G' => reserved(word),
            _ => Token::Value(word),
        }))
    }

    /// A quote ends a text only where white space follows, or the text does.
    fn quoted(&mut self, quote: u8, place: Place) -> Result<Token<'a>, LoadError> {
        let rest = &self.text[self.at + 1..];
        let mut from = 0;
        while let Some(found) = memchr::memchr2(quote, b'\n', &rest[from..]) {
            let end = from + found;
            if rest[end] == b'\n' {
                break;
            }
            if rest.get(end + 1).is_none_or(|byte| *byte <= b' ') {
                self.at += end + 2;
                return Ok(Token::Value(&rest[..end]));
            }
            from = end + 1;
        }
        let message = "the quoted text that begins here does not end on its line";
        Err(LoadError::at(place.of_error(), message))
    }

    /// A text of several lines begins and ends with `;` at the start of a line.
    fn lines_of_text(&mut self, place: Place) -> Result<Token<'a>, LoadError> {
        let rest = &self.text[self.at + 1..];
        let end = memmem::find(rest, b"\n;").ok_or_else(|| {
            LoadError::line(
                place.lines_before + 1,
                "the text that begins here with ; does not end; a line that begins with ; must end it",
            )
        })?;
        let text = &rest[..end];
        self.lines += memchr::memchr_iter(b'\n', text).count() + 1;
        self.at += end + 3;
        self.line_start = self.at - 1;
        Ok(Token::Value(text))
    }
}

fn reserved(word: &[u8]) -> Token<'_> {
    let starts = |name: &[u8]| word.get(..name.len()).is_some_and(|w| w.eq_ignore_ascii_case(name));
    if word.eq_ignore_ascii_case(b"loop_") {
        Token::Loop
    } else if starts(b"data_") {
        Token::Data
    } else if starts(b"save_")
        || word.eq_ignore_ascii_case(b"global_")
        || word.eq_ignore_ascii_case(b"stop_")
    {
        Token::Other
    } else {
        Token::Value(word)
    }
}
