//! Colour maps by their names, and palettes for categories that people with colour blindness can tell apart.

use std::str::FromStr;

use colorous::Gradient;

use pinhole::internals::text::one_line;

const ENTRIES: usize = 256;

/// The maps of Crameri's Scientific colour maps (Crameri, "Scientific colour maps", Zenodo,
/// doi:10.5281/zenodo.1243862; Crameri, Shephard and Heron, Nature Communications 11, 5444, 2020), under the MIT
/// licence in `maps/LICENSE-crameri`. `scripts/make-maps.py` made the tables: 256 colours of three bytes in 8-bit sRGB
/// for each name, in this order.
const CRAMERI: [&str; 39] = [
    "acton", "bam", "bamako", "batlow", "batlowK", "batlowW", "berlin", "bilbao", "broc", "buda", "bukavu", "cork",
    "davos", "devon", "fes", "glasgow", "grayC", "hawaii", "imola", "lajolla", "lapaz", "lipari", "lisbon", "managua",
    "navia", "nuuk", "oleron", "oslo", "roma", "tofino", "tokyo", "turku", "vanimo", "vik", "bamO", "brocO", "corkO",
    "romaO", "vikO",
];

static CRAMERI_COLORS: &[u8; 39 * ENTRIES * 3] = include_bytes!("maps/crameri.rgb");

/// The maps of `colorous`, which are those of D3, under the names of Matplotlib.
const COLOROUS: [(&str, Gradient); 36] = [
    ("viridis", colorous::VIRIDIS),
    ("inferno", colorous::INFERNO),
    ("magma", colorous::MAGMA),
    ("plasma", colorous::PLASMA),
    ("cividis", colorous::CIVIDIS),
    ("turbo", colorous::TURBO),
    ("RdBu", colorous::RED_BLUE),
    ("RdYlBu", colorous::RED_YELLOW_BLUE),
    ("RdYlGn", colorous::RED_YELLOW_GREEN),
    ("RdGy", colorous::RED_GREY),
    ("PuOr", colorous::PURPLE_ORANGE),
    ("PRGn", colorous::PURPLE_GREEN),
    ("PiYG", colorous::PINK_GREEN),
    ("BrBG", colorous::BROWN_GREEN),
    ("Spectral", colorous::SPECTRAL),
    ("Blues", colorous::BLUES),
    ("Greens", colorous::GREENS),
    ("Greys", colorous::GREYS),
    ("Oranges", colorous::ORANGES),
    ("Purples", colorous::PURPLES),
    ("Reds", colorous::REDS),
    ("BuGn", colorous::BLUE_GREEN),
    ("BuPu", colorous::BLUE_PURPLE),
    ("GnBu", colorous::GREEN_BLUE),
    ("OrRd", colorous::ORANGE_RED),
    ("PuBu", colorous::PURPLE_BLUE),
    ("PuBuGn", colorous::PURPLE_BLUE_GREEN),
    ("PuRd", colorous::PURPLE_RED),
    ("RdPu", colorous::RED_PURPLE),
    ("YlGn", colorous::YELLOW_GREEN),
    ("YlGnBu", colorous::YELLOW_GREEN_BLUE),
    ("YlOrBr", colorous::YELLOW_ORANGE_BROWN),
    ("YlOrRd", colorous::YELLOW_ORANGE_RED),
    ("cubehelix", colorous::CUBEHELIX),
    ("rainbow", colorous::RAINBOW),
    ("sinebow", colorous::SINEBOW),
];

/// The name of an existing colour map or palette.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapName {
    name: &'static str,
    is_reversed: bool,
}

/// The error of a name that no colour map has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no color map `{name}`;{} {}",
    .nearest.map_or(String::new(), |nearest| format!(" did you mean `{nearest}`?")), MapName::examples())]
#[non_exhaustive]
pub struct MapError {
    /// The name as given.
    pub name: String,
    /// The name of a map that is spelled similarly.
    pub nearest: Option<&'static str>,
}

impl<'de> serde::Deserialize<'de> for MapName {
    fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        String::deserialize(from)?.parse().map_err(serde::de::Error::custom)
    }
}

impl serde::Serialize for MapName {
    fn serialize<S: serde::Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(&format_args!("{}{}", self.name, if self.is_reversed { "_r" } else { "" }))
    }
}

impl FromStr for MapName {
    type Err = MapError;

    /// Finds a map or palette by its name, in upper or lower case. The ending `_r` reverses it.
    fn from_str(text: &str) -> Result<Self, MapError> {
        let text = text.trim();
        let exact = Self::all().find(|name| name.eq_ignore_ascii_case(text));
        if let Some(name) = exact {
            return Ok(Self { name, is_reversed: false });
        }
        let stem = text.strip_suffix("_r").unwrap_or(text);
        let stem = stem.replace('_', "-");
        if let Some(name) = Self::all().find(|name| name.eq_ignore_ascii_case(&stem)) {
            return Ok(Self { name, is_reversed: text.ends_with("_r") });
        }
        let likeness = |name: &str| strsim::jaro_winkler(&name.to_lowercase(), &stem.to_lowercase());
        let nearest = Self::all().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
        let nearest = nearest.filter(|name| likeness(name) > 0.75);
        Err(MapError { name: one_line(text), nearest })
    }
}

impl MapName {
    /// The names of all colour maps, and then of all palettes.
    pub fn all() -> impl Iterator<Item = &'static str> {
        let palettes = PALETTES.iter().map(|palette| palette.name);
        Self::continuous().chain(palettes)
    }

    /// The names of all colour maps for numbers.
    pub fn continuous() -> impl Iterator<Item = &'static str> {
        COLOROUS.iter().map(|(name, _)| *name).chain(["gray"]).chain(CRAMERI)
    }

    /// The names of all palettes for categories.
    pub fn palettes() -> impl Iterator<Item = &'static str> {
        PALETTES.iter().map(|palette| palette.name)
    }

    fn examples() -> String {
        let palettes = Self::palettes().collect::<Vec<_>>().join(", ");
        format!(
            "maps for numbers are viridis, inferno, magma, plasma, cividis, turbo, gray, RdBu and the others of \
             ColorBrewer, and batlow, vik, roma and the others of Crameri; palettes for categories are {palettes}; \
             the ending _r reverses a map"
        )
    }

    /// The name, without the ending that reverses it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Returns true if the map is reversed.
    #[must_use]
    pub fn is_reversed(&self) -> bool {
        self.is_reversed
    }

    /// Reverses the map if `reverse` is true.
    pub(crate) fn reversed_if(self, reverse: bool) -> Self {
        Self { is_reversed: self.is_reversed != reverse, ..self }
    }

    /// Whether this is a palette, whose colours are for categories and not for a scale.
    pub(crate) fn is_palette(&self) -> bool {
        self.palette().is_some()
    }

    fn palette(&self) -> Option<&'static Palette> {
        PALETTES.iter().find(|palette| palette.name == self.name)
    }

    /// The colours in 8-bit sRGB, from the low end to the high one: 256 of a colour map, or all of a palette.
    #[must_use]
    pub fn colors(&self) -> Vec<[u8; 3]> {
        let mut colors = self.forward();
        if self.is_reversed {
            colors.reverse();
        }
        colors
    }

    fn forward(&self) -> Vec<[u8; 3]> {
        if let Some(palette) = self.palette() {
            let rgb = |hex: &u32| {
                let [_, r, g, b] = hex.to_be_bytes();
                [r, g, b]
            };
            return palette.colors.iter().map(rgb).collect();
        }
        if let Some((_, gradient)) = COLOROUS.iter().find(|(name, _)| *name == self.name) {
            let color = |i| gradient.eval_rational(i, ENTRIES);
            return (0..ENTRIES).map(|i| color(i).into_array()).collect();
        }
        if let Some(index) = CRAMERI.iter().position(|name| *name == self.name) {
            let bytes = CRAMERI_COLORS.chunks_exact(ENTRIES * 3).nth(index).unwrap_or_default();
            return bytes.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]]).collect();
        }
        (0..=255).map(|level| [level; 3]).collect()
    }

    /// Viridis, the default map for numbers.
    pub(super) const VIRIDIS: Self = Self { name: "viridis", is_reversed: false };

    /// The default palette for categories.
    pub(super) const OKABE_ITO: Self = Self { name: "okabe-ito", is_reversed: false };
}

struct Palette {
    name: &'static str,
    /// Colours in 8-bit sRGB, as `0xrrggbb`.
    colors: &'static [u32],
}

/// The palette of Okabe and Ito, "Color Universal Design", 2008, with black last, because light hardly shows on it; and
/// palettes of Paul Tol, "Colour Schemes", SRON/EPS/TN/09-002, issue 3.2, 2021, without his grey for missing data.
const PALETTES: [Palette; 5] = [
    Palette {
        name: "okabe-ito",
        colors: &[0xe69f00, 0x56b4e9, 0x009e73, 0xcc79a7, 0x0072b2, 0xd55e00, 0xf0e442, 0x000000],
    },
    Palette { name: "tol-bright", colors: &[0x4477aa, 0xee6677, 0x228833, 0xccbb44, 0x66ccee, 0xaa3377] },
    Palette {
        name: "tol-muted",
        colors: &[0xcc6677, 0x332288, 0xddcc77, 0x117733, 0x88ccee, 0x882255, 0x44aa99, 0x999933, 0xaa4499],
    },
    Palette { name: "tol-vibrant", colors: &[0xee7733, 0x0077bb, 0x33bbee, 0xee3377, 0xcc3311, 0x009988] },
    Palette {
        name: "tol-light",
        colors: &[0x77aadd, 0xee8866, 0xeedd88, 0xffaabb, 0x99ddff, 0x44bb99, 0xbbcc33, 0xaaaa00],
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(name: &str) -> [[u8; 3]; 2] {
        let colors = name.parse::<MapName>().unwrap().colors();
        [colors[0], colors[colors.len() - 1]]
    }

    /// The ends are those of the tables of Matplotlib and Crameri. D3's splines round down.
    #[test]
    fn maps_have_the_ends_that_their_makers_publish() {
        for (name, low, high) in [
            ("viridis", [68, 1, 84], [253, 231, 37]),
            ("Plasma", [13, 8, 135], [240, 249, 33]),
            ("batlow", [1, 25, 89], [250, 204, 250]),
            ("vik", [0, 18, 97], [89, 0, 8]),
            ("roma", [126, 23, 0], [3, 49, 152]),
            ("GRAY", [0, 0, 0], [255, 255, 255]),
            ("RdBu", [103, 0, 31], [4, 47, 96]),
        ] {
            assert_eq!(ends(name), [low, high], "{name}");
            assert_eq!(ends(&format!("{name}_r")), [high, low], "{name}_r");
        }
    }

    #[test]
    fn every_name_has_colors_and_is_unique() {
        let mut seen = std::collections::HashSet::new();
        for name in MapName::all() {
            assert!(seen.insert(name.to_lowercase()), "{name} occurs twice");
            let map: MapName = name.parse().unwrap();
            assert_eq!(map.name(), name);
            let count = map.colors().len();
            assert!(count == 256 || map.is_palette() && (5..20).contains(&count), "{name}");
            assert_eq!(map.reversed_if(true).reversed_if(true), map);
        }
        assert_eq!(seen.len(), COLOROUS.len() + 1 + CRAMERI.len() + PALETTES.len());
    }

    #[test]
    fn an_unknown_name_is_an_error_with_a_suggestion() {
        let error = "virdis".parse::<MapName>().unwrap_err();
        assert_eq!(error.nearest, Some("viridis"));
        assert!(error.to_string().contains("did you mean `viridis`?"), "{error}");
        assert_eq!("??".parse::<MapName>().unwrap_err().nearest, None);
        assert_eq!("tol_bright_r".parse::<MapName>().unwrap().name(), "tol-bright");
    }
}
