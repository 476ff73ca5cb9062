//! Finds the models of a file: rows of atoms that follow each other and have the same number of a model.

use std::collections::HashSet;

use memchr::memchr;

use super::errors::cut_row;
use super::header::Columns;
use super::tokens::{Place, Token, Tokens};
use crate::load::error::LoadError;
use crate::text::shortened;

/// A model's rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Model {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) lines_before: usize,
}

/// The models of a text, and what is wrong after them.
pub(super) fn find(text: &[u8]) -> (Vec<Model>, Option<LoadError>) {
    let mut models = Vec::new();
    let problem = search(text, &mut models).err();
    (models, problem)
}

fn search(text: &[u8], models: &mut Vec<Model>) -> Result<(), LoadError> {
    let mut tokens = Tokens::new(text, 0);
    let mut names: Option<Vec<&[u8]>> = None;
    loop {
        let place = tokens.place();
        let mut next = tokens.clone();
        match (next.next()?, &mut names) {
            (None, _) => return Ok(()),
            (Some(Token::Loop), _) => names = Some(Vec::new()),
            (Some(Token::Name(name)), Some(names)) => names.push(name),
            (Some(Token::Value(_)), Some(of_loop)) => {
                let columns = Columns::of_names(of_loop);
                names = None;
                if let Some(columns) = columns {
                    let found = Rows { text, columns: &columns, first: place };
                    next = match found.by_lines(models)? {
                        Some(tokens) => tokens,
                        None => found.by_values(models)?,
                    };
                }
            }
            _ => names = None,
        }
        tokens = next;
    }
}

/// The rows of a loop.
struct Rows<'a, 'c> {
    text: &'a [u8],
    columns: &'c Columns,
    first: Place,
}

/// The models of a loop so far.
struct Found<'a> {
    models: Vec<Model>,
    names: HashSet<&'a [u8]>,
    current: &'a [u8],
}

impl<'a> Found<'a> {
    fn new() -> Self {
        Self { models: Vec::new(), names: HashSet::new(), current: b"" }
    }

    fn begin(&mut self, name: &'a [u8], place: Place) -> Result<(), LoadError> {
        if !self.names.insert(name) {
            let model = shortened(&String::from_utf8_lossy(name));
            let message = format!(
                "the model {model} begins again; all atoms of a model must follow each other"
            );
            return Err(LoadError::line(place.lines_before + 1, message));
        }
        self.current = name;
        self.end(place.offset);
        let Place { offset, lines_before, .. } = place;
        self.models.push(Model { start: offset, end: offset, lines_before });
        Ok(())
    }

    fn end(&mut self, offset: usize) {
        if let Some(last) = self.models.last_mut() {
            last.end = offset;
        }
    }
}

impl<'a> Rows<'a, '_> {
    /// Finds models where each row is a line that ends with the number of its model, as the archives of the wwPDB have them;
    /// `None` if the rows are not like this.
    fn by_lines(&self, models: &mut Vec<Model>) -> Result<Option<Tokens<'a>>, LoadError> {
        let Self { text, columns, first } = *self;
        if columns.model != Some(columns.count - 1) || first.column != 0 {
            return Ok(None);
        }
        let mut found = Found::new();
        let (mut at, mut lines_before) = (first.offset, first.lines_before);
        while at < text.len() {
            let rest = &text[at..];
            let end = memchr(b'\n', rest).unwrap_or(rest.len());
            let line = rest[..end].trim_ascii_end();
            match line.first() {
                Some(b';') => return Ok(None),
                Some(b'#' | b'_') | None => break,
                Some(_) => {}
            }
            let last = line.rsplit(|byte| *byte <= b' ').next().unwrap_or_default();
            if found.models.is_empty() || last != found.current {
                let mut tokens = Tokens::new(line, 0);
                let mut values = 0;
                // What is wrong in the line is found value by value, which knows its number.
                while let Ok(Some(Token::Value(_))) = tokens.next() {
                    values += 1;
                }
                // Another loop or block follows the rows.
                if values == 0 {
                    break;
                }
                if values != columns.count {
                    return Ok(None);
                }
                found.begin(last, Place { offset: at, lines_before, column: 0 })?;
            }
            at = (at + end + 1).min(text.len());
            lines_before += 1;
        }
        let mut tokens = Tokens::new(text, 0);
        tokens.go_to(at, lines_before);
        // What follows must not be a value, or rows are not lines.
        tokens.place();
        if let Some(Token::Value(_)) = tokens.clone().next()? {
            return Ok(None);
        }
        found.end(at);
        models.append(&mut found.models);
        Ok(Some(tokens))
    }

    /// Finds models value by value.
    fn by_values(&self, models: &mut Vec<Model>) -> Result<Tokens<'a>, LoadError> {
        let Self { text, columns, first } = *self;
        let mut tokens = Tokens::new(text, first.lines_before);
        tokens.go_to(first.offset, first.lines_before);
        let mut found = Found::new();
        let result = loop {
            let row = tokens.place();
            let mut name: &[u8] = b"";
            let mut values = 0;
            let mut last = tokens.clone();
            while values < columns.count {
                last = tokens.clone();
                let Some(Token::Value(value)) = tokens.next()? else { break };
                if Some(values) == columns.model {
                    name = value;
                }
                values += 1;
            }
            if values == 0 {
                found.end(row.offset);
                break Ok(last);
            }
            if values < columns.count {
                found.end(row.offset);
                break Err(cut_row(row, values, columns.count));
            }
            if (found.models.is_empty() || name != found.current)
                && let Err(error) = found.begin(name, row)
            {
                found.end(row.offset);
                break Err(error);
            }
        };
        models.extend(found.models.into_iter().filter(|model| model.end > model.start));
        result
    }
}
