//! Colour maps by their names, and palettes for categories that people with colour blindness can tell apart.

use std::str::FromStr;

use colorous::Gradient;

use pinhole::internals::text::one_line;
use pinhole_data::css;

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

/// Maps of Matplotlib 3.11, under its licence in `maps/LICENSE-matplotlib`, as `scripts/make-maps.py` made them;
/// `coolwarm` is by Moreland, "Diverging Color Maps for Scientific Visualization", 2009.
const MATPLOTLIB: [&str; 6] = ["jet", "coolwarm", "hot", "bwr", "seismic", "hsv"];

static MATPLOTLIB_COLORS: &[u8; 6 * ENTRIES * 3] = include_bytes!("maps/matplotlib.rgb");

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

/// The name of an existing colour map or palette, or colours that are blended into a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MapName {
    name: &'static str,
    is_reversed: bool,
    blend: Blend,
}

/// The most colours that are blended.
const MOST_BLENDED: usize = 16;

/// Colours in 8-bit sRGB between which a map has equal steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Blend {
    count: usize,
    colors: [[u8; 3]; MOST_BLENDED],
}

impl Blend {
    const NONE: Self = Self { count: 0, colors: [[0; 3]; MOST_BLENDED] };

    /// Reads CSS colours with commas or underscores between them.
    fn read(text: &str) -> Option<Self> {
        let parts = text.split(|c| ",_".contains(c)).map(|part| css::color(part.trim()).ok().map(|c| c.to_srgb8()));
        let parts: Vec<[u8; 3]> = parts.collect::<Option<_>>()?;
        let mut blend = Self { count: parts.len(), ..Self::NONE };
        blend.colors.get_mut(..parts.len()).filter(|_| parts.len() > 1)?.copy_from_slice(&parts);
        Some(blend)
    }

    fn given(&self) -> &[[u8; 3]] {
        &self.colors[..self.count]
    }

    fn entry(&self, index: usize) -> [u8; 3] {
        let place = index as f64 / (ENTRIES - 1) as f64 * (self.count - 1) as f64;
        let first = (place as usize).min(self.count - 2);
        let [low, high] = [self.colors[first], self.colors[first + 1]];
        let part = place - first as f64;
        std::array::from_fn(|i| (f64::from(low[i]) * (1.0 - part) + f64::from(high[i]) * part).round() as u8)
    }
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
        let hex = |[r, g, b]: &[u8; 3]| format!("#{r:02x}{g:02x}{b:02x}");
        let name = match self.blend.given() {
            [] => self.name.to_owned(),
            colors => colors.iter().map(hex).collect::<Vec<_>>().join(","),
        };
        to.collect_str(&format_args!("{name}{}", if self.is_reversed { "_r" } else { "" }))
    }
}

impl FromStr for MapName {
    type Err = MapError;

    /// Finds a map or palette by its name, in upper or lower case; or blends CSS colours, such as `blue,white,red`. The
    /// ending `_r` or `_rev` reverses it.
    fn from_str(text: &str) -> Result<Self, MapError> {
        let text = text.trim();
        let lower = text.to_ascii_lowercase();
        let reversed = lower.strip_suffix("_rev").or(lower.strip_suffix("_r"));
        let (is_reversed, stem) = (reversed.is_some(), reversed.unwrap_or(&lower));
        let names = [stem.to_owned(), stem.replace('_', "-")];
        let found = Self::all().find(|name| names.iter().any(|stem| name.eq_ignore_ascii_case(stem)));
        if let Some(name) = found {
            return Ok(Self { name, is_reversed, blend: Blend::NONE });
        }
        if let Some(blend) = Blend::read(stem) {
            return Ok(Self { name: "blend", is_reversed, blend });
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
        COLOROUS.iter().map(|(name, _)| *name).chain(["gray"]).chain(MATPLOTLIB).chain(CRAMERI)
    }

    /// The names of all palettes for categories.
    pub fn palettes() -> impl Iterator<Item = &'static str> {
        PALETTES.iter().map(|palette| palette.name)
    }

    fn examples() -> String {
        let palettes = Self::palettes().collect::<Vec<_>>().join(", ");
        format!(
            "maps for numbers are viridis, inferno, magma, plasma, cividis, turbo, gray, jet, coolwarm, hot, \
             bwr, seismic, hsv, RdBu and the others of ColorBrewer, batlow, vik, roma and the others of Crameri, and colors \
             such as blue,white,red; palettes for categories are {palettes}; the ending _r reverses a map"
        )
    }

    /// The name, without the ending that reverses it; `blend` for colours that are blended.
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
        for (names, table) in [(&CRAMERI[..], &CRAMERI_COLORS[..]), (&MATPLOTLIB, MATPLOTLIB_COLORS)] {
            if let Some(index) = names.iter().position(|name| *name == self.name) {
                let bytes = table.chunks_exact(ENTRIES * 3).nth(index).unwrap_or_default();
                return bytes.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]]).collect();
            }
        }
        if self.blend.count > 1 {
            return (0..ENTRIES).map(|index| self.blend.entry(index)).collect();
        }
        (0..=255).map(|level| [level; 3]).collect()
    }

    /// Viridis, the default map for numbers.
    pub(super) const VIRIDIS: Self = Self { name: "viridis", is_reversed: false, blend: Blend::NONE };

    /// The default palette for categories.
    pub(super) const OKABE_ITO: Self = Self { name: "okabe-ito", is_reversed: false, blend: Blend::NONE };
}

struct Palette {
    name: &'static str,
    /// Colours in 8-bit sRGB, as `0xrrggbb`.
    colors: &'static [u32],
}

/// The palette of Okabe and Ito, "Color Universal Design", 2008, with black last, because light hardly shows on it; and
/// palettes of Paul Tol, "Colour Schemes", SRON/EPS/TN/09-002, issue 3.2, 2021, without his grey for missing data; those of
/// Tableau that Matplotlib calls tab10 and tab20; and those of `ColorBrewer` (Brewer, Harrower and The Pennsylvania State
/// University, 2002, Apache License 2.0).
const PALETTES: [Palette; 12] = [
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
    Palette {
        name: "tab10",
        colors: &[0x1f77b4, 0xff7f0e, 0x2ca02c, 0xd62728, 0x9467bd, 0x8c564b, 0xe377c2, 0x7f7f7f, 0xbcbd22, 0x17becf],
    },
    Palette {
        name: "tab20",
        colors: &[
            0x1f77b4, 0xaec7e8, 0xff7f0e, 0xffbb78, 0x2ca02c, 0x98df8a, 0xd62728, 0xff9896, 0x9467bd, 0xc5b0d5,
            0x8c564b, 0xc49c94, 0xe377c2, 0xf7b6d2, 0x7f7f7f, 0xc7c7c7, 0xbcbd22, 0xdbdb8d, 0x17becf, 0x9edae5,
        ],
    },
    Palette {
        name: "Set1",
        colors: &[0xe41a1c, 0x377eb8, 0x4daf4a, 0x984ea3, 0xff7f00, 0xffff33, 0xa65628, 0xf781bf, 0x999999],
    },
    Palette { name: "Set2", colors: &[0x66c2a5, 0xfc8d62, 0x8da0cb, 0xe78ac3, 0xa6d854, 0xffd92f, 0xe5c494, 0xb3b3b3] },
    Palette {
        name: "Set3",
        colors: &[
            0x8dd3c7, 0xffffb3, 0xbebada, 0xfb8072, 0x80b1d3, 0xfdb462, 0xb3de69, 0xfccde5, 0xd9d9d9, 0xbc80bd,
            0xccebc5, 0xffed6f,
        ],
    },
    Palette {
        name: "Paired",
        colors: &[
            0xa6cee3, 0x1f78b4, 0xb2df8a, 0x33a02c, 0xfb9a99, 0xe31a1c, 0xfdbf6f, 0xff7f00, 0xcab2d6, 0x6a3d9a,
            0xffff99, 0xb15928,
        ],
    },
    Palette {
        name: "Dark2",
        colors: &[0x1b9e77, 0xd95f02, 0x7570b3, 0xe7298a, 0x66a61e, 0xe6ab02, 0xa6761d, 0x666666],
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
            ("jet", [0, 0, 128], [128, 0, 0]),
            ("CoolWarm", [59, 76, 192], [180, 4, 38]),
            ("hot", [11, 0, 0], [255, 255, 255]),
            ("bwr", [0, 0, 255], [255, 0, 0]),
            ("seismic", [0, 0, 77], [128, 0, 0]),
            ("hsv", [255, 0, 0], [255, 0, 24]),
            ("tab20", [31, 119, 180], [158, 218, 229]),
            ("paired", [166, 206, 227], [177, 89, 40]),
        ] {
            assert_eq!(ends(name), [low, high], "{name}");
            for ending in ["_r", "_rev", "_R"] {
                assert_eq!(ends(&format!("{name}{ending}")), [high, low], "{name}{ending}");
            }
        }
    }

    #[test]
    fn colors_are_blended() {
        for text in ["blue,white,red", "blue_white_red", "#00f, #fff, #f00", "red,white,blue_r"] {
            let map: MapName = text.parse().unwrap();
            let colors = map.colors();
            assert_eq!([colors[0], colors[64], colors[255]], [[0, 0, 255], [128, 128, 255], [255, 0, 0]], "{text}");
            assert_eq!(colors.len(), ENTRIES);
            assert_eq!(toml::Value::try_from(map).unwrap().try_into::<MapName>().unwrap(), map);
        }
        assert!("red".parse::<MapName>().is_err() && "red,qqq".parse::<MapName>().is_err());
        assert!(vec!["red"; MOST_BLENDED + 1].join(",").parse::<MapName>().is_err());
    }

    #[test]
    fn every_name_has_colors_and_is_unique() {
        let mut seen = std::collections::HashSet::new();
        for name in MapName::all() {
            assert!(seen.insert(name.to_lowercase()), "{name} occurs twice");
            let map: MapName = name.parse().unwrap();
            assert_eq!(map.name(), name);
            let count = map.colors().len();
            assert!(count == 256 || map.is_palette() && (5..=20).contains(&count), "{name}");
            assert_eq!(map.reversed_if(true).reversed_if(true), map);
        }
        assert_eq!(seen.len(), COLOROUS.len() + 1 + MATPLOTLIB.len() + CRAMERI.len() + PALETTES.len());
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
