//! The columns of the atoms in data files, which depend on the simulation's style of atoms.

use crate::load::error::LoadError;
use crate::load::rows::{Field, Kind, Lines, Rows, Values};
use crate::text::shortened;

/// The columns of each style, as the manual's page of `read_data` lists them.
const STYLES: [(&str, &str); 22] = [
    ("angle", "id mol type x y z"),
    ("atomic", "id type x y z"),
    ("body", "id type bodyflag mass x y z"),
    ("bond", "id mol type x y z"),
    ("charge", "id type q x y z"),
    ("dielectric", "id type q x y z mux muy muz area ed em epsilon curvature"),
    ("dipole", "id type q x y z mux muy muz"),
    ("dpd", "id type theta x y z"),
    ("edpd", "id type edpd_temp edpd_cv x y z"),
    ("electron", "id type q espin eradius x y z"),
    ("ellipsoid", "id type ellipsoidflag density x y z"),
    ("full", "id mol type q x y z"),
    ("line", "id mol type lineflag density x y z"),
    ("mdpd", "id type rho x y z"),
    ("molecular", "id mol type x y z"),
    ("peri", "id type volume density x y z"),
    ("rheo", "id type status rho x y z"),
    ("sph", "id type rho esph cv x y z"),
    ("sphere", "id type diameter density x y z"),
    ("spin", "id type x y z spx spy spz sp"),
    ("template", "id type mol template_index template_atom x y z"),
    ("tri", "id mol type triangleflag density x y z"),
];

fn columns_of(style: &str) -> Option<Vec<&'static str>> {
    let (_, columns) = STYLES.iter().find(|(name, _)| *name == style)?;
    Some(columns.split(' ').collect())
}

/// The columns of a style by its name, for messages.
fn listed(style: &str) -> String {
    columns_of(style).unwrap_or_default().join(",")
}

/// Returns the columns of the rows: those that are given, or those of the style, or those of the only style that they can
/// be of. Three whole numbers behind them count how often the atom has crossed the box.
pub(super) fn fields_of(
    rows: Rows<'_>,
    style: Option<&str>,
    given: &[String],
) -> Result<Vec<Field>, LoadError> {
    let line = rows.lines_before + 1;
    let first: Vec<&[u8]> = Values { rest: Lines::new(rows.text).next().unwrap_or_default() }
        .take_while(|value| !value.starts_with(b"#"))
        .collect();
    let found = first.len();
    let is_whole =
        |value: &&[u8]| std::str::from_utf8(value).is_ok_and(|text| text.parse::<i64>().is_ok());
    let has_images = |count: usize| found == count + 3 && first[count..].iter().all(is_whole);
    // A hybrid style has the columns of its parts in an order that only their names tell.
    let style = style.and_then(|style| style.split_whitespace().next()).map(str::to_owned);
    let names: Vec<String> = if given.is_empty() {
        let columns = match &style {
            Some(style) => {
                columns_of(style).ok_or_else(|| {
                    let style = shortened(style);
                    let message = format!(
                        "the columns of the style {style} are not known; name them, such as with --columns id,type,x,y,z"
                    );
                    LoadError::line(line, message)
                })?
            }
            None if found == 5 || has_images(5) => columns_of("atomic").unwrap_or_default(),
            None if rows.text.is_empty() => columns_of("atomic").unwrap_or_default(),
            None => {
                let message = format!(
                    "atoms have {found} columns, and the file does not say which; name their style, as in `Atoms # full`, \
                     or the columns, as with --columns {}",
                    listed("charge")
                );
                return Err(LoadError::line(line, message));
            }
        };
        columns.into_iter().map(str::to_owned).collect()
    } else {
        given.to_vec()
    };
    let images = if has_images(names.len()) { &["ix", "iy", "iz"][..] } else { &[] };
    if found != names.len() + images.len() && !rows.text.is_empty() {
        let (names, declared) = (names.join(" "), names.len());
        let message = format!(
            "this line has {found} columns, but {declared} have names ({names}); three whole numbers may follow"
        );
        return Err(LoadError::line(line, message));
    }
    let field = |name: &str| {
        let is_text = matches!(name, "type" | "element");
        Field::new(name, if is_text { Kind::Text } else { Kind::Number })
    };
    Ok(names.iter().map(String::as_str).chain(images.iter().copied()).map(field).collect())
}
