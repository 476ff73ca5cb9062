//! Pieces of lines give what the whole text gives.

use super::*;
use crate::load::loaded::ColumnValues;

fn fields() -> Vec<Field> {
    vec![
        Field::new("species", Kind::Text),
        Field::new("x", Kind::Number),
        Field::new("skipped", Kind::Skipped),
        Field::new("y", Kind::Number),
        Field::new("name", Kind::Text),
    ]
}

fn rows(text: &str) -> Rows<'_> {
    Rows { text: text.as_bytes(), lines_before: 2, may_be_longer: false }
}

fn values(columns: Vec<TableColumn>) -> Vec<(String, ColumnValues)> {
    columns.into_iter().map(|column| (column.name, column.values)).collect()
}

/// Columns for so many rows as there are lines would take 80 GB.
#[test]
fn short_lines_of_many_columns_take_little_memory() {
    let fields = vec![Field::new("a", Kind::Number); 100_000];
    let lines = "1\n".repeat(100_000);
    let error = rows(&lines).read(&fields).map(drop).unwrap_err();
    assert_eq!(error, missing(3, "a", 1, 1));
    let skipped = Field::new("a", Kind::Skipped);
    let all = rows("1 2\n1 2").read(&[skipped.clone(), skipped]);
    assert_eq!(all.map(|columns| columns.len()), Ok(0));
}

#[test]
fn pieces_are_joined_in_order() {
    let mut random = fastrand::Rng::with_seed(3);
    for _ in 0..50 {
        let mut wanted = (Vec::new(), Vec::new());
        let text: String = (0..random.usize(..60))
            .map(|_| {
                let (x, name) = (random.f64(), random.u8(..9));
                wanted.0.push(x);
                wanted.1.push(format!("a_rather_long_name_{name}"));
                format!(" H{}\t{x} - 1e-3  a_rather_long_name_{name} \r\n", random.bool())
            })
            .collect();
        let text = text.trim_end_matches('\n');
        let whole = values(rows(text).read(&fields()).unwrap());
        for size in [1, 7, 100, 1 << 20] {
            assert_eq!(values(rows(text).read_in_pieces(&fields(), size).unwrap()), whole);
        }
        let names: Vec<&str> = whole.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["species", "x", "y", "name"]);
        assert_eq!(whole[1].1, ColumnValues::Numbers(wanted.0));
        let ColumnValues::Labels(labels) = &whole[3].1 else { panic!("no text") };
        let found: Vec<_> =
            labels.indices.iter().map(|i| labels.names[*i as usize].clone()).collect();
        assert_eq!(found, wanted.1);
    }
}

#[test]
fn the_first_bad_line_is_named() {
    let good = "H 1 2 3 n\n".repeat(20);
    for size in [1, 30, 1 << 20] {
        let refused =
            |text: &str| rows(text).read_in_pieces(&fields(), size).unwrap_err().to_string();
        assert_eq!(
            refused(&format!("{good}H 1 2 x n\nH z\n{good}H y\n")),
            "line 23, column 4: y is `x`, which is not a number"
        );
        assert_eq!(
            refused(&format!("{good}H 1 2\nH z\n")),
            "line 23: y, which is column 4, is missing; the line has 3 columns"
        );
        assert_eq!(
            refused(&format!("{good}H 1 2 3 n 5 6\n")),
            "line 23: this line has 7 columns, but only 5 have names"
        );
        assert_eq!(
            refused(&format!("{good}\n")),
            "line 23: species, which is column 1, is missing; the line has 0 columns"
        );
    }
    for bad in [&b"H\xff 1 2 3 n"[..], b"H 1 2 \xff n"] {
        let rows = Rows { text: bad, lines_before: 0, may_be_longer: false };
        assert_eq!(rows.read(&fields()).map(drop), Err(not_text(1)));
    }
}
