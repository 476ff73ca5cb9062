//! Compares the texts and numbers of the data with the values of a list.

use std::collections::{HashMap, HashSet};

use super::data::{Data, Source, Values};
use super::error::SelectError;
use super::scan::{number, range};
use super::tree::{Value, ValueKind, Word};
use crate::keys::key_of;
use crate::load::Labels;
use pinhole::internals::text::{listed, one_line, shortened};

/// The most texts that are compared with one that none is equal to.
const MOST_COMPARED: usize = 10_000;

/// So many values are compared one by one.
const FEW: usize = 8;

/// The numbers of a list: ranges, sorted, which do not overlap.
struct Ranges(Vec<(f64, f64)>);

impl Ranges {
    fn new(mut all: Vec<(f64, f64)>) -> Self {
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut joined: Vec<(f64, f64)> = Vec::new();
        for (low, high) in all {
            match joined.last_mut().filter(|last| low <= last.1) {
                Some(last) => last.1 = last.1.max(high),
                None => joined.push((low, high)),
            }
        }
        Self(joined)
    }

    fn contain(&self, value: f64) -> bool {
        let behind = self.0.partition_point(|(low, _)| *low <= value);
        behind > 0 && value <= self.0[behind - 1].1
    }
}

/// The parts of a value that `+` separates, with the offset of each.
fn parts(value: &Value) -> impl Iterator<Item = &str> {
    value.text.split('+').filter(|part| !part.is_empty())
}

/// A residue number with an insertion code, such as `52A`.
fn with_code(text: &str) -> Option<(f64, &str)> {
    let at = text.char_indices().last().filter(|(_, c)| c.is_alphabetic())?.0;
    Some((number(&text[..at])?, &text[at..]))
}

/// Returns true if `*` stands for any text in the pattern, and `?` for a character.
fn is_like(text: &str, pattern: &str) -> bool {
    let (text, pattern): (Vec<char>, Vec<char>) = (text.chars().collect(), pattern.chars().collect());
    let (mut at, mut of, mut star) = (0, 0, None);
    while at < text.len() {
        match pattern.get(of) {
            Some('*') => {
                star = Some((at, of));
                of += 1;
            }
            Some(c) if *c == '?' || *c == text[at] => {
                at += 1;
                of += 1;
            }
            _ => {
                let Some((from, of_star)) = star else { return false };
                star = Some((from + 1, of_star));
                (at, of) = (from + 1, of_star + 1);
            }
        }
    }
    pattern[of..].iter().all(|c| *c == '*')
}

impl<'a> Data<'a> {
    /// Returns the spheres whose value of a key is one of these, or is none of these. Those without a value never match.
    pub(super) fn list(&mut self, key: &Word, values: &[Value], is_negated: bool) -> Result<Vec<bool>, SelectError> {
        if !self.is_known(key) {
            return Err(self.unknown(key));
        }
        let source = self.source_of_list(key, values)?;
        match &source.values {
            Values::Labels(labels) => {
                let is_match = self.matching(key, &source, labels, values)?;
                let has_text: Vec<bool> = labels.names.iter().map(|name| !name.trim().is_empty()).collect();
                let of = |all: &[bool], index: u32| all.get(index as usize).copied().unwrap_or(false);
                let is_kept = |index: &u32| of(&has_text, *index) && of(&is_match, *index) != is_negated;
                Ok(labels.indices.iter().map(is_kept).collect())
            }
            Values::Numbers(numbers) => self.numbers_in(&source, numbers, values, is_negated),
        }
    }

    /// A residue has a name and a number; its values say which is meant.
    fn source_of_list(&mut self, key: &Word, values: &[Value]) -> Result<Source<'a>, SelectError> {
        if !key.text.eq_ignore_ascii_case("residue") {
            return self.source(key);
        }
        let is_number = |value: &Value| match value.kind {
            ValueKind::Word => parts(value).all(|part| number(part).or(range(part).map(|r| r.0)).is_some()),
            ValueKind::Range(..) => true,
            _ => false,
        };
        let name = if values.iter().all(is_number) { "resid" } else { "resname" };
        let has_own = matches!(self.source(key)?.values, Values::Numbers(_)) && self.loaded.column("residue").is_some();
        if has_own {
            return self.source(key);
        }
        if name == "resid" {
            self.note_residue();
        }
        self.source(&Word { text: name.to_owned(), at: key.at })
    }

    /// Returns for each text of a column whether it is one of the values.
    fn matching(
        &mut self,
        key: &Word,
        source: &Source<'a>,
        labels: &Labels,
        values: &[Value],
    ) -> Result<Vec<bool>, SelectError> {
        let is_element = key_of(&source.name).is_some_and(|key| key.name == "element");
        let has_many = values.len() > FEW;
        let mut table = Table::new(labels, is_element, has_many);
        let mut without_case = None;
        for value in values {
            let count = table.add(value).map_err(|problem| self.error(value.at, problem))?;
            if count > 0 || labels.names.is_empty() {
                continue;
            }
            // Texts in the wrong case are better than none.
            let loose = without_case.get_or_insert_with(|| Table::new(labels, true, has_many));
            let count = loose.add(value).map_err(|problem| self.error(value.at, problem))?;
            if count == 0 {
                self.note(absent(&key.text, value, labels));
            } else {
                let found = labels.names.iter().zip(&loose.is_match).filter(|(_, is)| **is);
                let names = listed(found.map(|(name, _)| shortened(name)), 5);
                let name = one_line(&key.text);
                self.note(format!("no sphere has the {name} {}; {names} is taken", shortened(&value.text)));
            }
        }
        if let Some(loose) = without_case {
            table.is_match.iter_mut().zip(loose.is_match).for_each(|(is, also)| *is |= also);
        }
        Ok(table.is_match)
    }

    fn numbers_in(
        &mut self,
        source: &Source<'a>,
        numbers: &[f64],
        values: &[Value],
        is_negated: bool,
    ) -> Result<Vec<bool>, SelectError> {
        let is_resid = key_of(&source.name).is_some_and(|key| key.name == "resid");
        let (mut all, mut codes) = (Vec::new(), Vec::new());
        for value in values {
            if let ValueKind::Range(low, high) = value.kind {
                all.push((low, high));
                continue;
            }
            if value.kind == ValueKind::Word && value.text == "*" {
                all.push((f64::NEG_INFINITY, f64::INFINITY));
                continue;
            }
            for part in parts(value).filter(|_| value.kind == ValueKind::Word) {
                match (number(part), range(part), with_code(part)) {
                    (Some(number), ..) => all.push((number, number)),
                    (_, Some(range), _) => all.push(range),
                    (_, _, Some((number, code))) if is_resid => codes.push((number.to_bits(), code)),
                    _ => return Err(self.no_number(source, value)),
                }
            }
            if value.kind != ValueKind::Word || parts(value).next().is_none() {
                return Err(self.no_number(source, value));
            }
        }
        if let Some((low, high)) = all.iter().find(|(low, high)| low > high) {
            return Err(
                self.error(values[0].at, format!("the range from {low} to {high} is empty; write {high} to {low}"))
            );
        }
        let icodes = match self.optional("icode").map(|source| source.values) {
            _ if codes.is_empty() => None,
            Some(Values::Labels(labels)) => Some(labels),
            _ => return Err(self.missing("icode", &Word { text: String::new(), at: values[0].at })),
        };
        let codes: HashSet<(u64, &str)> = codes.into_iter().collect();
        let ranges = Ranges::new(all);
        let has_code = |index: usize, number: f64| {
            icodes.is_some_and(|labels| {
                let code = labels.names.get(labels.indices[index] as usize).map_or("", |code| code.as_str());
                codes.contains(&(number.to_bits(), code))
            })
        };
        let is_in = |(index, number): (usize, &f64)| {
            !number.is_nan() && (ranges.contain(*number) || has_code(index, *number)) != is_negated
        };
        let matches: Vec<bool> = numbers.iter().enumerate().map(is_in).collect();
        if !matches.contains(&true) && !is_negated {
            self.note_no_number(source, numbers, values);
        }
        Ok(matches)
    }

    fn no_number(&self, source: &Source<'_>, value: &Value) -> SelectError {
        let (text, name) = (shortened(&value.text), one_line(&source.name));
        let problem = match value.kind {
            ValueKind::Word => format!("`{text}` is not a number, but `{name}` holds numbers"),
            _ => format!("`{text}` is a text, but `{name}` holds numbers"),
        };
        self.error(value.at, problem)
    }

    /// Says which numbers there are.
    fn note_no_number(&mut self, source: &Source<'_>, numbers: &[f64], values: &[Value]) {
        let (low, high) =
            numbers.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), n| (low.min(*n), high.max(*n)));
        if low > high {
            return;
        }
        let name = one_line(&source.name);
        let wanted = listed(values.iter().map(|value| shortened(&value.text)), 3);
        self.note(match name.as_str() {
            "index" => format!("indices go from {low} to {high}; the file's numbers are `serial`"),
            _ => format!("no sphere has the {name} {wanted}; they go from {low} to {high}"),
        });
    }
}

/// The texts of a column, and which of them match.
struct Table<'a> {
    labels: &'a Labels,
    ignores_case: bool,
    /// The places of the texts, if there are many values.
    places: HashMap<String, Vec<usize>>,
    is_match: Vec<bool>,
}

impl<'a> Table<'a> {
    fn new(labels: &'a Labels, ignores_case: bool, has_many: bool) -> Self {
        let mut table =
            Self { labels, ignores_case, places: HashMap::new(), is_match: vec![false; labels.names.len()] };
        for (place, name) in labels.names.iter().enumerate().filter(|_| has_many) {
            table.places.entry(table.folded(name)).or_default().push(place);
        }
        table
    }

    fn folded(&self, text: &str) -> String {
        if self.ignores_case { text.to_lowercase() } else { text.to_owned() }
    }

    /// Adds the texts for which this is true. Returns their number.
    fn add_all(&mut self, is_match: impl Fn(&str) -> bool) -> usize {
        let mut count = 0;
        for (name, is) in self.labels.names.iter().zip(&mut self.is_match) {
            if is_match(name) {
                *is = true;
                count += 1;
            }
        }
        count
    }

    /// Adds the texts that are equal. Returns their number.
    fn add_equal(&mut self, text: &str) -> usize {
        if self.places.is_empty() {
            let (ignores_case, lower) = (self.ignores_case, text.to_lowercase());
            return self.add_all(|name| {
                name == text || ignores_case && name.chars().flat_map(char::to_lowercase).eq(lower.chars())
            });
        }
        let places = self.places.get(&self.folded(text)).map_or(&[][..], |places| places);
        places.iter().for_each(|place| self.is_match[*place] = true);
        places.len()
    }

    /// Adds the texts that a value means. Returns their number.
    fn add(&mut self, value: &Value) -> Result<usize, String> {
        let text = value.text.as_str();
        if value.kind != ValueKind::Regex && !matches!(value.kind, ValueKind::Range(..)) {
            let count = self.add_equal(text);
            if count > 0 || value.kind == ValueKind::Literal {
                return Ok(count);
            }
        }
        match value.kind {
            ValueKind::Range(low, high) => Ok(self.add_range(low, high)),
            ValueKind::Regex | ValueKind::Pattern => {
                let start = if self.ignores_case { "(?i)" } else { "" };
                let regex = regex_lite::Regex::new(&format!("{start}^(?:{text})$"));
                let regex = regex.map_err(|error| {
                    format!("`{}` is not a regular expression: {}", shortened(text), one_line(&error.to_string()))
                })?;
                Ok(self.add_all(|name| regex.is_match(name)))
            }
            _ => Ok(parts(value).map(|part| self.add_part(part)).sum()),
        }
    }

    fn add_part(&mut self, part: &str) -> usize {
        let equal = self.add_equal(part);
        if equal > 0 {
            return equal;
        }
        match (number(part), range(part)) {
            (Some(wanted), _) => self.add_range(wanted, wanted),
            (_, Some((low, high))) => self.add_range(low, high),
            _ if part.contains(['*', '?']) => {
                let (pattern, ignores_case) = (self.folded(part), self.ignores_case);
                self.add_all(|name| {
                    if ignores_case { is_like(&name.to_lowercase(), &pattern) } else { is_like(name, &pattern) }
                })
            }
            _ => 0,
        }
    }

    fn add_range(&mut self, low: f64, high: f64) -> usize {
        self.add_all(|name| number(name).is_some_and(|number| low <= number && number <= high))
    }
}

/// Says that no sphere has a text, and what they have.
fn absent(column: &str, wanted: &Value, labels: &Labels) -> String {
    let names = labels.names.iter().enumerate().filter(|(_, name)| !name.trim().is_empty());
    let distance = |name: &str| strsim::osa_distance(&name.to_lowercase(), &shortened(&wanted.text).to_lowercase());
    let near = names.clone().take(MOST_COMPARED).map(|(place, name)| (distance(&shortened(name)), place, name));
    let most = if wanted.text.chars().count() > 2 { 1 } else { 0 };
    let nearest = near.filter(|(distance, ..)| *distance <= most).min();
    let start = format!("no sphere has the {} {}", one_line(column), shortened(&wanted.text));
    match nearest {
        Some((_, place, name)) => {
            let count = labels.indices.iter().filter(|index| **index as usize == place).count();
            format!("{start}; nearest: {} ({count})", shortened(name))
        }
        None => format!("{start}; there are {}", listed(names.map(|(_, name)| shortened(name)), 8)),
    }
}
