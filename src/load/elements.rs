//! Radii and colours of the chemical elements.

use mendeleev::Element;

use crate::image::color::LinearRgb;

/// Van der Waals radii in Å, by atomic number from 1; 0 where there is no value.
///
/// S. Alvarez, "A cartography of the van der Waals territories", Dalton Transactions 42 (2013)
/// 8617-8636, table 1.
#[rustfmt::skip]
const VAN_DER_WAALS: [f64; 99] = [
    1.20, 1.43, 2.12, 1.98, 1.91, 1.77, 1.66, 1.50, 1.46, 1.58, 2.50, 2.51, 2.25, 2.19, 1.90, 1.89,
    1.82, 1.83, 2.73, 2.62, 2.58, 2.46, 2.42, 2.45, 2.45, 2.44, 2.40, 2.40, 2.38, 2.39, 2.32, 2.29,
    1.88, 1.82, 1.86, 2.25, 3.21, 2.84, 2.75, 2.52, 2.56, 2.45, 2.44, 2.46, 2.44, 2.15, 2.53, 2.49,
    2.43, 2.42, 2.47, 1.99, 2.04, 2.06, 3.48, 3.03, 2.98, 2.88, 2.92, 2.95, 0.00, 2.90, 2.87, 2.83,
    2.79, 2.87, 2.81, 2.83, 2.79, 2.80, 2.74, 2.63, 2.53, 2.57, 2.49, 2.48, 2.41, 2.29, 2.32, 2.45,
    2.47, 2.60, 2.54, 0.00, 0.00, 0.00, 0.00, 0.00, 2.80, 2.93, 2.88, 2.71, 2.82, 2.81, 2.83, 3.05,
    3.40, 3.05, 2.70,
];

/// Radius in Å of a species that has no tabulated radius.
const FALLBACK_RADIUS: f64 = 2.0;

/// Colour of a species that is not an element or has no tabulated colour: Jmol's deep pink.
const FALLBACK_COLOR: [u8; 3] = [255, 20, 147];

/// Radius and colour of the atoms of one species.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Appearance {
    /// Van der Waals radius in Å (Alvarez 2013).
    pub(super) radius: f64,
    /// Jmol's element colour, which extends the convention of Corey, Pauling and Koltun.
    pub(super) color: LinearRgb,
    /// Whether the species is a chemical element.
    pub(super) is_element: bool,
}

/// Returns the appearance of a species, which may be an element's symbol in upper or lower case, also followed by
/// digits or a charge (`O1`, `Fe3+`), or an atomic number.
///
/// A species that is not an element gets the radius 2 Å and the colour deep pink.
pub(super) fn appearance(species: &str) -> Appearance {
    let element = element(species);
    let color = element.and_then(|e| e.jmol_color()).map_or(FALLBACK_COLOR, |c| [c.r, c.g, c.b]);
    let radius = element
        .and_then(|e| VAN_DER_WAALS.get(e.atomic_number() as usize - 1).copied())
        .filter(|radius| *radius > 0.0)
        .unwrap_or(FALLBACK_RADIUS);
    Appearance { radius, color: LinearRgb::from_srgb8(color), is_element: element.is_some() }
}

/// Returns the element that a species is, written in any of these ways.
pub(super) fn element(species: &str) -> Option<Element> {
    match species.parse::<usize>() {
        Ok(number) => Element::list().get(number.wrapping_sub(1)).copied(),
        Err(_) => by_symbol(species.trim_end_matches(|c: char| !c.is_ascii_alphabetic())),
    }
}

fn by_symbol(symbol: &str) -> Option<Element> {
    // Deuterium and tritium have their own symbols but are isotopes of hydrogen.
    let symbol = if matches!(symbol, "D" | "T") { "H" } else { symbol };
    Element::list().iter().copied().find(|e| e.symbol().eq_ignore_ascii_case(symbol))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_elements() {
        for (species, radius, color) in [
            ("H", 1.20, [255, 255, 255]),
            ("O", 1.50, [255, 13, 13]),
            ("C", 1.77, [144, 144, 144]),
            ("Fe", 2.44, [224, 102, 51]),
            ("Es", 2.70, [179, 31, 212]),
        ] {
            let found = appearance(species);
            assert!((found.radius - radius).abs() < 1e-12, "{species}");
            assert_eq!(found.color.to_srgb8(), color, "{species}");
            assert!(found.is_element, "{species}");
        }
    }

    #[test]
    fn ways_to_write_a_species() {
        for (species, element) in [
            ("fe", "Fe"),
            ("CL", "Cl"),
            ("O1", "O"),
            ("Na+", "Na"),
            ("Fe3+", "Fe"),
            ("8", "O"),
            ("D", "H"),
        ] {
            assert_eq!(appearance(species), appearance(element), "{species}");
        }
    }

    #[test]
    fn species_that_are_not_elements_are_pink() {
        for species in ["Xx", "0", "119", "", "bead"] {
            let found = appearance(species);
            assert_eq!(found.color.to_srgb8(), FALLBACK_COLOR, "{species}");
            assert!(!found.is_element, "{species}");
        }
    }

    #[test]
    fn the_table_has_plausible_radii_and_the_known_gaps() {
        let gaps: Vec<_> =
            (1..).zip(VAN_DER_WAALS).filter(|(_, r)| *r == 0.0).map(|(z, _)| z).collect();
        assert_eq!(gaps, [61, 84, 85, 86, 87, 88]);
        assert!(VAN_DER_WAALS.iter().all(|r| *r == 0.0 || (1.2..=3.5).contains(r)));
    }
}
