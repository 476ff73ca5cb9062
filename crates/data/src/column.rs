//! Finds the column that a user names.

use std::borrow::Cow;

use crate::keys::key_of;
use crate::load::{Column, ColumnValues};
use pinhole::internals::text::one_line;
use pinhole::scene::sphere_array::SphereArray;

/// The columns that all spheres have, whatever their file says.
pub const BUILT_IN: [&str; 5] = ["index", "radius", "x", "y", "z"];

/// A column that was found.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct NamedColumn<'a> {
    /// Its name, spelled as in the data.
    pub name: String,
    /// One value for each sphere.
    pub values: Cow<'a, ColumnValues>,
}

/// The reason why there is no such column.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ColumnError {
    /// The data has no column of this name.
    #[error("there is no column `{name}`{};{} the columns are {columns}", why_none(.name),
        .nearest.as_ref().map_or(String::new(), |nearest| format!(" did you mean `{nearest}`?")))]
    Unknown {
        /// The name as given.
        name: String,
        /// The name of a column that is spelled alike.
        nearest: Option<String>,
        /// The names of all columns.
        columns: String,
    },
    /// The values are text, but numbers are needed.
    #[error("the column `{name}` holds text, but numbers are needed here; the columns of numbers are {columns}")]
    Text {
        /// The name of the column.
        name: String,
        /// The names of the columns of numbers.
        columns: String,
    },
    /// The data has no vector of this name.
    #[error("there is no vector `{name}`, with the columns {name}.x, {name}.y and {name}.z; {}",
        if .vectors.is_empty() { "the data has none".to_owned() } else { format!("the vectors are {vectors}") })]
    NoVector {
        /// The name as given.
        name: String,
        /// The names of all vectors.
        vectors: String,
    },
    /// The column does not have one value for each sphere.
    #[error("the column `{name}` has {values} values, but there are {spheres} spheres")]
    Count {
        /// The name of the column.
        name: String,
        /// The number of its values.
        values: usize,
        /// The number of spheres.
        spheres: usize,
    },
}

/// Finds a column by its name, in upper or lower case. It is one of `columns`, or else one of [`BUILT_IN`]: the index
/// in input order, the radius and the coordinates of the centre. The name `|v|` gives the length of a vector whose
/// components are the columns `v.x`, `v.y` and `v.z`, or `vx`, `vy` and `vz`, or `v_x`, `v_y` and `v_z`. Words of selections
/// such as `element` and `resname` find the column that holds what they mean.
///
/// # Errors
/// Returns an error if there is no such column, or if it does not have one value for each sphere.
pub fn column<'a>(name: &str, spheres: &SphereArray, columns: &'a [Column]) -> Result<NamedColumn<'a>, ColumnError> {
    let name = name.trim();
    if let Some(column) = named(name, columns) {
        check_count(column, spheres)?;
        return Ok(NamedColumn { name: column.name.clone(), values: Cow::Borrowed(&column.values) });
    }
    if let Some(built_in) = BUILT_IN.into_iter().find(|known| known.eq_ignore_ascii_case(name)) {
        let values = built_in_values(built_in, spheres);
        return Ok(NamedColumn { name: built_in.to_owned(), values: owned(values) });
    }
    if within_bars(name).is_some_and(|name| components(name, columns).is_some()) {
        let (vector, [x, y, z]) = vector(name, spheres, columns)?;
        let lengths = x.iter().zip(y).zip(z).map(|((x, y), z)| x.hypot(*y).hypot(*z));
        return Ok(NamedColumn { name: format!("|{vector}|"), values: owned(lengths.collect()) });
    }
    // A word for what the data calls otherwise, such as `element` or `Position.X`. Words with a dot at the end are only
    // those of selections.
    let key = key_of(&name.replace(' ', "")).filter(|_| !name.ends_with('.'));
    let is_found = |other: &&&str| named(other, columns).is_some() || BUILT_IN.contains(other);
    match key.and_then(|key| key.columns.iter().find(is_found)) {
        Some(other) if !other.eq_ignore_ascii_case(name) => column(other, spheres, columns),
        _ => match component(name, columns) {
            Some(other) => column(other, spheres, columns),
            None => Err(unknown(name, columns)),
        },
    }
}

/// The column of a component of a vector whose name is spelled otherwise, such as `Force.Z` or `force_z` for `forces.z`.
fn component<'a>(name: &str, columns: &'a [Column]) -> Option<&'a str> {
    let (vector, axis) = name.rsplit_once(['.', '_', ' '])?;
    let plain = |text: &str| text.to_lowercase().trim_end_matches('s').to_owned();
    let is_same = |column: &&Column| {
        let parts = column.name.rsplit_once('.');
        parts.is_some_and(|(other, of)| of.eq_ignore_ascii_case(axis) && plain(other) == plain(vector))
    };
    columns.iter().find(is_same).map(|column| column.name.as_str()).filter(|found| *found != name)
}

/// A vector of each sphere: its name, spelled as in the data, and its three components.
pub type Vector<'a> = (&'a str, [&'a [f64]; 3]);

/// Finds a vector by its name `v` or `|v|`, as [`column()`] does for its length.
///
/// # Errors
/// Returns an error if there is no such vector, or if it does not have one value for each sphere.
pub fn vector<'a>(name: &str, spheres: &SphereArray, columns: &'a [Column]) -> Result<Vector<'a>, ColumnError> {
    let name = name.trim();
    let found = components(within_bars(name).unwrap_or(name), columns).ok_or_else(|| {
        let lengths = vectors(columns);
        let vectors = lengths.map(|length| length.trim_matches('|').to_owned()).collect::<Vec<_>>().join(", ");
        ColumnError::NoVector { name: one_line(name), vectors }
    });
    let (name, components) = found?;
    for (column, _) in components {
        check_count(column, spheres)?;
    }
    Ok((name, components.map(|(_, values)| values)))
}

/// The name of a vector whose length a name such as `|v|` means.
fn within_bars(name: &str) -> Option<&str> {
    name.strip_prefix('|')?.strip_suffix('|').map(str::trim)
}

/// Finds a column of numbers, as [`column()`] does.
///
/// # Errors
/// Returns an error if there is no such column, or its values are text.
pub fn numbers<'a>(
    name: &str,
    spheres: &SphereArray,
    columns: &'a [Column],
) -> Result<(String, Cow<'a, [f64]>), ColumnError> {
    let NamedColumn { name, values } = column(name, spheres, columns)?;
    match values {
        Cow::Borrowed(ColumnValues::Numbers(values)) => Ok((name, Cow::Borrowed(values))),
        Cow::Owned(ColumnValues::Numbers(values)) => Ok((name, Cow::Owned(values))),
        Cow::Borrowed(ColumnValues::Labels(_)) | Cow::Owned(ColumnValues::Labels(_)) => {
            let is_number = |column: &&Column| matches!(column.values, ColumnValues::Numbers(_));
            let columns = names(columns.iter().filter(is_number), columns).join(", ");
            Err(ColumnError::Text { name, columns })
        }
    }
}

fn owned<'a>(values: Vec<f64>) -> Cow<'a, ColumnValues> {
    Cow::Owned(ColumnValues::Numbers(values))
}

fn named<'a>(name: &str, columns: &'a [Column]) -> Option<&'a Column> {
    let exact = columns.iter().find(|column| column.name == name);
    exact.or_else(|| columns.iter().find(|column| column.name.eq_ignore_ascii_case(name)))
}

fn check_count(column: &Column, spheres: &SphereArray) -> Result<(), ColumnError> {
    let values = match &column.values {
        ColumnValues::Labels(labels) => labels.indices.len(),
        ColumnValues::Numbers(numbers) => numbers.len(),
    };
    let spheres = spheres.len();
    if values == spheres {
        return Ok(());
    }
    Err(ColumnError::Count { name: column.name.clone(), values, spheres })
}

fn built_in_values(name: &str, spheres: &SphereArray) -> Vec<f64> {
    let place = match name {
        "x" => 0,
        "y" => 1,
        "z" => 2,
        "radius" => 3,
        _ => return (0..spheres.len()).map(|index| index as f64).collect(),
    };
    match spheres {
        SphereArray::F32(spheres) => spheres.iter().map(|s| s[place].into()).collect(),
        SphereArray::F64(spheres) => spheres.iter().map(|s| s[place]).collect(),
    }
}

type Component<'a> = (&'a Column, &'a [f64]);

/// Returns the name of a vector, spelled as in the data, and its three components.
fn components<'a>(name: &str, columns: &'a [Column]) -> Option<(&'a str, [Component<'a>; 3])> {
    [".", "", "_"].into_iter().find_map(|joint| {
        let component = |axis: &str| {
            let column = named(&format!("{name}{joint}{axis}"), columns)?;
            match &column.values {
                ColumnValues::Numbers(values) => Some((column, values.as_slice())),
                ColumnValues::Labels(_) => None,
            }
        };
        let found = [component("x")?, component("y")?, component("z")?];
        let spelled = &found[0].0.name;
        Some((spelled.get(..spelled.len() - joint.len() - 1)?, found))
    })
}

/// The names that [`column`] understands: those of `shown`, the built-in ones, and the lengths of vectors.
fn names<'a>(shown: impl Iterator<Item = &'a Column>, columns: &'a [Column]) -> Vec<String> {
    let mut names: Vec<String> = shown.map(|column| one_line(&column.name)).collect();
    let built_in = BUILT_IN.into_iter().filter(|name| named(name, columns).is_none());
    names.extend(built_in.map(str::to_owned));
    names.extend(vectors(columns));
    names
}

/// The names of the lengths of all vectors, such as `|v|`.
fn vectors(columns: &[Column]) -> impl Iterator<Item = String> {
    let lengths = columns.iter().filter_map(|column| {
        let stem = column.name.strip_suffix(['x', 'X'])?;
        let stem = stem.strip_suffix(['.', '_']).unwrap_or(stem);
        components(stem, columns).map(|(vector, _)| format!("|{vector}|"))
    });
    lengths.filter(|name| name != "||")
}

/// Why data never has what other programs compute.
fn why_none(name: &str) -> &'static str {
    match name.to_lowercase().replace([' ', '_', '-'], "").as_str() {
        "ss" | "structure" | "secondary" | "secondarystructure" | "dssp" => {
            ", as secondary structures are not computed"
        }
        "cna" | "ptm" | "structuretype" | "coordination" | "coordinationnumber" | "centrosymmetry" | "csp" => {
            ", as structures are not analyzed; compute it elsewhere, and add a column to the file"
        }
        "spectrum" | "rainbow" | "resids" => ", and residue_number with the map turbo colors a chain from end to end",
        "density" | "localdensity" => ", as densities are not computed; add a column to the file",
        _ => "",
    }
}

fn unknown(name: &str, columns: &[Column]) -> ColumnError {
    let known = names(columns.iter(), columns);
    let likeness = |known: &str| {
        strsim::jaro_winkler(
            known.trim_matches('|').to_lowercase().as_str(),
            name.trim_matches('|').to_lowercase().as_str(),
        )
    };
    let nearest = known.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    let nearest = nearest.filter(|nearest| likeness(nearest) > 0.75).cloned();
    ColumnError::Unknown { name: one_line(name), nearest, columns: known.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::{self, Options};

    #[test]
    fn words_of_selections_find_columns() {
        let pdb = "ATOM      1  CA  ALA A   1       0.000   0.000   0.000  1.00  5.00           C\n";
        let data = load::from_bytes(pdb.as_bytes(), "a.pdb", &Options::default()).unwrap();
        for (word, wanted) in [
            ("element", "species"),
            ("resname", "residue"),
            ("resid", "residue_number"),
            ("bfactor", "b_factor"),
            ("B", "b_factor"),
            ("chainID", "chain"),
            ("residue", "residue"),
        ] {
            assert_eq!(column(word, &data.spheres, &data.columns).unwrap().name, wanted, "{word}");
        }
        assert!(column("charge", &data.spheres, &data.columns).is_err());
    }
}
