//! The species of atoms that are not chemical elements, and the note about them.

use crate::text::shortened;

/// Species that are not chemical elements, and what these lack therefore.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct UnknownSpecies {
    names: Vec<String>,
    lacks_color: bool,
    lacks_radius: bool,
}

impl UnknownSpecies {
    /// Species of which neither the file nor an option gives the colour or the radius; `None` if there are no such.
    pub(super) fn new(names: Vec<String>, lacks_color: bool, lacks_radius: bool) -> Option<Self> {
        let lacks = lacks_color || lacks_radius;
        (lacks && !names.is_empty()).then_some(Self { names, lacks_color, lacks_radius })
    }

    /// The species that still lack something if all colours or all radii are given, and those of some names.
    pub(super) fn after(
        &self,
        has_colors: bool,
        has_radii: bool,
        is_given: impl Fn(&str) -> bool,
    ) -> Option<Self> {
        let names = self.names.iter().filter(|name| !is_given(name)).cloned().collect();
        Self::new(names, self.lacks_color && !has_colors, self.lacks_radius && !has_radii)
    }

    /// The note about them, on one line however many there are.
    pub(super) fn note(&self) -> String {
        // More names would make the line too long to read.
        const NAMED: usize = 5;
        let more = match self.names.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let named = self.names.iter().take(NAMED).map(|name| shortened(name));
        let named = named.collect::<Vec<_>>().join(", ");
        let look = match (self.lacks_color, self.lacks_radius) {
            (true, false) => "in pink",
            (false, true) => "with radius 2",
            _ => "in pink with radius 2",
        };
        format!(
            "these species are not chemical elements: {named}{more}; they are drawn {look} unless a scene file has a \
             table `[elements.NAME]` for them"
        )
    }
}
