//! Selections: their grammar, missing values, errors, and what is kept together.

use pinhole::load::{Column, ColumnValues, Labels, Loaded};
use pinhole::select::{SelectError, Selection};
use pinhole::{LinearRgb, SphereArray};

/// Six spheres at x = 0 to 5, with text and numbers.
fn loaded() -> Loaded {
    let spheres = (0..6).map(|i| [f64::from(i), -1.0, 0.5 * f64::from(i), 1.0]).collect();
    let mut loaded = Loaded::new(SphereArray::F64(spheres));
    let texts = |name: &str, names: &[&str], indices: [u32; 6]| {
        let names = names.iter().map(|name| (*name).to_owned()).collect();
        let values = ColumnValues::Labels(Labels { names, indices: indices.to_vec() });
        Column { name: name.to_owned(), values }
    };
    let numbers = |name: &str, values: [f64; 6]| Column {
        name: name.to_owned(),
        values: ColumnValues::Numbers(values.to_vec()),
    };
    let nan = f64::NAN;
    loaded.columns = vec![
        texts("species", &["H", "O", "Fe"], [0, 1, 1, 2, 0, 1]),
        texts("chain", &["A", "", "x"], [0, 0, 1, 2, 2, 2]),
        texts("type", &["1", "2", "10"], [0, 1, 2, 2, 1, 0]),
        numbers("q", [0.0, 1.0, nan, -2.0, 1e3, 1.0]),
        numbers("vx", [3.0, 0.0, nan, 1.0, 0.0, 0.0]),
        numbers("vy", [4.0, 0.0, 0.0, 1.0, 0.0, 0.0]),
        numbers("vz", [0.0, 2.0, 0.0, 1.0, 0.0, 0.0]),
        numbers("my column", [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]),
    ];
    loaded
}

fn selected(text: &str) -> Result<Vec<usize>, SelectError> {
    let loaded = loaded();
    let (matches, _) = text.parse::<Selection>()?.matches(&loaded.spheres, &loaded.columns)?;
    Ok((0..matches.len()).filter(|index| matches[*index]).collect())
}

#[test]
fn expressions_select() {
    for (text, expected) in [
        ("species == O", vec![1, 2, 5]),
        ("species == 'O'", vec![1, 2, 5]),
        ("\"O\" == species", vec![1, 2, 5]),
        ("O == species", vec![1, 2, 5]),
        ("SPECIES != O", vec![0, 3, 4]),
        ("x < 2", vec![0, 1]),
        ("2 > x", vec![0, 1]),
        ("x<=2", vec![0, 1, 2]),
        ("x>=4.0e0", vec![4, 5]),
        ("y == -1", vec![0, 1, 2, 3, 4, 5]),
        ("index == 3", vec![3]),
        ("q > z", vec![1, 4]),
        ("|v| < 2", vec![3, 4, 5]),
        ("| v | >= 5", vec![0]),
        ("`my column` == 2", vec![3, 4, 5]),
        // `and` binds more tightly than `or`, and `not` most of all.
        ("x == 0 or x > 3 and species == H", vec![0, 4]),
        ("(x == 0 or x > 3) and species == H", vec![0, 4]),
        ("x == 0 || x > 3 && species == O", vec![0, 5]),
        ("not x < 4", vec![4, 5]),
        ("!x < 4", vec![4, 5]),
        ("not species == H and x < 3", vec![1, 2]),
        ("NOT (species == H OR x < 3)", vec![3, 5]),
        ("not not x == 1", vec![1]),
        ("!(!(x == 1) && !(x == 2))", vec![1, 2]),
        // A name of a column is a text where it stands beside a column of text.
        ("chain == x", vec![3, 4, 5]),
        // Texts that are numbers.
        ("type == 1", vec![0, 5]),
        ("type == 10.0", vec![2, 3]),
        ("type > 1", vec![1, 2, 3, 4]),
        ("type == '10.0' or index == 0", vec![0]),
        // What is missing never matches, nor does its opposite.
        ("q == 1", vec![1, 5]),
        ("q != 1", vec![0, 3, 4]),
        ("not q == 1", vec![0, 3, 4]),
        ("not (q > 0)", vec![0, 3]),
        ("|v| >= 0", vec![0, 1, 3, 4, 5]),
        ("chain != A", vec![3, 4, 5]),
        ("not chain == A", vec![3, 4, 5]),
        ("q == q", vec![0, 1, 3, 4, 5]),
    ] {
        assert_eq!(selected(text).unwrap(), expected, "{text}");
    }
}

#[test]
fn errors_point_at_their_place() {
    for (text, character, problem) in [
        ("species == O and sped > 3", 18, "there is no column `sped`; did you mean `species`?"),
        ("x > zz", 5, "there is no column `zz`"),
        ("|w| < 2", 1, "there is no column `|w|`; the columns are species"),
        ("x = 3", 3, "write == to compare"),
        ("x > 1 & y < 2", 7, "write &&, or the word"),
        ("x > 1 | y < 2", 7, "write ||, or the word"),
        ("1 < x < 3", 7, "a comparison has two sides"),
        ("x", 2, "a comparison, such as ==, != or <, belongs here, but the end stands here"),
        ("", 1, "a column, a number or a text belongs here, but the end stands here"),
        ("x > 1 and", 10, "a column, a number or a text belongs here, but the end"),
        ("x > 1 and or y < 2", 11, "belongs here, but `or` stands here"),
        ("x > 1 y < 2", 7, "`and`, `or` or the end belongs here, but `y` stands here"),
        ("(x > 1", 1, "there is no closing )"),
        ("x > 1)", 6, "`and`, `or` or the end belongs here, but `)` stands here"),
        ("species == 'O", 12, "there is no closing '"),
        ("q > 1 and |v < 2", 11, "there is no closing |"),
        ("x == 'O'", 6, "`O` is a text, but `x` holds numbers"),
        ("species < Fe", 11, "`species` holds text, which is compared only with == and !="),
        ("species == chain", 12, "`chain` is a column of text, too"),
        ("1 < 2", 1, "this compares two fixed values"),
        ("'a' == 'a'", 1, "this compares two fixed values"),
        // Characters are counted, not bytes.
        ("species == 'ö' and xx > 3", 20, "there is no column `xx`"),
    ] {
        let error = selected(text).unwrap_err();
        let SelectError::At { character: found, .. } = &error else { panic!("{text}: {error}") };
        assert_eq!(*found, character, "{text}: {error}");
        let message = error.to_string();
        assert!(message.contains(problem), "{text}: {message}");
        assert_eq!(message.lines().count(), 1, "{message}");
    }
    let deep = format!("{}x > 1{}", "(".repeat(100_000), ")".repeat(100_000));
    assert!(selected(&deep).unwrap_err().to_string().contains("parentheses lie in more than 100"));
    assert_eq!(selected(&format!("{} x == 1", "not ".repeat(100_001))).unwrap().len(), 5);
}

#[test]
fn what_is_kept_stays_together() {
    let mut loaded = loaded();
    let level = |i: u8| LinearRgb::from_srgb8([40 * i; 3]);
    loaded.colors = Some((0..6).map(level).collect());
    loaded.opacities = Some(vec![0.0, 0.1, 0.2, 0.3, 0.4, 0.5]);
    let kept = "x > 1 and x < 5".parse::<Selection>().unwrap().apply(&mut loaded).unwrap();
    assert_eq!((kept.kept, kept.of, kept.notes.len()), (3, 6, 0));
    let SphereArray::F64(spheres) = &loaded.spheres else { panic!("f64 stays f64") };
    assert_eq!(spheres.iter().map(|s| s[0]).collect::<Vec<_>>(), [2.0, 3.0, 4.0]);
    assert_eq!(loaded.colors, Some((2..5).map(level).collect()));
    assert_eq!(loaded.opacities, Some(vec![0.2, 0.3, 0.4]));
    // Texts that nobody has are gone, and the rest is numbered anew.
    let species = loaded.labels("species").unwrap();
    assert_eq!(
        (&species.names[..], &species.indices[..]),
        (&["O", "Fe", "H"].map(String::from)[..], &[0, 1, 2][..])
    );
    // The index is that of the file.
    assert_eq!(loaded.column("index"), Some(&ColumnValues::Numbers(vec![2.0, 3.0, 4.0])));
    for column in &loaded.columns {
        let count = match &column.values {
            ColumnValues::Labels(labels) => labels.indices.len(),
            ColumnValues::Numbers(numbers) => numbers.len(),
            _ => 0,
        };
        assert_eq!(count, 3, "{}", column.name);
    }
}

#[test]
fn nothing_is_an_error_and_an_unknown_text_a_note() {
    let mut loaded = loaded();
    let before = loaded.clone();
    let apply = |text: &str, loaded: &mut Loaded| text.parse::<Selection>().unwrap().apply(loaded);
    let error = apply("x > 9", &mut loaded).unwrap_err();
    assert_eq!(error.to_string(), "`x > 9` selects none of the 6 spheres");
    let error = apply("species == o", &mut loaded).unwrap_err();
    assert_eq!(
        error.to_string(),
        "`species == o` selects none of the 6 spheres; no sphere has the species `o`; there are H, O, Fe"
    );
    // NaN makes columns differ from themselves.
    assert_eq!((&loaded.spheres, loaded.columns.len()), (&before.spheres, before.columns.len()));
    let kept = apply("chain != B", &mut loaded).unwrap();
    assert_eq!((kept.kept, kept.of), (5, 6));
    assert_eq!(kept.notes, ["no sphere has the chain `B`; there are A, x"]);
    let empty = &mut Loaded::new(SphereArray::F32(Vec::new()));
    assert_eq!(apply("x > 9", empty).unwrap().of, 0);
}
