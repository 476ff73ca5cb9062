//! The flags that select spheres, and add bonds and the edges of the cell. They take precedence over the keys of a scene
//! file.

use clap::Args;

use super::failure::Failure;
use pinhole::added::{Additions, BondLength, Bonds, CellEdges};
use pinhole::select::Selection;

const HEADING: &str = "Selection, box and bonds";

#[derive(Debug, Args)]
pub(super) struct StructureArgs {
    /// Render only the spheres for which an expression is true, such as 'species == O and z > 3 and |v| < 2': columns as
    /// for --color-by, == != < <= > >=, and, or, not, parentheses, and text with or without quotation marks
    #[arg(long, help_heading = HEADING, value_name = "EXPRESSION", allow_hyphen_values = true)]
    select: Option<String>,
    /// Draw the edges of the file's periodic cell, with this width [without a width: 1/300 of the cell's diagonal]
    #[arg(
        long = "box",
        help_heading = HEADING,
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
        help_heading = HEADING,
        value_name = "FACTOR",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = ""
    )]
    bonds: Option<String>,
    /// Draw bonds between all spheres that are closer than this length, whatever they are
    #[arg(long, help_heading = HEADING, value_name = "LENGTH", allow_hyphen_values = true, conflicts_with = "bonds")]
    bond_length: Option<f64>,
}

/// The flags that were given, checked.
#[derive(Clone, Debug, Default)]
pub(super) struct StructureFlags {
    pub(super) select: Option<Selection>,
    additions: Additions,
}

impl StructureFlags {
    pub(super) fn new(args: &StructureArgs) -> Result<Self, Failure> {
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

    /// A flag that was given.
    pub(super) fn given(&self) -> Option<&'static str> {
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
    pub(super) fn additions(&self, file: &Additions, keeps_radii: bool) -> Additions {
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
