//! Representations: which spheres of the data are drawn, and as what.
//!
//! A [`ShowRule`] gives spheres a style, such as sticks. Later rules take precedence over earlier ones. A sphere is drawn in
//! the style of the last rule for it; beside that it may be a part of a tube, from a rule with the style
//! [`ShowStyle::Trace`]. The bonds between balls and sticks are those of [`Additions`](crate::added::Additions).

mod rule;
mod sizes;
mod trace;

pub use rule::{ShowRule, ShowStyle, ShownPart};

use crate::added::{DrawnSpheres, StickSize, element_test};
use crate::kind::is_curve;
use crate::load::Dataset;
use crate::select::{KeptSpheres, SelectError};
use sizes::Measures;

/// How a sphere is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Drawn {
    /// As without rules.
    Plain,
    Not,
    /// As this rule says.
    By(u32),
}

/// How each sphere of some data is drawn.
#[derive(Clone, Debug)]
pub struct Shown<'a> {
    rules: &'a [ShowRule],
    drawn: Vec<Drawn>,
    /// The rule for the tube of which a sphere is a part.
    traces: Vec<Option<u32>>,
    ghosts: Vec<bool>,
    /// Notes for the user, one line each.
    pub notes: Vec<String>,
}

impl<'a> Shown<'a> {
    /// Applies rules to data.
    ///
    /// # Errors
    /// Returns an error if a selection does not apply to the data.
    pub fn new(rules: &'a [ShowRule], data: &Dataset) -> Result<Self, SelectError> {
        let count = data.spheres.len();
        let mut notes = Vec::new();
        let mut parts: Vec<Option<Vec<bool>>> = Vec::with_capacity(rules.len());
        for rule in rules {
            parts.push(match &rule.part {
                ShownPart::All => Some(vec![true; count]),
                ShownPart::Rest => None,
                ShownPart::Selected(selection) => match selection.chosen(data) {
                    Ok((matches, found)) => {
                        found.into_iter().for_each(|note| notes.extend((!notes.contains(&note)).then_some(note)));
                        Some(matches)
                    }
                    // Another frame may have such spheres.
                    Err(nothing @ SelectError::Nothing { .. }) => {
                        notes.push(format!("`show`: {nothing}"));
                        Some(vec![false; count])
                    }
                    Err(error) => return Err(error),
                },
            });
        }
        let rest: Vec<bool> = (0..count).map(|index| parts.iter().flatten().all(|part| !part[index])).collect();
        let draws = |rule: &ShowRule| !matches!(rule.style, ShowStyle::Ghost | ShowStyle::Hidden);
        let is_partial = rules.iter().any(draws);
        let before = if is_partial { Drawn::Not } else { Drawn::Plain };
        let mut shown =
            Self { rules, drawn: vec![before; count], traces: vec![None; count], ghosts: vec![false; count], notes };
        let has_bonds = !data.bonds.is_empty() || data.labels("species").is_some();
        let has_lines = rules.iter().any(|rule| rule.style == ShowStyle::Lines);
        let is_along = has_lines && !has_bonds && is_curve(data);
        for ((rule, part), number) in rules.iter().zip(&parts).zip(0..) {
            let part = part.as_ref().unwrap_or(&rest);
            // Lines join the points of a curve in their order.
            let style = if is_along && rule.style == ShowStyle::Lines { ShowStyle::Trace } else { rule.style };
            for index in (0..count).filter(|index| part[*index]) {
                shown.apply(style, number, index);
            }
        }
        let left_out = rest.iter().filter(|is_left| **is_left).count();
        if is_partial && left_out > 0 && !parts.contains(&None) {
            shown.notes.push(format!(
                "{left_out} of {count} spheres are in no rule of `show` and not drawn; --show 'rest = ghost' draws them \
                 faintly"
            ));
        }
        if count > 0 && !(0..count).any(|index| shown.is_seen(index)) {
            shown.notes.push("`show` hides all spheres".to_owned());
        }
        Ok(shown)
    }

    fn apply(&mut self, style: ShowStyle, rule: u32, index: usize) {
        match style {
            ShowStyle::Ghost => {
                self.ghosts[index] = true;
                // A ghost looks as the sphere did, or as it would without rules.
                if self.drawn[index] == Drawn::Not && self.traces[index].is_none() {
                    self.drawn[index] = Drawn::Plain;
                }
                return;
            }
            ShowStyle::Hidden => (self.drawn[index], self.traces[index]) = (Drawn::Not, None),
            ShowStyle::Trace => (self.drawn[index], self.traces[index]) = (Drawn::Not, Some(rule)),
            _ => self.drawn[index] = Drawn::By(rule),
        }
        self.ghosts[index] = false;
    }

    /// Returns true if a sphere itself is drawn.
    #[must_use]
    pub fn is_drawn(&self, index: usize) -> bool {
        self.drawn[index] != Drawn::Not
    }

    /// The number of spheres that are drawn, or part of a tube, after a selection kept some.
    #[must_use]
    pub fn kept(&self, selected: Option<KeptSpheres>) -> KeptSpheres {
        let count = self.drawn.len();
        let kept = (0..count).filter(|index| self.is_seen(*index)).count();
        let selected = selected.unwrap_or(KeptSpheres { kept: count, of: count, notes: Vec::new() });
        KeptSpheres { kept, ..selected }
    }

    /// Returns true if a sphere is drawn as it is without rules.
    #[must_use]
    pub fn is_plain(&self, index: usize) -> bool {
        self.drawn[index] == Drawn::Plain
    }

    /// Returns true if a sphere, or a tube there, is drawn.
    #[must_use]
    pub fn is_seen(&self, index: usize) -> bool {
        self.is_drawn(index) || self.traces[index].is_some()
    }

    /// Leaves out ghosts, or all but the ghosts.
    #[must_use]
    pub fn only(mut self, ghosts: bool) -> Self {
        for index in (0..self.drawn.len()).filter(|index| self.ghosts[*index] != ghosts) {
            (self.drawn[index], self.traces[index]) = (Drawn::Not, None);
        }
        self
    }

    /// The number of the rule for a sphere; `None` if it is drawn as without rules, or not at all.
    #[must_use]
    pub fn rule(&self, index: usize) -> Option<usize> {
        match self.drawn[index] {
            Drawn::By(rule) => Some(rule as usize),
            Drawn::Plain | Drawn::Not => None,
        }
    }

    /// The rules with the style [`ShowStyle::Trace`], and the spheres of each.
    pub(crate) fn traces(&self) -> impl Iterator<Item = (usize, &ShowRule, Vec<usize>)> {
        let spheres =
            move |number: u32| (0..self.traces.len()).filter(move |index| self.traces[*index] == Some(number));
        let may_be_tube = |rule: &ShowRule| matches!(rule.style, ShowStyle::Trace | ShowStyle::Lines);
        let traces = self.rules.iter().enumerate().filter(move |(_, rule)| may_be_tube(rule));
        traces.map(move |(number, rule)| (number, rule, spheres(number as u32).collect()))
    }

    /// Gives spheres the radii of their rules.
    pub fn set_radii(&self, data: &mut Dataset) {
        let measures = Measures::of(data);
        let Dataset { spheres, columns, .. } = data;
        let is_element = element_test(columns);
        spheres.map_radii(|index, radius| match self.drawn[index] {
            Drawn::By(rule) => measures.radius(&self.rules[rule as usize], radius, is_element(index)),
            Drawn::Plain | Drawn::Not => radius,
        });
    }

    /// The spheres and sticks that are drawn, for [`Additions::add`](crate::added::Additions::add). `are_plain` says whether
    /// spheres without a rule have sticks.
    #[must_use]
    pub fn drawn_spheres(&self, data: &Dataset, are_plain: bool) -> DrawnSpheres {
        let measures = Measures::of(data);
        let is_element = element_test(&data.columns);
        let stick = |index: usize| match self.drawn[index] {
            Drawn::Plain if are_plain => StickSize::OfBalls,
            Drawn::By(rule) => measures.stick(&self.rules[rule as usize], is_element(index)),
            Drawn::Plain | Drawn::Not => StickSize::None,
        };
        DrawnSpheres {
            sticks: (0..self.drawn.len()).map(stick).collect(),
            are_drawn: (0..self.drawn.len()).map(|index| self.is_drawn(index)).collect(),
            need_bonds: self.rules.iter().enumerate().any(|(number, rule)| {
                // Lines along a curve need none.
                rule.style.has_sticks() && self.drawn.contains(&Drawn::By(number as u32))
            }),
        }
    }
}
