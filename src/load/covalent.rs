//! Covalent radii of the chemical elements.

use super::elements::element;

/// Covalent radii in pm, by atomic number from 1. Carbon is that of single bonds (sp³), and manganese, iron and cobalt
/// are those of low spin.
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

/// What is known of the bonds of an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Covalent {
    /// The covalent radius in Å.
    pub(crate) radius: f64,
    pub(crate) is_hydrogen: bool,
}

/// Returns what is known of the bonds of a species, which is written as for its radius and colour; `None` if it is not an
/// element, or an element without a covalent radius.
pub(crate) fn covalent(species: &str) -> Option<Covalent> {
    let number = element(species)?.atomic_number() as usize;
    let radius = 0.01 * f64::from(*COVALENT.get(number.checked_sub(1)?)?);
    Some(Covalent { radius, is_hydrogen: number == 1 })
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "the answers are those of the table")]
mod tests {
    use super::*;

    #[test]
    fn known_elements() {
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
        assert!(covalent("D").unwrap().is_hydrogen);
        assert!(!covalent("He").unwrap().is_hydrogen);
        for species in ["Bk", "bead", "", "0", "119"] {
            assert_eq!(covalent(species), None, "{species}");
        }
    }
}
