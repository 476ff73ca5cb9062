//! Finds what the words of a selection mean in the data.

use std::borrow::Cow;
use std::collections::HashMap;
use std::rc::Rc;

use glam::DVec3;

use super::error::{SelectError, error_at};
use super::graph::Graph;
use super::named::NamedSelections;
use super::tree::Word;
use super::words::{all_words, nearest};
use crate::added::bonded_pairs;
use crate::column::{ColumnError, NamedColumn, column};
use crate::keys::{Key, key_of};
use crate::load::{ColumnValues, Dataset, Labels, element_symbol};
use pinhole::internals::text::{listed, one_line, shortened};

/// The most notes about one selection.
const MOST_NOTES: usize = 8;

/// The data on which a selection is evaluated, and what was found in it so far.
pub(super) struct Data<'a> {
    pub(super) text: &'a str,
    pub(super) names: &'a NamedSelections,
    pub(super) loaded: &'a Dataset,
    pub(super) notes: Vec<String>,
    found: HashMap<String, Source<'a>>,
    residues: Option<Rc<Vec<u32>>>,
    points: Option<Rc<Vec<DVec3>>>,
    graph: Option<Rc<Graph>>,
    /// The kinds of residues.
    pub(super) kinds: Option<Rc<Vec<u16>>>,
    /// Columns of text as numbers.
    pub(super) as_numbers: HashMap<String, Rc<Cow<'a, [f64]>>>,
}

/// The values that a key means.
#[derive(Clone)]
pub(super) struct Source<'a> {
    pub(super) name: String,
    pub(super) values: Values<'a>,
}

#[derive(Clone)]
pub(super) enum Values<'a> {
    Numbers(Rc<Cow<'a, [f64]>>),
    Labels(&'a Labels),
}

impl<'a> Data<'a> {
    pub(super) fn new(text: &'a str, names: &'a NamedSelections, loaded: &'a Dataset) -> Self {
        let (found, as_numbers) = (HashMap::new(), HashMap::new());
        let (residues, points, graph, kinds) = (None, None, None, None);
        Self { text, names, loaded, notes: Vec::new(), found, residues, points, graph, kinds, as_numbers }
    }

    pub(super) fn len(&self) -> usize {
        self.loaded.spheres.len()
    }

    pub(super) fn error(&self, at: usize, problem: impl Into<String>) -> SelectError {
        error_at(self.text, at, problem)
    }

    /// Adds a note for the user.
    pub(super) fn note(&mut self, note: String) {
        if self.notes.len() < MOST_NOTES && !self.notes.contains(&note) {
            self.notes.push(note);
        }
    }

    /// Finds a column of the file. Only those that do not have one value for each sphere are errors.
    fn column(&self, name: &str, at: usize) -> Result<Option<Source<'a>>, SelectError> {
        let found = match column(name, &self.loaded.spheres, &self.loaded.columns) {
            Ok(found) => found,
            Err(ColumnError::Unknown { .. }) => return Ok(None),
            Err(error) => return Err(self.error(at, error.to_string())),
        };
        let NamedColumn { name, values } = found;
        let values = match values {
            Cow::Borrowed(ColumnValues::Labels(labels)) => Values::Labels(labels),
            Cow::Borrowed(ColumnValues::Numbers(numbers)) => Values::Numbers(Rc::new(Cow::Borrowed(numbers))),
            Cow::Owned(ColumnValues::Numbers(numbers)) => Values::Numbers(Rc::new(Cow::Owned(numbers))),
            // Columns of text are those of the file.
            Cow::Owned(ColumnValues::Labels(_)) => return Ok(None),
        };
        Ok(Some(Source { name, values }))
    }

    /// Finds the values that a word means: those of the column of this name, or of the key.
    pub(super) fn source(&mut self, word: &Word) -> Result<Source<'a>, SelectError> {
        if let Some(found) = self.found.get(&word.text) {
            return Ok(found.clone());
        }
        let own = self.column(&word.text, word.at)?;
        let source = match (own, key_of(&word.text)) {
            (Some(own), _) => own,
            (None, Some(key)) => self.of_key(key, word)?,
            (None, None) => {
                let error = column(&word.text, &self.loaded.spheres, &self.loaded.columns).err();
                return Err(self.error(word.at, error.map_or(String::new(), |error| error.to_string())));
            }
        };
        // However a name is written, its values are kept once.
        let source = self.found.get(&source.name).cloned().unwrap_or(source);
        self.found.insert(source.name.clone(), source.clone());
        self.found.insert(word.text.clone(), source.clone());
        Ok(source)
    }

    /// The values of a key, if the data has them.
    pub(super) fn optional(&mut self, name: &'static str) -> Option<Source<'a>> {
        key_of(name)?.columns.iter().find_map(|column| self.column(column, 0).ok().flatten())
    }

    fn of_key(&mut self, key: &Key, word: &Word) -> Result<Source<'a>, SelectError> {
        for name in key.columns {
            if let Some(found) = self.column(name, word.at)? {
                return Ok(found);
            }
        }
        let index = |data: &Self| data.column("index", word.at);
        let plus_one = |source: Option<Source<'a>>| match source.map(|source| source.values) {
            Some(Values::Numbers(numbers)) => numbers.iter().map(|index| index + 1.0).collect(),
            _ => Vec::new(),
        };
        let numbers = match key.name {
            "bynum" | "serial" => plus_one(index(self)?),
            "resindex" => self.residues(word.at)?.iter().map(|index| f64::from(*index)).collect(),
            "numbonds" => self.graph(word)?.counts(),
            "fragment" | "mol" => self.graph(word)?.fragments().into_iter().map(f64::from).collect(),
            "chain" | "segid" => {
                let other = if key.name == "chain" { "segid" } else { "chain" };
                let Some(found) = self.optional(other) else { return Err(self.missing(key.name, word)) };
                self.note(format!("the file has no {}; its {} is used", key.name, found.name));
                return Ok(found);
            }
            "residue" => {
                let word = Word { text: "resid".to_owned(), at: word.at };
                self.note_residue();
                return self.source(&word);
            }
            _ => return Err(self.missing(key.name, word)),
        };
        Ok(Source { name: key.name.to_owned(), values: Values::Numbers(Rc::new(Cow::Owned(numbers))) })
    }

    pub(super) fn note_residue(&mut self) {
        self.note("residue is the number resid of the file; resindex counts residues from 0".to_owned());
    }

    /// The error that the data has no values of a key.
    pub(super) fn missing(&mut self, key: &str, word: &Word) -> SelectError {
        let problem = match key {
            "element" => self.no_elements(),
            "resname" | "resid" | "residue" => self.no_residues(),
            "icode" => "the file has no insertion codes".to_owned(),
            "altloc" => {
                "altloc cannot be selected: one location of each atom is read, that of the highest occupancy".to_owned()
            }
            "model" => "model cannot be selected: each model is a frame; choose it by --frame".to_owned(),
            "file" => "file cannot be selected: one file is read at a time".to_owned(),
            _ => format!("the file has no column for {key}"),
        };
        self.error(word.at, problem)
    }

    pub(super) fn no_elements(&mut self) -> String {
        match self.optional("type").map(|source| source.values) {
            Some(Values::Labels(labels)) if !labels.names.is_empty() => {
                let mut names: Vec<String> = labels.names.iter().map(|name| shortened(name)).collect();
                names.sort_by_key(|name| (name.len(), name.clone()));
                let first = names[0].clone();
                format!("the file has no elements; write: type {first} (of {})", listed(names.into_iter(), 8))
            }
            _ => "the file has no elements".to_owned(),
        }
    }

    fn no_residues(&mut self) -> String {
        match self.optional("element").map(|source| source.values) {
            Some(Values::Labels(labels)) => {
                let names = listed(labels.names.iter().map(|name| shortened(name)), 8);
                format!("the file has no residues; it has elements {names}")
            }
            _ => "the file has no residues".to_owned(),
        }
    }

    /// Returns true for columns of the file.
    pub(super) fn is_column(&self, name: &str) -> bool {
        self.loaded.columns.iter().any(|column| column.name.eq_ignore_ascii_case(name))
    }

    /// Returns true for keys and columns of the file.
    pub(super) fn is_known(&self, word: &Word) -> bool {
        key_of(&word.text).is_some() || !matches!(self.column(&word.text, word.at), Ok(None))
    }

    /// The error that a word is neither a column nor a word of the language.
    pub(super) fn unknown(&mut self, word: &Word) -> SelectError {
        let name = one_line(&word.text);
        if self.column(&word.text, word.at).is_ok_and(|found| found.is_some()) {
            return self.error(word.at, format!("`{name}` is a column; compare it with a value, such as {name} > 0"));
        }
        let columns = self.loaded.columns.iter().map(|column| column.name.as_str());
        if self.loaded.labels("species").is_some()
            && let Some(symbol) = element_symbol(&word.text)
        {
            return self.error(word.at, format!("`{name}` is no column, class or name; write element {symbol}"));
        }
        let nearest = nearest(&word.text, all_words().chain(columns));
        let remedy = nearest.map_or(String::new(), |nearest| format!("; did you mean {}?", one_line(nearest)));
        let columns = self.loaded.columns.iter().map(|column| shortened(&column.name));
        let known = if remedy.is_empty() { format!("; the columns are {}", listed(columns, 20)) } else { remedy };
        self.error(word.at, format!("`{name}` is no column, class or name{known}"))
    }

    /// The centres of all spheres.
    pub(super) fn points(&mut self) -> Rc<Vec<DVec3>> {
        let data = self.loaded;
        let all = || Rc::new((0..data.spheres.len()).map(|index| data.center(index)).collect());
        let points = self.points.get_or_insert_with(all);
        Rc::clone(points)
    }

    /// The number of the residue of each sphere. A residue is a run of spheres that agree in all that names it.
    pub(super) fn residues(&mut self, at: usize) -> Result<Rc<Vec<u32>>, SelectError> {
        if let Some(residues) = &self.residues {
            return Ok(Rc::clone(residues));
        }
        let names = [self.optional("resid"), self.optional("resname")];
        if names.iter().all(Option::is_none) {
            let problem = self.no_residues();
            return Err(self.error(at, problem));
        }
        let more = ["chain", "segid", "icode"].map(|name| self.optional(name));
        let mut starts = vec![false; self.len()];
        for source in names.iter().chain(&more).flatten() {
            let differs: &dyn Fn(usize) -> bool = match &source.values {
                Values::Numbers(numbers) => &|index| numbers[index].to_bits() != numbers[index - 1].to_bits(),
                Values::Labels(labels) => &|index| labels.indices[index] != labels.indices[index - 1],
            };
            for (index, starts) in starts.iter_mut().enumerate().skip(1) {
                *starts |= differs(index);
            }
        }
        let number = |count: &mut u32, starts: &bool| {
            *count += u32::from(*starts);
            Some(*count)
        };
        let residues: Rc<Vec<u32>> = Rc::new(starts.iter().scan(0, number).collect());
        self.residues = Some(Rc::clone(&residues));
        Ok(residues)
    }

    /// The bonds that are drawn if nothing else is said.
    pub(super) fn graph(&mut self, word: &Word) -> Result<Rc<Graph>, SelectError> {
        if let Some(graph) = &self.graph {
            return Ok(Rc::clone(graph));
        }
        if self.loaded.labels("species").is_none() && self.loaded.bonds.is_empty() {
            let (what, problem) = (shortened(&word.text), self.no_elements());
            return Err(self.error(word.at, format!("{what} needs bonds, which are found by elements: {problem}")));
        }
        let pairs = bonded_pairs(self.loaded).map_err(|error| self.error(word.at, error.to_string()))?;
        let graph = Rc::new(Graph::new(self.len(), &pairs));
        self.graph = Some(Rc::clone(&graph));
        Ok(graph)
    }
}
