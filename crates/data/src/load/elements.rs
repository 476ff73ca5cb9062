//! Radii and colours of the chemical elements, their covalent radii, and the note about species that are not elements.

use mendeleev::Element;

use super::error::first_names;
use pinhole::image::color::LinearRgb;
use pinhole::internals::text::shortened;

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

/// Colour of carbon, of which molecules are mostly made: lighter than Jmol's, and a little bluish beside white hydrogen.
const CARBON: [u8; 3] = [186, 188, 192];

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Appearance {
    /// Van der Waals radius in Å (Alvarez 2013).
    pub(super) radius: f64,
    /// Jmol's element colour, which extends the convention of Corey, Pauling and Koltun, softened.
    pub(super) color: LinearRgb,
    pub(super) is_element: bool,
}

/// Returns the appearance of a species. It is an atomic number or an element's symbol in upper or lower case,
/// perhaps followed by digits or a charge (`O1`, `Fe3+`).
///
/// A species that is not an element gets the radius 2 Å and the colour deep pink.
pub(super) fn appearance(species: &str) -> Appearance {
    let element = element(species);
    let color = match element {
        Some(Element::C) => CARBON,
        _ => element.and_then(|e| e.jmol_color()).map_or(FALLBACK_COLOR, |c| softened([c.r, c.g, c.b])),
    };
    let radius = element
        .and_then(|e| VAN_DER_WAALS.get(e.atomic_number() as usize - 1).copied())
        .filter(|radius| *radius > 0.0)
        .unwrap_or(FALLBACK_RADIUS);
    Appearance { radius, color: LinearRgb::from_srgb8(color), is_element: element.is_some() }
}

/// Mixes a quarter of a light grey into a colour: pure red and blue leave no room for shading, and swallow ink.
fn softened(color: [u8; 3]) -> [u8; 3] {
    color.map(|c| ((3 * u32::from(c) + 200) / 4) as u8)
}

/// Returns the element of a species, which is written in any of these ways.
pub(super) fn element(species: &str) -> Option<Element> {
    match species.parse::<usize>() {
        Ok(number) => Element::list().get(number.wrapping_sub(1)).copied(),
        Err(_) => by_symbol(species.trim_end_matches(|c: char| !c.is_ascii_alphabetic())),
    }
}

/// Returns the symbol of the element of a species, which is H for the isotopes of hydrogen.
pub(crate) fn element_symbol(species: &str) -> Option<&'static str> {
    element(species).map(|element| element.symbol())
}

fn by_symbol(symbol: &str) -> Option<Element> {
    // Deuterium and tritium have their own symbols but are isotopes of hydrogen.
    let symbol = if matches!(symbol, "D" | "T") { "H" } else { symbol };
    Element::list().iter().copied().find(|e| e.symbol().eq_ignore_ascii_case(symbol))
}

/// Covalent radii in pm, by atomic number from 1. The value for carbon is that of single bonds (sp³), and the values
/// for manganese, iron and cobalt are those of low spin.
///
/// B. Cordero et al., "Covalent radii revisited", Dalton Transactions (2008) 2832-2838, table 2.
#[rustfmt::skip]
const COVALENT: [u16; 96] = [
    31, 28, 128, 96, 84, 76, 71, 66, 57, 58, 166, 141, 121, 111, 107, 105,
    102, 106, 203, 176, 170, 160, 153, 139, 139, 132, 126, 124, 132, 122, 122, 120,
    119, 120, 120, 116, 220, 195, 190, 175, 164, 154, 147, 146, 142, 139, 145, 144,
    142, 139, 139, 138, 139, 140, 244, 215, 207, 204, 203, 201, 199, 198, 198, 196,
    194, 192, 192, 189, 190, 187, 187, 175, 170, 162, 151, 144, 141, 136, 136, 132,
    145, 146, 148, 140, 150, 150, 260, 221, 215, 206, 200, 196, 190, 187, 180, 169,
];

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Covalent {
    /// The covalent radius in Å.
    pub(crate) radius: f64,
    pub(crate) family: Family,
}

/// The families of elements that form bonds in different ways.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Family {
    Hydrogen,
    Oxygen,
    Halogen,
    Metal,
    Other,
}

/// Returns true for the symbols of metals.
pub(crate) fn is_metal(symbol: &str) -> bool {
    const OTHERS: [&str; 26] = [
        "H", "D", "T", "HE", "B", "C", "N", "O", "F", "NE", "SI", "P", "S", "CL", "AR", "GE", "AS", "SE", "BR", "KR",
        "SB", "TE", "I", "XE", "AT", "RN",
    ];
    !OTHERS.contains(&symbol.to_ascii_uppercase().as_str())
}

/// Returns the covalent radius of a species, and its family; `None` if the species is not an element, or an
/// element without a covalent radius. The species is written as for its radius and colour.
pub(crate) fn covalent(species: &str) -> Option<Covalent> {
    let element = element(species)?;
    let radius = 0.01 * f64::from(*COVALENT.get((element.atomic_number() as usize).checked_sub(1)?)?);
    let family = match element {
        Element::H => Family::Hydrogen,
        Element::O => Family::Oxygen,
        Element::F | Element::Cl | Element::Br | Element::I | Element::At => Family::Halogen,
        element if is_metal(element.symbol()) => Family::Metal,
        _ => Family::Other,
    };
    Some(Covalent { radius, family })
}

/// Species that are not chemical elements and lack a colour or a radius for that reason.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct UnknownSpecies {
    names: Vec<String>,
    lacks_color: bool,
    lacks_radius: bool,
}

impl UnknownSpecies {
    /// Species without a colour or a radius from the file or an option; `None` if there are none.
    pub(super) fn new(names: Vec<String>, lacks_color: bool, lacks_radius: bool) -> Option<Self> {
        let lacks = lacks_color || lacks_radius;
        (lacks && !names.is_empty()).then_some(Self { names, lacks_color, lacks_radius })
    }

    /// The species that still lack something after all colours, all radii, or those of some names were given.
    pub(super) fn after(&self, has_colors: bool, has_radii: bool, is_given: impl Fn(&str) -> bool) -> Option<Self> {
        let names = self.names.iter().filter(|name| !is_given(name)).cloned().collect();
        Self::new(names, self.lacks_color && !has_colors, self.lacks_radius && !has_radii)
    }

    /// Returns true for a colour, and for a radius, that they lack.
    pub(super) fn lack(&self) -> [bool; 2] {
        [self.lacks_color, self.lacks_radius]
    }

    /// The note about these species, on one line however many there are.
    pub(super) fn note(&self) -> String {
        let named = first_names(self.names.iter().map(|name| shortened(name)));
        let look = match (self.lacks_color, self.lacks_radius) {
            (true, false) => "in pink",
            (false, true) => "with radius 2",
            _ => "in pink with radius 2",
        };
        format!(
            "these species are not chemical elements: {named}; they are drawn {look} unless a scene file has a \
             table `[elements.NAME]` for them"
        )
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "the answers are those of the table")]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_plausible_radii_and_the_known_gaps() {
        let gaps: Vec<_> = (1..).zip(VAN_DER_WAALS).filter(|(_, r)| *r == 0.0).map(|(z, _)| z).collect();
        assert_eq!(gaps, [61, 84, 85, 86, 87, 88]);
        assert!(VAN_DER_WAALS.iter().all(|r| *r == 0.0 || (1.2..=3.5).contains(r)));
    }

    #[test]
    fn covalent_radii() {
        for (species, radius) in [
            ("H", 0.31),
            ("C", 0.76),
            ("o", 0.66),
            ("Fe2+", 1.32),
            ("I", 1.39),
            ("Cs", 2.44),
            ("Lu", 1.87),
            ("Au", 1.36),
            ("U", 1.96),
            ("Cm", 1.69),
            ("8", 0.66),
        ] {
            assert!((covalent(species).unwrap().radius - radius).abs() < 1e-12, "{species}");
        }
        let families = ["D", "He", "o", "Cl-", "Fe2+"].map(|species| covalent(species).unwrap().family);
        assert_eq!(families, [Family::Hydrogen, Family::Other, Family::Oxygen, Family::Halogen, Family::Metal]);
        for species in ["Bk", "bead", "", "0", "119"] {
            assert_eq!(covalent(species), None, "{species}");
        }
    }
}
