//! Evaluates expressions, one comparison after the other, for all spheres at once.

use std::borrow::Cow;

use super::parse::{Comparison, Expression, Operand, Operator, SelectError, Value, error_at};
use crate::column::ColumnError;
use crate::column::{NamedColumn, column};
use crate::load::{Column, ColumnValues, Labels};
use pinhole::internals::text::{listed, one_line, shortened};
use pinhole::scene::sphere_array::SphereArray;

const NO_COLUMN: &str = "this compares two fixed values; one of them must be a column, without quotation marks";

/// The data on which expressions are evaluated.
struct Data<'a> {
    text: &'a str,
    spheres: &'a SphereArray,
    columns: &'a [Column],
    notes: Vec<String>,
}

enum Side<'a> {
    Number(f64),
    Text,
    Column(NamedColumn<'a>),
    /// A word that is neither a number nor the name of a column.
    Unknown(ColumnError),
}

/// Returns for each sphere whether it matches, and notes for the user.
pub(super) fn evaluate(
    expression: &Expression,
    text: &str,
    spheres: &SphereArray,
    columns: &[Column],
) -> Result<(Vec<bool>, Vec<String>), SelectError> {
    let mut data = Data { text, spheres, columns, notes: Vec::new() };
    let matches = data.matches(expression)?;
    Ok((matches, data.notes))
}

impl<'a> Data<'a> {
    fn matches(&mut self, expression: &Expression) -> Result<Vec<bool>, SelectError> {
        let (parts, is_all) = match expression {
            Expression::Compare(comparison) => return self.compare(comparison),
            Expression::All(parts) => (parts, true),
            Expression::Any(parts) => (parts, false),
        };
        let mut joined = vec![is_all; self.spheres.len()];
        for part in parts {
            let matches = self.matches(part)?;
            for (joined, is_match) in joined.iter_mut().zip(matches) {
                *joined = if is_all { *joined && is_match } else { *joined || is_match };
            }
        }
        Ok(joined)
    }

    fn error(&self, operand: &Operand, problem: impl Into<String>) -> SelectError {
        error_at(self.text, operand.at, problem)
    }

    fn side(&self, operand: &Operand) -> Result<Side<'a>, SelectError> {
        let found = |name: &str| column(name, self.spheres, self.columns);
        match &operand.value {
            Value::Text(_) => Ok(Side::Text),
            Value::Column(name) => {
                found(name).map(Side::Column).map_err(|error| self.error(operand, error.to_string()))
            }
            Value::Word(word) => match (number(word), found(word)) {
                (Some(number), _) => Ok(Side::Number(number)),
                (None, Ok(found)) => Ok(Side::Column(found)),
                (None, Err(error @ ColumnError::Unknown { .. })) => Ok(Side::Unknown(error)),
                (None, Err(error)) => Err(self.error(operand, error.to_string())),
            },
        }
    }

    fn compare(&mut self, comparison: &Comparison) -> Result<Vec<bool>, SelectError> {
        let Comparison { sides: [left, right], operator } = comparison;
        let (left_side, right_side) = (self.side(left)?, self.side(right)?);
        if let Some((name, labels)) = texts(&left_side) {
            return self.compare_text(name, labels, (right, &right_side), *operator);
        }
        if let Some((name, labels)) = texts(&right_side) {
            return self.compare_text(name, labels, (left, &left_side), operator.mirrored());
        }
        let [a, b] = [self.numbers(left, left_side, &right.value)?, self.numbers(right, right_side, &left.value)?];
        Ok(match (a, b) {
            (Numbers::Column(a), Numbers::Column(b)) => {
                a.iter().zip(b.iter()).map(|(a, b)| operator.holds(*a, *b)).collect()
            }
            (Numbers::Column(a), Numbers::One(b)) => a.iter().map(|a| operator.holds(*a, b)).collect(),
            (Numbers::One(a), Numbers::Column(b)) => b.iter().map(|b| operator.holds(a, *b)).collect(),
            (Numbers::One(_), Numbers::One(_)) => {
                return Err(self.error(left, NO_COLUMN));
            }
        })
    }

    /// Returns the numbers of one side of a comparison in which neither side is a column of text.
    fn numbers(&self, operand: &Operand, side: Side<'a>, other: &Value) -> Result<Numbers<'a>, SelectError> {
        let problem = match side {
            Side::Number(number) => return Ok(Numbers::One(number)),
            Side::Column(NamedColumn { values, .. }) => match values {
                Cow::Borrowed(ColumnValues::Numbers(values)) => {
                    return Ok(Numbers::Column(Cow::Borrowed(values)));
                }
                Cow::Owned(ColumnValues::Numbers(values)) => {
                    return Ok(Numbers::Column(Cow::Owned(values)));
                }
                // Columns of text were handled before.
                Cow::Borrowed(ColumnValues::Labels(_)) | Cow::Owned(ColumnValues::Labels(_)) => NO_COLUMN.to_owned(),
            },
            Side::Unknown(error) => error.to_string(),
            Side::Text => {
                let (Value::Word(other) | Value::Column(other)) = other else {
                    return Err(self.error(operand, NO_COLUMN));
                };
                match number(other) {
                    Some(_) => NO_COLUMN.to_owned(),
                    None if self.is_column(other) => format!(
                        "`{}` is a text, but `{}` holds numbers",
                        shortened(operand.value.text()),
                        one_line(other)
                    ),
                    None => match column(other, self.spheres, self.columns) {
                        Err(error) => error.to_string(),
                        Ok(_) => NO_COLUMN.to_owned(),
                    },
                }
            }
        };
        Err(self.error(operand, problem))
    }

    fn is_column(&self, name: &str) -> bool {
        column(name, self.spheres, self.columns).is_ok()
    }

    fn compare_text(
        &mut self,
        name: &str,
        labels: &Labels,
        (other, side): (&Operand, &Side<'_>),
        operator: Operator,
    ) -> Result<Vec<bool>, SelectError> {
        let wanted = other.value.text();
        let is_there = labels.names.iter().any(|label| label == wanted);
        let is_name = matches!(other.value, Value::Column(_));
        if is_name || (texts(side).is_some() && !is_there) {
            let problem = format!(
                "`{}` is a column of text, too, and columns of text are compared only with texts; put quotation marks \
                 around a text",
                one_line(wanted)
            );
            return Err(self.error(other, problem));
        }
        let wanted_number = match other.value {
            Value::Word(_) => number(wanted),
            _ => None,
        };
        let is_equality = operator.is_equality();
        if !is_equality && wanted_number.is_none() {
            let name = one_line(name);
            let problem = format!("`{name}` holds text, which is compared only with == and !=, or with a number");
            return Err(self.error(other, problem));
        }
        let is_equal = |label: &String| {
            let numbers = number(label).zip(wanted_number);
            label == wanted || numbers.is_some_and(|(a, b)| Operator::EQUAL.holds(a, b))
        };
        let label_matches = |label: &String| match operator {
            _ if label.trim().is_empty() => false,
            _ if is_equality => is_equal(label) == (operator == Operator::EQUAL),
            _ => number(label).zip(wanted_number).is_some_and(|(a, b)| operator.holds(a, b)),
        };
        let are_matches: Vec<bool> = labels.names.iter().map(label_matches).collect();
        if is_equality && !labels.names.is_empty() && !labels.names.iter().any(is_equal) {
            self.notes.push(absent(name, wanted, labels));
        }
        let of = |index: &u32| are_matches.get(*index as usize).copied().unwrap_or(false);
        Ok(labels.indices.iter().map(of).collect())
    }
}

enum Numbers<'a> {
    One(f64),
    Column(Cow<'a, [f64]>),
}

impl Value {
    fn text(&self) -> &str {
        match self {
            Self::Word(text) | Self::Text(text) | Self::Column(text) => text,
        }
    }
}

/// The name and the texts of a column of text.
fn texts<'a>(side: &'a Side<'_>) -> Option<(&'a str, &'a Labels)> {
    let Side::Column(NamedColumn { name, values, .. }) = side else { return None };
    match values.as_ref() {
        ColumnValues::Labels(labels) => Some((name, labels)),
        ColumnValues::Numbers(_) => None,
    }
}

/// Parses a word as a number. Words such as `inf` and `nan` are names.
fn number(word: &str) -> Option<f64> {
    let unsigned = word.strip_prefix(['+', '-']).unwrap_or(word);
    let is_number = unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    is_number.then(|| word.parse().ok()).flatten()
}

fn absent(column: &str, wanted: &str, labels: &Labels) -> String {
    let names = labels.names.iter().filter(|label| !label.trim().is_empty());
    let shown = listed(names.map(|label| shortened(label)), 8);
    format!("no sphere has the {} `{}`; there are {shown}", one_line(column), shortened(wanted))
}
