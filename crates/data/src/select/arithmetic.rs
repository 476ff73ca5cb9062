//! Evaluates comparisons of texts and of arithmetic.

use std::borrow::Cow;
use std::rc::Rc;

use super::data::{Data, Values};
use super::error::SelectError;
use super::scan::{number, range};
use super::tree::{Expression, Operator, Side, Step, Value, ValueKind, Word};
use crate::load::Labels;
use pinhole::internals::text::{one_line, shortened};

const NO_COLUMN: &str = "this compares two fixed values; one of them must be a column, without quotation marks";

/// The number of spheres for which a step is done at once.
const BLOCK: usize = 256;

/// A step with the numbers that it needs.
enum Ready<'a> {
    Number(f64),
    Column(Rc<Cow<'a, [f64]>>),
    Unary(fn(f64) -> f64),
    Binary(fn(f64, f64) -> f64),
}

impl<'a> Data<'a> {
    /// Returns the spheres for which neighbouring sides compare as the operators say, or for which one does not.
    pub(super) fn compare(
        &mut self,
        sides: &[Side],
        operators: &[Operator],
        is_negated: bool,
    ) -> Result<Vec<bool>, SelectError> {
        let sides: Vec<Side> = sides.iter().map(|side| self.with_own_column(side)).collect();
        let sides = sides.as_slice();
        if let ([left, right], [operator]) = (sides, operators) {
            for (key, other) in [(left, right), (right, left)] {
                if let Some(matches) = self.compare_with_value(key, other, *operator, is_negated)? {
                    return Ok(matches);
                }
            }
        }
        if sides.iter().all(|side| side.expression.as_ref().is_none_or(|all| !all.steps.iter().any(Step::is_column))) {
            return Err(self.error(sides[0].at, NO_COLUMN));
        }
        let ready = sides.iter().map(|side| self.ready(side, sides)).collect::<Result<Vec<_>, _>>()?;
        let count = self.len();
        let mut matches = Vec::with_capacity(count);
        let (mut stack, mut values) = (Vec::new(), vec![[0.0; BLOCK]; sides.len().min(2)]);
        let mut start = 0;
        while start < count {
            let length = BLOCK.min(count - start);
            let mut block = [!is_negated; BLOCK];
            for (place, steps) in ready.iter().enumerate() {
                let (this, before) = (place % 2, (place + 1) % 2);
                run(steps, start, length, &mut stack, &mut values[this]);
                let Some(operator) = place.checked_sub(1).and_then(|place| operators.get(place)) else { continue };
                let operator = if is_negated { operator.opposite() } else { *operator };
                for (index, is) in block[..length].iter_mut().enumerate() {
                    let holds = operator.holds(values[before][index], values[this][index]);
                    *is = if is_negated { *is || holds } else { *is && holds };
                }
            }
            matches.extend_from_slice(&block[..length]);
            start += length;
        }
        Ok(matches)
    }

    /// Takes a side such as `my-column` as a column, if the file has it, and not as arithmetic.
    fn with_own_column(&self, side: &Side) -> Side {
        let mut side = side.clone();
        if let (Some(value), None) = (&side.value, side.column())
            && value.kind == ValueKind::Word
            && number(&value.text).is_none()
            && self.is_column(&value.text)
        {
            let steps = vec![Step::Column(Word { text: value.text.clone(), at: side.at })];
            side.expression = Some(Expression { steps });
        }
        side
    }

    /// Compares a key with one text or one number, if the sides are that.
    fn compare_with_value(
        &mut self,
        key: &Side,
        other: &Side,
        operator: Operator,
        is_negated: bool,
    ) -> Result<Option<Vec<bool>>, SelectError> {
        let Some(word) = key.column() else { return Ok(None) };
        let is_alone = |side: &Side| side.column().is_some();
        // A word that is no column may be a text.
        if is_alone(other) && self.source(word).is_err() && self.source(other.column().unwrap_or(word)).is_ok() {
            return Ok(None);
        }
        let source = self.source(word)?;
        let (labels, value) = match (&source.values, &other.value) {
            (Values::Labels(labels), Some(value)) => (Some(*labels), value),
            (Values::Labels(_), None) => return self.refuse_text(&source.name, other, operator),
            (Values::Numbers(_), Some(value)) => (None, value),
            (Values::Numbers(_), None) => return Ok(None),
        };
        if !operator.is_equality() {
            let Some(labels) = labels else { return Ok(None) };
            return match number(&value.text).filter(|_| value.kind == ValueKind::Word) {
                Some(_) => Ok(None),
                None if self.is_number(other, labels) => Ok(None),
                None => self.refuse_text(&source.name, other, operator),
            };
        }
        // Quotation marks of any kind make a text after `==`.
        let kind = if value.kind == ValueKind::Pattern { ValueKind::Literal } else { value.kind };
        let value = Value { kind, ..value.clone() };
        let is_literal =
            value.kind != ValueKind::Word || number(&value.text).or(range(&value.text).map(|r| r.0)).is_some();
        match labels {
            None if other.expression.is_some() && !is_literal => return Ok(None),
            None if range(&value.text).is_some_and(|(low, high)| low > high) && other.expression.is_some() => {
                return Ok(None);
            }
            None => {}
            Some(labels) => self.refuse_column(other, labels)?,
        }
        let is_negated = is_negated == operator.accepts_equal();
        self.list(word, std::slice::from_ref(&value), is_negated).map(Some)
    }

    /// Returns true if the other side of a column of text is a column of numbers that is compared with its texts.
    fn is_number(&mut self, other: &Side, labels: &Labels) -> bool {
        let Some(word) = other.column() else { return other.expression.is_some() };
        let is_numbers = self.source(word).is_ok_and(|source| matches!(source.values, Values::Numbers(_)));
        is_numbers && labels.names.iter().any(|name| number(name).is_some())
    }

    /// The error that a text is compared with what is not one.
    fn refuse_text(&mut self, name: &str, other: &Side, operator: Operator) -> Result<Option<Vec<bool>>, SelectError> {
        let name = one_line(name);
        if let Some(column) = other.column().filter(|_| operator.is_equality()) {
            return Err(self.error(other.at, two_columns(&column.text)));
        }
        match other.expression.as_ref().is_some_and(|all| !matches!(all.steps[..], [Step::Column(_)])) {
            true => Ok(None),
            false => {
                let problem = format!("`{name}` holds text, which is compared only with == and !=, or with a number");
                Err(self.error(other.at, problem))
            }
        }
    }

    /// Refuses to compare two columns of text.
    fn refuse_column(&mut self, other: &Side, labels: &Labels) -> Result<(), SelectError> {
        let Some(word) = other.column() else { return Ok(()) };
        let is_there = labels.names.contains(&word.text);
        let is_text = !is_there && self.source(word).is_ok_and(|source| matches!(source.values, Values::Labels(_)));
        if is_text { Err(self.error(other.at, two_columns(&word.text))) } else { Ok(()) }
    }

    fn ready(&mut self, side: &Side, sides: &[Side]) -> Result<Vec<Ready<'a>>, SelectError> {
        let Some(expression) = &side.expression else {
            let text = side.value.as_ref().map_or(String::new(), |value| shortened(&value.text));
            let column = sides.iter().find_map(|side| side.column()).map_or(String::new(), |word| one_line(&word.text));
            let problem = if column.is_empty() {
                NO_COLUMN.to_owned()
            } else {
                format!("`{text}` is a text, but `{column}` holds numbers")
            };
            return Err(self.error(side.at, problem));
        };
        let step = |step: &Step| {
            Ok(match step {
                Step::Number(number) => Ready::Number(*number),
                Step::Column(word) => Ready::Column(self.numbers(word)?),
                Step::Unary(function) => Ready::Unary(*function),
                Step::Binary(function) => Ready::Binary(*function),
            })
        };
        expression.steps.iter().map(step).collect()
    }

    /// The numbers of a column; texts that are none are missing.
    fn numbers(&mut self, word: &Word) -> Result<Rc<Cow<'a, [f64]>>, SelectError> {
        let source = self.source(word)?;
        let labels = match source.values {
            Values::Numbers(numbers) => return Ok(numbers),
            Values::Labels(labels) => labels,
        };
        if let Some(numbers) = self.as_numbers.get(&source.name) {
            return Ok(Rc::clone(numbers));
        }
        let all: Vec<f64> = labels.names.iter().map(|name| number(name).unwrap_or(f64::NAN)).collect();
        if all.iter().all(|number| number.is_nan()) && !all.is_empty() {
            let name = one_line(&source.name);
            let problem = format!("`{name}` holds text, which is compared only with == and !=, or with a number");
            return Err(self.error(word.at, problem));
        }
        let of = |index: &u32| all.get(*index as usize).copied().unwrap_or(f64::NAN);
        let numbers = Rc::new(Cow::Owned(labels.indices.iter().map(of).collect()));
        self.as_numbers.insert(source.name, Rc::clone(&numbers));
        Ok(numbers)
    }
}

fn two_columns(wanted: &str) -> String {
    format!(
        "`{}` is a column of text, too, and columns of text are compared only with texts; put quotation marks around a text",
        one_line(wanted)
    )
}

impl Step {
    fn is_column(&self) -> bool {
        matches!(self, Self::Column(_))
    }
}

/// Evaluates the steps for some spheres. The stack only keeps its memory.
fn run(steps: &[Ready<'_>], start: usize, length: usize, stack: &mut Vec<[f64; BLOCK]>, result: &mut [f64; BLOCK]) {
    let mut height = 0;
    for step in steps {
        if let Ready::Number(_) | Ready::Column(_) = step {
            if height == stack.len() {
                stack.push([0.0; BLOCK]);
            }
            height += 1;
        }
        match (step, &mut stack[..height]) {
            (Ready::Number(number), [.., top]) => top[..length].fill(*number),
            (Ready::Column(numbers), [.., top]) => top[..length].copy_from_slice(&numbers[start..start + length]),
            (Ready::Unary(function), [.., top]) => top[..length].iter_mut().for_each(|x| *x = function(*x)),
            (Ready::Binary(function), [.., below, top]) => {
                below[..length].iter_mut().zip(top).for_each(|(a, b)| *a = function(*a, *b));
                height -= 1;
            }
            _ => {}
        }
    }
    if let Some(top) = stack[..height].last() {
        result[..length].copy_from_slice(&top[..length]);
    }
}
