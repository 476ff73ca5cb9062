//! The flags that say what is done with data: which spheres are drawn, what is added to them, and what gives them colors,
//! radii and opacities.

use clap::Args;

use crate::flags::annotation::AnnotationArgs;
use crate::terminal::failure::Failure;
use pinhole::LinearRgb;
use pinhole_data::added::{Additions, BondLength, Bonds, CellEdges};
use pinhole_data::css;
use pinhole_data::select::Selection;
use pinhole_figure::color_by::{
    ColorBy, EmissionBy, JoinedKeys, Limits, MapName, Mapping, RadiusBy,
};
use pinhole_figure::scene_file::IntegratorKind;

pub(crate) const HEADING: &str = "Colors, radii and opacities from data";

#[derive(Debug, Args)]
pub(crate) struct ColorArgs {
    /// Color the spheres by a column of the data: its name, or index, radius, x, y or z, or "|v|" for the length of a
    /// vector with the columns v.x, v.y and v.z
    #[arg(long, help_heading = HEADING, value_name = "COLUMN")]
    color_by: Option<String>,
    /// Color map or palette, such as viridis, turbo, batlow, vik, okabe-ito or tol-muted; the ending _r reverses it
    /// [default: viridis; okabe-ito for text and few whole numbers]
    #[arg(long, help_heading = HEADING, value_name = "NAME")]
    cmap: Option<String>,
    /// Reverse the color map
    #[arg(long, help_heading = HEADING)]
    cmap_reverse: bool,
    /// Numbers with the first and the last color: numbers, percentiles, or nothing for the end of the data, such as 0,5
    /// or 2%,98% or 0, [default: those of the data]
    #[arg(long, help_heading = HEADING, value_name = "LO,HI", allow_hyphen_values = true)]
    range: Option<String>,
    /// Let colors follow the logarithm of the numbers
    #[arg(long, help_heading = HEADING)]
    log: bool,
    /// CSS color of spheres without a value [default: #808080]
    #[arg(long, help_heading = HEADING, value_name = "CSS")]
    missing_color: Option<String>,
    /// Take the radii from a column of the data, which may be followed by a factor, such as diameter*0.5
    #[arg(long, help_heading = HEADING, value_name = "COLUMN[*F]")]
    radius_by: Option<String>,
    /// Take the opacities from a column of the data, from 0 (clear) to 1 (opaque)
    #[arg(long, help_heading = HEADING, value_name = "COLUMN")]
    opacity_by: Option<String>,
    /// Let spheres emit light of the strength that a column of the data has, which may be followed by a factor
    #[arg(long, help_heading = HEADING, value_name = "COLUMN[*F]")]
    emission_by: Option<String>,
    #[command(flatten)]
    pub(crate) annotation: AnnotationArgs,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct ColorFlags {
    pub(crate) mapping: Mapping,
    map: Option<MapName>,
    is_reversed: bool,
    limits: Option<Limits>,
    is_log: bool,
    missing: Option<[u8; 3]>,
    /// What colors mean in all frames of a movie.
    pub(crate) joined: JoinedKeys,
}

impl ColorFlags {
    pub(crate) fn new(args: &ColorArgs) -> Result<Self, Failure> {
        let refused = |flag: &str, error: &dyn std::fmt::Display| {
            Failure::usage(format!("--{flag}: {error}"))
        };
        let [radius, emission] =
            [&args.radius_by, &args.emission_by].map(|text| text.as_deref().map(with_factor));
        let map = args.cmap.as_deref().map(str::parse).transpose();
        let limits = args.range.as_deref().map(str::parse).transpose();
        let missing = args.missing_color.as_deref().map(css::color).transpose();
        Ok(Self {
            mapping: Mapping {
                color: args.color_by.as_deref().map(ColorBy::column),
                radius: radius.map(|(column, factor)| RadiusBy { column, factor }),
                opacity: args.opacity_by.clone(),
                emission: emission.map(|(column, factor)| EmissionBy { column, factor }),
            },
            map: map.map_err(|error| refused("cmap", &error))?,
            is_reversed: args.cmap_reverse,
            limits: limits.map_err(|error| refused("range", &error))?,
            is_log: args.log,
            missing: missing
                .map_err(|error| refused("missing-color", &error))?
                .map(LinearRgb::to_srgb8),
            joined: JoinedKeys::default(),
        })
    }

    /// Gives the colors of a column the range or the categories of all frames of a movie.
    pub(crate) fn join(&self, color: &mut ColorBy) {
        self.joined.apply_to(color);
    }

    /// Whether any flag that needs data was given.
    pub(crate) fn given(&self) -> Option<&'static str> {
        let given = [
            ("--color-by", self.mapping.color.is_some()),
            ("--radius-by", self.mapping.radius.is_some()),
            ("--opacity-by", self.mapping.opacity.is_some()),
            ("--emission-by", self.mapping.emission.is_some()),
        ];
        given.into_iter().chain(self.for_map()).find(|(_, is_given)| *is_given).map(|(f, _)| f)
    }

    /// The flags that say how a column becomes colors.
    fn for_map(&self) -> [(&'static str, bool); 5] {
        [
            ("--cmap", self.map.is_some()),
            ("--cmap-reverse", self.is_reversed),
            ("--range", self.limits.is_some()),
            ("--log", self.is_log),
            ("--missing-color", self.missing.is_some()),
        ]
    }

    /// The integrator that shows what the flags ask for.
    pub(crate) fn integrator(&self) -> Option<IntegratorKind> {
        let needs_light = self.mapping.opacity.is_some() || self.mapping.emission.is_some();
        needs_light.then_some(IntegratorKind::Studio)
    }

    /// Applies the flags to the keys of a scene file. Flags take precedence.
    pub(crate) fn apply_to(&self, file: &Mapping) -> Result<Mapping, Failure> {
        let mut mapping = self.mapping.clone().or(file.clone());
        let Some(color) = &mut mapping.color else {
            return match self.for_map().into_iter().find(|(_, is_given)| *is_given) {
                Some((flag, _)) => Err(Failure::usage(format!(
                    "{flag} says how numbers become colors, but no column is named; add --color-by COLUMN"
                ))),
                None => Ok(mapping),
            };
        };
        color.map = self.map.or(color.map);
        color.is_reversed |= self.is_reversed;
        color.limits = self.limits.unwrap_or(color.limits);
        color.is_log |= self.is_log;
        color.missing = self.missing.unwrap_or(color.missing);
        self.join(color);
        Ok(mapping)
    }
}

/// Splits `COLUMN*F` into the column and the factor, which is 1 if there is none.
fn with_factor(text: &str) -> (String, f64) {
    let factor = text
        .rsplit_once('*')
        .and_then(|(column, factor)| Some((column.trim().to_owned(), factor.trim().parse().ok()?)));
    factor.unwrap_or_else(|| (text.to_owned(), 1.0))
}

const STRUCTURE_HEADING: &str = "Selection, box and bonds";

#[derive(Debug, Args)]
pub(crate) struct StructureArgs {
    /// Render only the spheres for which an expression is true, such as 'species == O and z > 3 and |v| < 2': columns as
    /// for --color-by, == != < <= > >=, and, or, not, parentheses, and text with or without quotation marks
    #[arg(long, help_heading = STRUCTURE_HEADING, value_name = "EXPRESSION", allow_hyphen_values = true)]
    select: Option<String>,
    /// Draw the edges of the file's periodic cell, with this width [without a width: 1/300 of the cell's diagonal]
    #[arg(
        long = "box",
        help_heading = STRUCTURE_HEADING,
        value_name = "WIDTH",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = ""
    )]
    cell: Option<String>,
    /// Draw balls and sticks: bonds between atoms that are closer than FACTOR times the sum of their covalent radii,
    /// except between hydrogens; atoms become smaller unless their radii are given [without a factor: 1.2]
    #[arg(
        long,
        help_heading = STRUCTURE_HEADING,
        value_name = "FACTOR",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = ""
    )]
    bonds: Option<String>,
    /// Draw bonds between all spheres that are closer than this length, whatever they are
    #[arg(long, help_heading = STRUCTURE_HEADING, value_name = "LENGTH", allow_hyphen_values = true, conflicts_with = "bonds")]
    bond_length: Option<f64>,
}

#[derive(Clone, Debug, Default)]
pub(crate) struct StructureFlags {
    pub(crate) select: Option<Selection>,
    additions: Additions,
}

impl StructureFlags {
    pub(crate) fn new(args: &StructureArgs) -> Result<Self, Failure> {
        let select = args.select.as_deref().map(str::parse::<Selection>).transpose();
        let select = select.map_err(|error| Failure::usage(format!("--select: {error}")))?;
        let cell = args.cell.as_deref().map(|text| match text {
            "" => Ok(CellEdges::default()),
            text => positive("--box", text).map(CellEdges::of_width),
        });
        let bonds = args.bonds.as_deref().map(|text| match text {
            "" => Ok(Bonds::default()),
            text => {
                positive("--bonds", text).map(|factor| Bonds::new(BondLength::Covalent(factor)))
            }
        });
        let below = args.bond_length.map(|length| {
            positive("--bond-length", &length.to_string())
                .map(|length| Bonds::new(BondLength::Below(length)))
        });
        let additions = Additions {
            cell: cell.transpose()?,
            bonds: below.or(bonds).transpose()?,
            ..Additions::default()
        };
        Ok(Self { select, additions })
    }

    pub(crate) fn given(&self) -> Option<&'static str> {
        let bonds = match self.additions.bonds.as_ref().map(|bonds| bonds.length) {
            Some(BondLength::Below(_)) => "--bond-length",
            _ => "--bonds",
        };
        let given = [
            ("--select", self.select.is_some()),
            ("--box", self.additions.cell.is_some()),
            (bonds, self.additions.bonds.is_some()),
        ];
        given.into_iter().find(|(_, is_given)| *is_given).map(|(flag, _)| flag)
    }

    /// What is added to data whose scene file asks for `file`. Flags take precedence.
    pub(crate) fn additions(&self, file: &Additions, keeps_radii: bool) -> Additions {
        Additions {
            cell: self.additions.cell.clone().or_else(|| file.cell.clone()),
            bonds: self.additions.bonds.clone().or_else(|| file.bonds.clone()),
            keeps_radii,
        }
    }
}

fn positive(flag: &str, text: &str) -> Result<f64, Failure> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| {
        Failure::usage(format!(
            "{flag}: `{text}` is not a number that is finite and greater than 0"
        ))
    })
}
