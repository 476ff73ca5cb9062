//! Palettes for categories, whose colours colour-blind people can tell apart.

/// A palette with a name.
pub(super) struct Palette {
    pub(super) name: &'static str,
    pub(super) colors: &'static [[u8; 3]],
}

const fn rgb(hex: u32) -> [u8; 3] {
    let [_, r, g, b] = hex.to_be_bytes();
    [r, g, b]
}

/// The palette of Okabe and Ito, "Color Universal Design", 2008, with black last, which light hardly shows; and palettes
/// of Paul Tol, "Colour Schemes", SRON/EPS/TN/09-002, issue 3.2, 2021, without the grey that he keeps for missing data.
pub(super) const PALETTES: [Palette; 5] = [
    Palette {
        name: "okabe-ito",
        colors: &[
            rgb(0xe69f00),
            rgb(0x56b4e9),
            rgb(0x009e73),
            rgb(0xcc79a7),
            rgb(0x0072b2),
            rgb(0xd55e00),
            rgb(0xf0e442),
            rgb(0x000000),
        ],
    },
    Palette {
        name: "tol-bright",
        colors: &[
            rgb(0x4477aa),
            rgb(0xee6677),
            rgb(0x228833),
            rgb(0xccbb44),
            rgb(0x66ccee),
            rgb(0xaa3377),
        ],
    },
    Palette {
        name: "tol-muted",
        colors: &[
            rgb(0xcc6677),
            rgb(0x332288),
            rgb(0xddcc77),
            rgb(0x117733),
            rgb(0x88ccee),
            rgb(0x882255),
            rgb(0x44aa99),
            rgb(0x999933),
            rgb(0xaa4499),
        ],
    },
    Palette {
        name: "tol-vibrant",
        colors: &[
            rgb(0xee7733),
            rgb(0x0077bb),
            rgb(0x33bbee),
            rgb(0xee3377),
            rgb(0xcc3311),
            rgb(0x009988),
        ],
    },
    Palette {
        name: "tol-light",
        colors: &[
            rgb(0x77aadd),
            rgb(0xee8866),
            rgb(0xeedd88),
            rgb(0xffaabb),
            rgb(0x99ddff),
            rgb(0x44bb99),
            rgb(0xbbcc33),
            rgb(0xaaaa00),
        ],
    },
];
