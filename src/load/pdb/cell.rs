//! Reads the periodic cell from a CRYST1 record.

use super::record::Record;
use crate::load::atoms::cell;
use crate::load::error::LoadError;

/// Returns the edge vectors of the cell, the first along x and the second in the plane of x and y; or `None` if the
/// record is only a placeholder, as in files of structures that are not crystals.
pub(super) fn edges(record: &Record<'_>) -> Result<Option<[[f64; 3]; 3]>, LoadError> {
    const FIELDS: [(&str, usize, usize); 6] = [
        ("length of the cell's edge a", 7, 15),
        ("length of the cell's edge b", 16, 24),
        ("length of the cell's edge c", 25, 33),
        ("cell's angle alpha", 34, 40),
        ("cell's angle beta", 41, 47),
        ("cell's angle gamma", 48, 54),
    ];
    record.must_have(&FIELDS)?;
    let mut values = [0.0; 6];
    for (value, (what, first, last)) in values.iter_mut().zip(FIELDS) {
        *value = record.number(what, first, last)?;
    }
    let [a, b, c, alpha, beta, gamma] = values;
    let (lengths, angles) = ([a, b, c], [alpha, beta, gamma]);
    cell::edges(lengths, angles).map_err(|message| LoadError::line(record.line, message))
}
