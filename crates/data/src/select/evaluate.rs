//! Evaluates selections, one part after the other, for all spheres at once.

use std::collections::HashSet;

use glam::DVec3;

use super::data::{Data, Values};
use super::error::SelectError;
use super::named::NamedSelections;
use super::near::{Grid, is_somewhere};
use super::tree::{Bonded, Near, Node, Place, Word};
use crate::cell::PeriodicCell;
use crate::load::Dataset;

/// Returns for each sphere whether it matches, and notes for the user.
pub(super) fn evaluate(
    node: &Node,
    text: &str,
    names: &NamedSelections,
    loaded: &Dataset,
) -> Result<(Vec<bool>, Vec<String>), SelectError> {
    let mut data = Data::new(text, names, loaded);
    let matches = data.matches(node, false, None)?;
    Ok((matches, data.notes))
}

/// Returns true for spheres that are still to be tested.
fn is_kept(kept: Option<&[bool]>, index: usize) -> bool {
    kept.is_none_or(|kept| kept[index])
}

impl Data<'_> {
    /// Returns the spheres for which a node is true, or false if it is negated. What is unknown is neither. Of spheres
    /// that are not `kept`, any result will do.
    fn matches(&mut self, node: &Node, is_negated: bool, kept: Option<&[bool]>) -> Result<Vec<bool>, SelectError> {
        let set = match node {
            Node::Not(node) => return self.matches(node, !is_negated, kept),
            Node::All(parts) => return self.joined(parts, !is_negated, is_negated, kept),
            Node::Any(parts) => return self.joined(parts, is_negated, is_negated, kept),
            Node::Compare { sides, operators } => return self.compare(sides, operators, is_negated),
            Node::List { key, values, is_negated: is_other } => return self.list(key, values, is_negated != *is_other),
            Node::Near { kind, reach, of, at } => return self.near(*kind, *reach, of, *at, (is_negated, kept)),
            Node::Named(name) => return self.named(name, is_negated, kept),
            Node::Unknown(word) => return Err(self.unknown(word)),
            Node::Class(word) => self.class(word)?,
            Node::Nearest { count, of, at } => self.nearest(*count, of, *at)?,
            Node::Bonded { kind, steps, of, at } => self.bonded(*kind, *steps, of, *at)?,
            Node::Same { key, of } => self.same(key, of)?,
        };
        Ok(if is_negated { set.into_iter().map(|is| !is).collect() } else { set })
    }

    /// Evaluates the selection with a name.
    fn named(&mut self, name: &Word, is_negated: bool, kept: Option<&[bool]>) -> Result<Vec<bool>, SelectError> {
        if self.is_column(&name.text) {
            let problem = format!("`{0}` is a column of the file; choose another name, such as my_{0}", name.text);
            return Err(self.error(name.at, problem));
        }
        let names = self.names;
        let Some(named) = names.get(&name.text) else { return Err(self.unknown(name)) };
        let outer = std::mem::replace(&mut self.text, &named.text);
        let matches = self.matches(&named.parsed.node, is_negated, kept);
        self.text = outer;
        named.parsed.notes.iter().for_each(|note| self.note(note.clone()));
        matches
    }

    fn joined(
        &mut self,
        parts: &[Node],
        is_all: bool,
        is_negated: bool,
        kept: Option<&[bool]>,
    ) -> Result<Vec<bool>, SelectError> {
        let mut joined: Option<Vec<bool>> = None;
        for part in parts {
            let still = joined.as_deref().filter(|_| is_all).or(kept);
            let matches = self.matches(part, is_negated, still)?;
            match &mut joined {
                None => {
                    let within = |(index, is): (usize, bool)| is && is_kept(kept, index);
                    joined = Some(matches.into_iter().enumerate().map(within).collect());
                }
                Some(joined) => {
                    for (joined, is_match) in joined.iter_mut().zip(matches) {
                        *joined = if is_all { *joined && is_match } else { *joined || is_match };
                    }
                }
            }
        }
        Ok(joined.unwrap_or_default())
    }

    /// The spheres of a place, all of them, and the points from which distances are measured.
    fn place(&mut self, of: &Place) -> Result<(Vec<bool>, Vec<DVec3>), SelectError> {
        Ok(match of {
            Place::Point(point) => (vec![false; self.len()], vec![(*point).into()]),
            Place::Spheres(node) => {
                let set = self.matches(node, false, None)?;
                let points = self.points();
                let chosen = points.iter().zip(&set).filter(|(_, is)| **is).map(|(point, _)| *point).collect();
                (set, chosen)
            }
        })
    }

    /// The cell across whose borders distances reach.
    fn cell(&self) -> Option<PeriodicCell> {
        PeriodicCell::of(self.loaded).filter(|_| !self.loaded.is_part_of_crystal)
    }

    /// Sorts points, to find what is at most a distance away.
    fn grid(&self, points: &[DVec3], reach: f64, cell: Option<PeriodicCell>, at: usize) -> Result<Grid, SelectError> {
        // No nearest image is farther away than half of all edges together, if the cell repeats in all directions.
        let all_edges = |cell: &PeriodicCell| cell.edges.to_cols_array_2d().map(|edge| DVec3::from(edge).length());
        let farthest = cell.as_ref().filter(|_| self.loaded.is_periodic == [true; 3]).map(all_edges);
        let reach = farthest.map_or(reach, |edges| reach.min(0.5001 * edges.iter().sum::<f64>()));
        Grid::new(points.iter().copied(), reach, cell).ok_or_else(|| {
            self.error(at, "the periodic cell is so small that there are too many images within this distance")
        })
    }

    fn near(
        &mut self,
        kind: Near,
        reach: f64,
        of: &Place,
        at: usize,
        (is_negated, kept): (bool, Option<&[bool]>),
    ) -> Result<Vec<bool>, SelectError> {
        let (set, chosen) = self.place(of)?;
        let cell = match kind {
            Near::Periodic => match PeriodicCell::of(self.loaded) {
                Some(cell) => Some(cell),
                None => return Err(self.error(at, "pbwithin needs a periodic cell, and the file has none")),
            },
            _ => self.cell(),
        };
        let grid = self.grid(&chosen, reach, cell, at)?;
        let points = self.points();
        let is_match = |index: usize| {
            let point = points[index];
            let is_within = match set[index] {
                _ if !is_kept(kept, index) => return false,
                true if kind == Near::Expand => true,
                // Nothing is known about a sphere that is nowhere.
                _ if !is_somewhere(point) => return false,
                true => kind != Near::Around,
                false => grid.has_near(point),
            };
            (is_within == (kind != Near::Beyond)) != is_negated
        };
        Ok((0..self.len()).map(is_match).collect())
    }

    fn nearest(&mut self, count: usize, of: &Place, at: usize) -> Result<Vec<bool>, SelectError> {
        let (set, chosen) = self.place(of)?;
        let points = self.points();
        let others = (0..points.len()).filter(|index| !set[*index] && is_somewhere(points[*index]));
        let somewhere = points.iter().chain(&chosen).filter(|point| is_somewhere(**point));
        let ends = somewhere.fold([DVec3::MAX, DVec3::MIN], |[low, high], point| [low.min(*point), high.max(*point)]);
        let size = (ends[1] - ends[0]).max(DVec3::splat(1e-6));
        let wanted = count.min(others.clone().count());
        // In a cell, no point is farther from an image than all its edges together.
        let far =
            self.cell().map_or(size, |cell| DVec3::splat(cell.edges.to_cols_array().iter().map(|x| x.abs()).sum()));
        let mut reach = size.max_element() / 64.0;
        loop {
            let is_last = reach > 2.0 * far.length();
            let grid = self.grid(&chosen, reach, self.cell(), at)?;
            let mut found: Vec<(f64, usize)> =
                others.clone().filter_map(|index| Some((grid.nearest(points[index])?, index))).collect();
            if found.len() >= wanted || is_last || chosen.is_empty() {
                found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                let mut matches = vec![false; points.len()];
                found.iter().take(wanted).for_each(|(_, index)| matches[*index] = true);
                return Ok(matches);
            }
            reach *= 2.0;
        }
    }

    fn bonded(&mut self, kind: Bonded, steps: usize, of: &Node, at: usize) -> Result<Vec<bool>, SelectError> {
        let set = self.matches(of, false, None)?;
        let end = self.text[at..].find(char::is_whitespace).map_or(self.text.len(), |length| at + length);
        let word = Word { text: self.text[at..end].to_owned(), at };
        let graph = self.graph(&word)?;
        Ok(match kind {
            Bonded::To => graph.bonded_to(&set),
            Bonded::Neighbor => graph.bonded_to(&set).into_iter().zip(set).map(|(is, was)| is && !was).collect(),
            Bonded::Within => graph.within(&set, steps),
        })
    }

    fn same(&mut self, key: &Word, of: &Node) -> Result<Vec<bool>, SelectError> {
        let set = self.matches(of, false, None)?;
        if key.text == "residue" {
            let residues = self.residues(key.at)?;
            return Ok(groups(residues.len(), &set, |index| residues[index]));
        }
        Ok(match self.source(key)?.values {
            Values::Labels(labels) => groups(set.len(), &set, |index| labels.indices[index]),
            Values::Numbers(numbers) => groups(set.len(), &set, |index| (numbers[index] + 0.0).to_bits()),
        })
    }
}

/// All spheres that are in a group with one of the set.
fn groups<T: Eq + std::hash::Hash>(count: usize, set: &[bool], group: impl Fn(usize) -> T) -> Vec<bool> {
    let chosen: HashSet<T> = (0..count).filter(|index| set[*index]).map(&group).collect();
    (0..count).map(|index| chosen.contains(&group(index))).collect()
}
