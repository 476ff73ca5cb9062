//! Parses comparisons, lists of values and arithmetic.

use super::error::{SelectError, error_at};
use super::parse::Parser;
use super::scan::number;
use super::tree::{Expression, Node, Operator, Side, Step, Value, ValueKind, Word};
use super::words::{Arguments, function, is_joint, is_reserved};
use crate::keys::key_of;
use pinhole::internals::text::shortened;

/// Keys whose values are texts, so that `*` after them is a value and not a product.
const TEXTS: [&str; 7] = ["element", "name", "type", "resname", "chain", "segid", "record"];

impl Parser<'_> {
    /// Parses a list of values of a key, or a comparison.
    pub(super) fn list_or_comparison(&mut self) -> Result<Node, SelectError> {
        let start = self.scanner.at;
        match self.list()? {
            Some(node) => Ok(node),
            None => {
                self.scanner.at = start;
                self.comparison()
            }
        }
    }

    fn list(&mut self) -> Result<Option<Node>, SelectError> {
        let word = self.scanner.name();
        let key = Word { text: word.to_owned(), at: self.scanner.at };
        if word.is_empty() {
            return Ok(None);
        }
        self.scanner.at += word.len();
        let end_of_key = self.scanner.at;
        let known = key_of(word);
        let has_in = self.scanner.take_word("in");
        let has_not_in = !has_in && self.take_not_in();
        let mut operator = Operator::EQUAL;
        let mut is_compared = false;
        let is_strict = self.scanner.rest().starts_with("==");
        if !(has_in || has_not_in)
            && let Some(found) = self.scanner.operator()
        {
            if !found.is_equality() || found.is_regex {
                return Ok(None);
            }
            (operator, is_compared) = (found, true);
        }
        let has_blank = self.scanner.text[end_of_key..].starts_with(|c: char| c.is_whitespace() || "([\"'".contains(c));
        let next = self.scanner.value_word();
        // After a word that may be a typing error comes a value only if it is none of the language.
        let is_other =
            known.is_none() && !has_in && !has_not_in && (is_reserved(next) || self.scanner.raw().starts_with('('));
        let is_other_key = is_compared && key_of(next).is_some() && is_reserved(next);
        if !(has_blank || is_compared) || is_other || is_other_key {
            return Ok(None);
        }
        let is_product = next == "*" && !known.is_some_and(|key| TEXTS.contains(&key.name)) && {
            let sign = self.scanner.at;
            self.scanner.at += 1;
            let after = self.scanner.value_word();
            self.scanner.at = sign;
            !(after.is_empty() || is_joint(after))
        };
        if is_product {
            return Ok(None);
        }
        let values = self.values()?;
        let is_list = has_in || has_not_in || values.len() > 1 || !is_compared;
        let is_arithmetic =
            self.scanner.is_before_operator() || self.scanner.rest().starts_with(['+', '-', '/', '%', '^']);
        if values.is_empty() && (has_in || has_not_in) {
            return Err(self.scanner.wanted("a value"));
        }
        if values.is_empty() || !is_list || is_arithmetic {
            return Ok(None);
        }
        let is_negated = has_not_in || operator == Operator::UNEQUAL;
        if let (true, Some(second)) = (is_strict, values.get(1)) {
            let texts: Vec<_> = values.iter().take(5).map(|value| shortened(&value.text)).collect();
            let problem = format!("== takes one value: {} {}", shortened(&key.text), texts.join(" "));
            return Err(error_at(self.scanner.text, second.at, problem));
        }
        Ok(Some(Node::List { key, values, is_negated }))
    }

    fn take_not_in(&mut self) -> bool {
        let at = self.scanner.at;
        let is_there = self.scanner.take_word("not") && self.scanner.take_word("in");
        if !is_there {
            self.scanner.at = at;
        }
        is_there
    }

    /// Parses the values of a list, with or without parentheses.
    fn values(&mut self) -> Result<Vec<Value>, SelectError> {
        let open = self.scanner.at;
        let close = match self.scanner.rest().chars().next() {
            Some('(') => ")",
            Some('[') => "]",
            _ => "",
        };
        self.scanner.rest();
        let open_at = self.scanner.at;
        self.scanner.at += close.len();
        let mut values: Vec<Value> = Vec::new();
        loop {
            let before = self.scanner.at;
            let has_comma = !values.is_empty() && self.scanner.take(",");
            let is_first = values.is_empty() || has_comma;
            let ends = !is_first && self.ends_list();
            let value = if ends { None } else { self.scanner.value()? };
            let Some(mut value) = value else {
                if has_comma {
                    return Err(self.scanner.wanted("a value after the comma"));
                }
                self.scanner.at = before;
                break;
            };
            if let (ValueKind::Word, Some(low)) = (value.kind, number(&value.text))
                && let Some(high) = self.scanner.end_of_range()
            {
                value.kind = ValueKind::Range(low, high);
                value.text = format!("{low} to {high}");
            }
            values.push(value);
        }
        if !close.is_empty() && !self.scanner.take(close) {
            // Arithmetic in parentheses is not a list.
            if self.scanner.rest().is_empty() {
                return Err(error_at(self.scanner.text, open_at, self.unclosed(open_at)));
            }
            self.scanner.at = open;
            return Ok(Vec::new());
        }
        Ok(values)
    }

    /// Returns true if a reserved word or a key before an operator comes next.
    fn ends_list(&mut self) -> bool {
        let word = self.scanner.value_word();
        let at = self.scanner.at;
        self.scanner.at += word.len();
        let is_before_operator = self.scanner.is_before_operator();
        self.scanner.at = at;
        match word.len() {
            1 => is_before_operator && word.starts_with(|c: char| c.is_alphabetic()),
            _ => is_reserved(word),
        }
    }

    /// Parses a comparison of two sides or more.
    fn comparison(&mut self) -> Result<Node, SelectError> {
        let first = self.side()?;
        let mut sides = vec![first];
        let mut operators = Vec::new();
        loop {
            let before = self.scanner.rest();
            let Some(operator) = self.scanner.operator() else { break };
            let is_strict = before.starts_with("==");
            let mut side = self.side()?;
            if operator.is_regex {
                let Some(value) = side.value.take().filter(|_| operators.is_empty()) else {
                    return Err(error_at(
                        self.scanner.text,
                        side.at,
                        "a regular expression in quotation marks belongs here",
                    ));
                };
                side = Side { at: side.at, value: Some(Value { kind: ValueKind::Regex, ..value }), expression: None };
            }
            if is_strict && operators.is_empty() {
                self.refuse_second_value(&sides[0], &side)?;
            }
            self.refuse_unit(&side)?;
            sides.push(side);
            operators.push(operator);
        }
        if !operators.is_empty() {
            return Ok(Node::Compare { sides, operators });
        }
        match sides[0].column() {
            Some(word) if key_of(&word.text).is_none() && !self.scanner.text[word.at..].starts_with(['`', '|']) => {
                Ok(Node::Unknown(word.clone()))
            }
            _ => Err(self.scanner.wanted("a comparison, such as ==, != or <,")),
        }
    }

    fn refuse_unit(&mut self, side: &Side) -> Result<(), SelectError> {
        let [Step::Number(value)] = side.expression.as_ref().map_or(&[][..], |all| &all.steps) else { return Ok(()) };
        match self.scanner.wrong_unit(*value) {
            Some(problem) => Err(self.scanner.error(problem)),
            None => Ok(()),
        }
    }

    fn refuse_second_value(&mut self, key: &Side, value: &Side) -> Result<(), SelectError> {
        let (Some(key), Some(value)) = (key.column(), &value.value) else { return Ok(()) };
        let second = self.scanner.value_word();
        let at = self.scanner.at;
        self.scanner.at += second.len();
        let is_compared = self.scanner.is_before_operator();
        self.scanner.at = at;
        let is_value = !second.is_empty() && !is_reserved(second) && key_of(second).is_none() && second != "nm";
        if is_compared || !is_value || self.scanner.raw().starts_with('*') {
            return Ok(());
        }
        let all = [&key.text, &value.text, second].map(shortened).join(" ");
        Err(self.scanner.error(format!("== takes one value: {all}")))
    }

    /// Parses a side of a comparison: the longer of its readings as a text and as arithmetic, or both.
    fn side(&mut self) -> Result<Side, SelectError> {
        self.scanner.rest();
        let at = self.scanner.at;
        let value = self.scanner.value()?;
        let end_of_value = self.scanner.end();
        if value.as_ref().is_some_and(|value| value.kind != ValueKind::Word) {
            return Ok(Side { at, value, expression: None });
        }
        self.scanner.at = at;
        let steps_before = self.steps.len();
        let parsed = self.sum();
        let steps = self.steps.split_off(steps_before);
        let end = self.scanner.end();
        let goes_on = self.scanner.text[end_of_value..].trim_start().starts_with(['(', '+', '-', '*', '/', '%', '^']);
        match parsed {
            Err(error) if value.is_none() || goes_on => Err(error),
            Ok(()) if end >= end_of_value => {
                let value = value.filter(|_| end == end_of_value);
                Ok(Side { at, value, expression: Some(Expression { steps }) })
            }
            _ => {
                self.scanner.at = end_of_value;
                Ok(Side { at, value, expression: None })
            }
        }
    }

    fn sum(&mut self) -> Result<(), SelectError> {
        self.nested(|parser| {
            parser.product()?;
            loop {
                let step: fn(f64, f64) -> f64 = match parser.scanner.rest().chars().next() {
                    Some('+') => |a, b| a + b,
                    Some('-') => |a, b| a - b,
                    _ => return Ok(()),
                };
                parser.scanner.at += 1;
                parser.product()?;
                parser.steps.push(Step::Binary(step));
            }
        })
    }

    fn product(&mut self) -> Result<(), SelectError> {
        self.unary()?;
        loop {
            let step: fn(f64, f64) -> f64 = match self.scanner.rest().chars().next() {
                Some('*') => |a, b| a * b,
                Some('/') => |a, b| a / b,
                Some('%') => |a, b| a % b,
                _ => return Ok(()),
            };
            self.scanner.at += 1;
            self.unary()?;
            self.steps.push(Step::Binary(step));
        }
    }

    fn unary(&mut self) -> Result<(), SelectError> {
        let mut is_negative = false;
        while let Some(sign) = self.scanner.rest().chars().next().filter(|c| "+-".contains(*c)) {
            is_negative ^= sign == '-';
            self.scanner.at += 1;
        }
        self.primary()?;
        let is_power = self.scanner.take("**") || self.scanner.take("^");
        if is_power {
            self.nested(Self::unary)?;
            self.steps.push(Step::Binary(f64::powf));
        }
        if is_negative {
            self.steps.push(Step::Unary(|x| -x));
        }
        Ok(())
    }

    fn primary(&mut self) -> Result<(), SelectError> {
        const WANTED: &str = "a column, a number or a text";
        let rest = self.scanner.rest();
        let at = self.scanner.at;
        if let Some(number) = self.scanner.number() {
            self.steps.push(Step::Number(number));
            return Ok(());
        }
        let column = match rest.chars().next() {
            Some('`') => self.scanner.quoted('`')?.to_owned(),
            Some('|') => format!("|{}|", self.scanner.quoted('|')?.trim()),
            Some('(') => {
                self.scanner.at += 1;
                self.sum()?;
                return self.close(at);
            }
            _ => {
                let name = self.scanner.name();
                if name.is_empty() || is_joint(name) {
                    return Err(self.scanner.wanted(WANTED));
                }
                self.scanner.at += name.len();
                if self.scanner.raw().starts_with('(') && key_of(name).is_none() {
                    return self.call(name, at);
                }
                if name == "pi" {
                    self.steps.push(Step::Number(std::f64::consts::PI));
                    return Ok(());
                }
                name.to_owned()
            }
        };
        self.steps.push(Step::Column(Word { text: column, at }));
        Ok(())
    }

    fn call(&mut self, name: &str, at: usize) -> Result<(), SelectError> {
        let Some((step, arguments)) = function(name) else {
            let problem = format!("there is no function `{}`", shortened(name));
            return Err(error_at(self.scanner.text, at, problem));
        };
        let open = self.scanner.at;
        self.scanner.at += 1;
        let mut count = 0;
        loop {
            self.sum()?;
            count += 1;
            if arguments != Arguments::One && count > 1 {
                self.steps.push(step.clone());
            }
            if !self.scanner.take(",") {
                break;
            }
        }
        let (is_right, takes) = match arguments {
            Arguments::One => (count == 1, "one argument"),
            Arguments::Two => (count == 2, "two arguments"),
            Arguments::AtLeastTwo => (count > 1, "two arguments or more"),
        };
        if !is_right {
            return Err(error_at(self.scanner.text, at, format!("{name} takes {takes}, not {count}")));
        }
        if arguments == Arguments::One {
            self.steps.push(step);
        }
        self.close(open)
    }
}
