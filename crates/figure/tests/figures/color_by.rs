//! Colours, radii, opacities and strengths of light from columns, and selections by expressions over columns.

use pinhole::{LinearRgb, Material, SphereArray};
use pinhole_data::column;
use pinhole_data::load::{Column, ColumnValues, Dataset, Labels};
use pinhole_data::select::{SelectError, Selection};
use pinhole_figure::color_by::{
    ColorBy, ColorKey, ColumnError, EmissionBy, JoinedKeys, KeyKind, MISSING, Mapping, RadiusBy,
};
use pinhole_figure::scene_file::{Data, DataError, DataScene, OwnShapes};

fn spheres(count: usize) -> SphereArray {
    SphereArray::F64((0..count).map(|i| [i as f64, 10.0 + i as f64, 0.5, 1.0 + i as f64]).collect())
}

fn numbers(name: &str, values: &[f64]) -> Column {
    Column { name: name.to_owned(), values: ColumnValues::Numbers(values.to_vec()) }
}

fn labels(name: &str, texts: &[&str]) -> Column {
    let mut labels = Labels::default();
    for text in texts {
        let known = labels.names.iter().position(|name| name == text);
        let index = known.unwrap_or_else(|| {
            labels.names.push((*text).to_owned());
            labels.names.len() - 1
        });
        labels.indices.push(index as u32);
    }
    Column { name: name.to_owned(), values: ColumnValues::Labels(labels) }
}

/// A mapping whose colours are levels of grey.
fn gray(column: &str) -> ColorBy {
    ColorBy { map: Some("gray".parse().unwrap()), ..ColorBy::column(column) }
}

/// The grey levels that a mapping gives `values`, and its notes.
fn levels(by: &ColorBy, values: &[f64]) -> (Vec<u8>, Vec<String>) {
    let columns = [numbers(&by.column, values)];
    let coloring = by.apply(&spheres(values.len()), &columns).unwrap();
    let level = |index| coloring.color(index).unwrap().to_srgb8()[0];
    ((0..values.len()).map(level).collect(), coloring.notes)
}

fn category_names(key: &ColorKey) -> Vec<(&str, usize)> {
    match &key.kind {
        KeyKind::Categories(list) => list.iter().map(|c| (c.name.as_str(), c.count)).collect(),
        _ => panic!("{key:?}"),
    }
}

/// The colours that a mapping gives spheres with these texts.
fn colors_of(by: &ColorBy, texts: &[&str]) -> Vec<[u8; 3]> {
    let coloring = by.apply(&spheres(texts.len()), &[labels("t", texts)]).unwrap();
    (0..texts.len()).map(|index| coloring.color(index).unwrap().to_srgb8()).collect()
}

#[test]
fn frames_together_give_a_category_one_color() {
    let frames: [&[&str]; 3] = [&["c", "a"], &["b", "c"], &["c"]];
    let mut by = ColorBy::column("t");
    let mut joined = JoinedKeys::default();
    for texts in frames {
        let found = by.apply(&spheres(texts.len()), &[labels("t", texts)]).unwrap();
        joined.add(&found.key);
    }
    let alone = frames.map(|texts| colors_of(&by, texts));
    assert!(alone[0][0] != alone[2][0], "{alone:?}");
    joined.apply_to(&mut by);
    let [first, second, third] = frames.map(|texts| colors_of(&by, texts));
    assert_eq!([first[0], first[0]], [second[1], third[0]]);
    assert!(first[1] != second[0]);
    let found = by.apply(&spheres(1), &[labels("t", &["d"])]).unwrap();
    assert_eq!(category_names(&found.key), [("a", 0), ("b", 0), ("c", 0)]);
    assert_eq!(found.color(0).unwrap().to_srgb8(), MISSING);
    assert_eq!(found.notes, ["1 sphere has a value of `t` that is not among the categories and the color #808080"]);
}

#[test]
fn frames_together_have_one_range_if_any_is_on_a_scale() {
    let frames: [&[f64]; 3] = [&[0.0, 7.0], &[0.5, 3.0], &[2.0, f64::NAN]];
    let mut by = ColorBy::column("t");
    let mut joined = JoinedKeys::default();
    let key = |by: &ColorBy, values: &[f64]| by.apply(&spheres(values.len()), &[numbers("t", values)]).unwrap().key;
    assert!(matches!(key(&by, frames[0]).kind, KeyKind::Categories(_)));
    frames.iter().for_each(|values| joined.add(&key(&by, values)));
    assert_eq!(joined.missing(), Some(MISSING));
    joined.apply_to(&mut by);
    for values in frames {
        match key(&by, values).kind {
            KeyKind::Scale(scale) => assert_eq!(scale.scale().range(), [0.0, 7.0]),
            other => panic!("{other:?}"),
        }
    }
    // Categories stay categories, even if a frame has numbers.
    let mut by = ColorBy::column("t");
    let mut joined = JoinedKeys::default();
    joined.add(&key(&by, &[10.0, 9.0]));
    joined.apply_to(&mut by);
    let found = by.apply(&spheres(2), &[numbers("t", &[9.0, 0.5])]).unwrap();
    assert_eq!(category_names(&found.key), [("9", 1), ("10", 0)]);
    assert_eq!(found.color(1).unwrap().to_srgb8(), MISSING);
}

#[test]
fn numbers_have_the_color_of_their_place_in_the_range() {
    let (found, notes) = levels(&gray("t"), &[-1.0, 0.0, 1.0, 3.0]);
    assert_eq!(found, [0, 64, 128, 255]);
    assert_eq!(notes, ["colors show `t` from -1 to 3"]);
    let by = ColorBy { is_reversed: true, ..gray("t") };
    assert_eq!(levels(&by, &[-1.0, 3.0]).0, [255, 0]);
    let by = ColorBy { limits: "0,1".parse().unwrap(), ..gray("t") };
    let (found, notes) = levels(&by, &[-5.0, 0.2, 9.0]);
    assert_eq!(found, [0, 51, 255]);
    assert_eq!(notes, ["`t` of 2 spheres lies outside the range 0 to 1 and has the color of its end"]);
}

#[test]
fn a_logarithmic_scale_has_equal_steps_for_equal_ratios() {
    let by = ColorBy { is_log: true, ..gray("t") };
    let values = [1e-3, 1e-2, 1.0, 1e2, 0.0, -4.0, f64::NAN];
    let (found, notes) = levels(&by, &values);
    assert_eq!(found, [0, 51, 153, 255, 0x80, 0x80, 0x80]);
    assert_eq!(
        notes,
        [
            "colors show `t` from 0.001 to 100 on a logarithmic scale",
            "3 spheres have no number greater than 0 in `t` and are shown in #808080"
        ]
    );
}

#[test]
fn what_is_missing_is_gray_and_counted() {
    let (found, notes) = levels(&gray("t"), &[0.0, f64::NAN, 1.0, f64::INFINITY]);
    assert_eq!(found, [0, 0x80, 255, 255]);
    assert_eq!(notes[1], "1 sphere has no value in `t` and is shown in #808080");
    let columns = [numbers("t", &[f64::NAN; 3])];
    let error = gray("t").apply(&spheres(3), &columns).unwrap_err();
    assert_eq!(error.to_string(), "the column `t` has no finite number, so it gives no colors");
    assert_eq!(MISSING, [0x80; 3]);
}

#[test]
fn spheres_that_are_left_out_do_not_count() {
    let mut loaded = Dataset::new(spheres(4));
    loaded.columns = vec![numbers("t", &[0.0, 1.0, 1000.0, f64::NAN]), labels("chain", &["A", "B", "C", ""])];
    let color = |by: ColorBy| {
        let mapping = Mapping { color: Some(by), ..Mapping::default() };
        let leave_out = vec![("chain".to_owned(), vec!["C".to_owned(), String::new()])];
        Data { mapping, leave_out, ..Data::of_file("a.xyz") }.scene(loaded.clone(), &OwnShapes::default()).unwrap()
    };
    let made = color(gray("t"));
    assert_eq!((made.scene.len(), made.scene.color(1)), (2, LinearRgb::WHITE));
    assert_eq!(made.color_key.unwrap().missing, None);
    assert_eq!(made.columns.last(), Some(&numbers("index", &[0.0, 1.0])));
    let made = color(ColorBy::column("chain"));
    assert_eq!(category_names(&made.color_key.unwrap()), [("A", 1), ("B", 1)]);
}

#[test]
fn a_constant_column_has_the_middle_of_the_map() {
    for (value, is_log) in [(7.0, false), (0.0, false), (-1e300, false), (1e-300, true)] {
        let by = ColorBy { is_log, ..gray("t") };
        let (found, notes) = levels(&by, &[value; 2]);
        assert_eq!(found, [128, 128], "{value}");
        assert!(notes[0].contains("for all spheres, so they all have one color"), "{notes:?}");
    }
}

#[test]
fn a_range_of_equal_percentiles_is_widened() {
    let by = ColorBy { limits: "2%,98%".parse().unwrap(), ..gray("t") };
    let mut values = [1.0; 400];
    values[7] = 1e6;
    let (found, notes) = levels(&by, &values);
    // The middle lies between two levels.
    assert!(matches!([found[0], found[7]], [127 | 128, 255]), "{found:?}");
    assert!(notes[0].starts_with("both ends of the range of `t` are 1, so colors show 0.9 to 1.1"));
    let by = ColorBy { limits: "5,".parse().unwrap(), ..gray("t") };
    let error = by.apply(&spheres(2), &[numbers("t", &[1.0, 2.0])]).unwrap_err();
    assert!(error.to_string().contains("it is 5 to 2; its ends must be finite"), "{error}");
}

#[test]
fn texts_have_colors_in_their_order() {
    let columns = [labels("chain", &["B", "A", "B", " ", "C"])];
    let coloring = ColorBy::column("CHAIN").apply(&spheres(5), &columns).unwrap();
    assert_eq!(category_names(&coloring.key), [("A", 1), ("B", 2), ("C", 1)]);
    // The first colours of Okabe and Ito.
    assert_eq!(coloring.color(1).unwrap().to_srgb8(), [0xe6, 0x9f, 0x00]);
    assert_eq!(coloring.color(0).unwrap().to_srgb8(), [0x56, 0xb4, 0xe9]);
    assert_eq!(coloring.color(3).unwrap().to_srgb8(), MISSING);
    assert_eq!(coloring.key.missing, Some(MISSING));
    let by = ColorBy { is_log: true, ..ColorBy::column("chain") };
    let error = by.apply(&spheres(5), &columns).unwrap_err();
    assert!(error.to_string().contains("applies only to numbers on a color map"), "{error}");
    // Whole numbers are sorted as numbers.
    let columns = [labels("residue", &["10", "9", "-1"])];
    let coloring = ColorBy::column("residue").apply(&spheres(3), &columns).unwrap();
    assert_eq!(category_names(&coloring.key), [("-1", 1), ("9", 1), ("10", 1)]);
}

#[test]
fn a_palette_repeats_with_a_note_and_a_map_does_not() {
    let texts: Vec<String> = (0..20).map(|i| format!("r{i:02}")).collect();
    let columns = [labels("r", &texts.iter().map(String::as_str).collect::<Vec<_>>())];
    let coloring = ColorBy::column("r").apply(&spheres(20), &columns).unwrap();
    assert_eq!(coloring.color(0), coloring.color(8));
    assert!(
        coloring.notes[0].starts_with("`r` has 20 different values and the palette okabe-ito only 8 colors"),
        "{:?}",
        coloring.notes
    );
    let coloring = gray("r").apply(&spheres(20), &columns).unwrap();
    let ends = [0, 19].map(|index| coloring.color(index).unwrap().to_srgb8()[0]);
    assert_eq!(ends, [0, 255]);
    assert!(coloring.notes.is_empty());
}

#[test]
fn few_whole_numbers_are_categories_unless_a_scale_is_asked_for() {
    let columns = [numbers("type", &[3.0, 1.0, 2.0, 1.0])];
    let categories = ColorBy::column("type").apply(&spheres(4), &columns).unwrap();
    assert_eq!(category_names(&categories.key), [("1", 2), ("2", 1), ("3", 1)]);
    for by in [
        gray("type"),
        ColorBy { is_log: true, ..ColorBy::column("type") },
        ColorBy { limits: "0,3".parse().unwrap(), ..ColorBy::column("type") },
        ColorBy::column("index"),
    ] {
        let scale = by.apply(&spheres(4), &columns).unwrap();
        assert!(matches!(scale.key.kind, KeyKind::Scale(_)), "{by:?}");
    }
    let columns = [numbers("t", &[0.5, 1.0])];
    let palette = ColorBy { map: Some("tol-muted".parse().unwrap()), ..ColorBy::column("t") };
    let error = palette.apply(&spheres(2), &columns).unwrap_err();
    assert!(error.to_string().contains("`t` contains 0.5"), "{error}");
}

#[test]
fn columns_are_found_by_name() {
    let spheres = spheres(2);
    let columns = [
        numbers("velo.x", &[3.0, 0.0]),
        numbers("velo.y", &[4.0, 0.0]),
        numbers("velo.z", &[12.0, -2.0]),
        numbers("vx", &[1.0, 2.0]),
        numbers("vy", &[2.0, 2.0]),
        numbers("vz", &[2.0, 1.0]),
        labels("Species", &["C", "N"]),
        numbers("Z", &[6.0, 7.0]),
    ];
    let found = |name| column::numbers(name, &spheres, &columns).map(|(_, v)| v.into_owned());
    assert_eq!(found("|velo|").unwrap(), [13.0, 2.0]);
    assert_eq!(found("|V|").unwrap(), [3.0, 3.0]);
    assert_eq!(found("INDEX").unwrap(), [0.0, 1.0]);
    assert_eq!(found("radius").unwrap(), [1.0, 2.0]);
    assert_eq!(found("y").unwrap(), [10.0, 11.0]);
    // The data's column takes precedence over the coordinate.
    assert_eq!(found("z").unwrap(), [6.0, 7.0]);
    assert_eq!(
        found("speces").unwrap_err().to_string(),
        "there is no column `speces`; did you mean `Species`? the columns are velo.x, velo.y, velo.z, vx, vy, vz, \
         Species, Z, index, radius, x, y, |velo|, |v|"
    );
    assert!(matches!(
        found("velo"),
        Err(ColumnError::Unknown { nearest: Some(nearest), .. }) if nearest == "|velo|"
    ));
    let text = found("species").unwrap_err().to_string();
    assert!(text.contains("holds text, but numbers are needed"), "{text}");
    let short = [numbers("t", &[1.0])];
    let error = column::column("t", &spheres, &short).unwrap_err();
    assert_eq!(error.to_string(), "the column `t` has 1 values, but there are 2 spheres");
}

fn mapped(columns: Vec<Column>, count: usize, mapping: Mapping) -> Result<DataScene, DataError> {
    let mut loaded = Dataset::new(spheres(count));
    loaded.columns = columns;
    Data { mapping, ..Data::of_file("a.xyz") }.scene(loaded, &OwnShapes::default())
}

#[test]
fn a_mapping_makes_a_scene() {
    let columns = vec![numbers("q", &[0.0, 0.5, 1.0, 2.0]), numbers("mass", &[1.0, 2.0, 3.0, 4.0])];
    let mapping = Mapping {
        color: Some(gray("mass")),
        radius: Some(RadiusBy { column: "Mass".to_owned(), factor: 0.5 }),
        opacity: Some("q".to_owned()),
        emission: None,
    };
    let DataScene { scene, notes, .. } = mapped(columns, 4, mapping).unwrap();
    assert!(notes.iter().any(|note| note.contains("outside 0 to 1")));
    assert_eq!([0, 3].map(|id| scene.color(id).to_srgb8()[0]), [0, 255]);
    let radii: Vec<f32> = scene.spheres().iter().map(|sphere| sphere[3]).collect();
    assert_eq!(radii, [0.5, 1.0, 1.5, 2.0]);
    let opacities = [0, 1, 2, 3].map(|id| scene.surface(id).opacity);
    assert_eq!(opacities, [0.0, 128.0 / 255.0, 1.0, 1.0]);
}

#[test]
fn strengths_make_spheres_emit_light() {
    let emission = EmissionBy { column: "l".to_owned(), factor: 2.0 };
    let mapping = Mapping { emission: Some(emission), ..Mapping::default() };
    let made = mapped(vec![numbers("l", &[1.0, 100.0, 0.0])], 3, mapping).unwrap();
    let strength = |id| match made.scene.surface(id).material {
        Material::Emissive { strength } => strength,
        other => panic!("{other:?}"),
    };
    assert_eq!([0, 1, 2].map(strength), [2.0, 200.0, 0.0]);
}

#[test]
fn radii_must_be_positive() {
    let radius = RadiusBy { column: "r".to_owned(), factor: 1.0 };
    let mapping = Mapping { radius: Some(radius), ..Mapping::default() };
    let error = mapped(vec![numbers("r", &[1.0, f64::NAN])], 2, mapping).unwrap_err().to_string();
    assert_eq!(error, "sphere 1 would have the radius NaN; a radius from `r` must be finite and greater than 0");
}

/// Six spheres at x = 0 to 5, with texts and numbers.
fn loaded() -> Dataset {
    let spheres = (0..6).map(|i| [f64::from(i), -1.0, 0.5 * f64::from(i), 1.0]).collect();
    let mut loaded = Dataset::new(SphereArray::F64(spheres));
    let texts = |name: &str, names: &[&str], indices: [u32; 6]| {
        let names = names.iter().map(|name| (*name).to_owned()).collect();
        let values = ColumnValues::Labels(Labels { names, indices: indices.to_vec() });
        Column { name: name.to_owned(), values }
    };
    let numbers =
        |name: &str, values: [f64; 6]| Column { name: name.to_owned(), values: ColumnValues::Numbers(values.to_vec()) };
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
    let (matches, _) = text.parse::<Selection>()?.matches(&loaded)?;
    Ok((0..matches.len()).filter(|index| matches[*index]).collect())
}

#[test]
fn expressions_select() {
    for line in include_str!("selected.txt").lines().filter(|line| !line.starts_with('#')) {
        let (text, expected) = line.split_once(" => ").unwrap();
        let expected: Vec<usize> = expected.split(' ').map(|id| id.parse().unwrap()).collect();
        assert_eq!(selected(text).unwrap(), expected, "{text}");
    }
}

#[test]
fn errors_point_at_their_place() {
    for line in include_str!("not_selected.txt").lines().filter(|line| !line.starts_with('#')) {
        let (character, rest) = line.split_once(' ').unwrap();
        let (text, problem) = rest.split_once(" => ").unwrap();
        let error = selected(text).unwrap_err();
        let SelectError::At { character: found, .. } = &error else { panic!("{text}: {error}") };
        assert_eq!(found.to_string(), character, "{text}: {error}");
        let message = error.to_string();
        assert!(message.contains(problem), "{text}: {message}");
        assert_eq!(message.lines().count(), 1, "{message}");
    }
    let deep = format!("{}x > 1{}", "(".repeat(100_000), ")".repeat(100_000));
    assert!(selected(&deep).unwrap_err().to_string().contains("parentheses lie in more than 100"));
    assert_eq!(selected(&format!("{} x == 1", "not ".repeat(100_001))).unwrap().len(), 5);
    assert_eq!(selected(&format!("{}x == 1", "x == 1 or ".repeat(100_000))).unwrap().len(), 1);
    let nothing = "x == 1\nand x == 2".parse::<Selection>().unwrap().apply(&mut loaded()).unwrap_err().to_string();
    assert_eq!(nothing, "`x == 1 and x == 2` selects none of the 6 spheres");
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
    // Unused texts are gone, and the rest is numbered again.
    let species = loaded.labels("species").unwrap();
    assert_eq!((&species.names[..], &species.indices[..]), (&["O", "Fe", "H"].map(String::from)[..], &[0, 1, 2][..]));
    // The index is the one in the file.
    assert_eq!(loaded.column("index"), Some(&ColumnValues::Numbers(vec![2.0, 3.0, 4.0])));
    for column in &loaded.columns {
        let count = match &column.values {
            ColumnValues::Labels(labels) => labels.indices.len(),
            ColumnValues::Numbers(numbers) => numbers.len(),
        };
        assert_eq!(count, 3, "{}", column.name);
    }
}

#[test]
fn nothing_is_an_error_and_an_unknown_text_a_note() {
    let mut loaded = loaded();
    let before = loaded.clone();
    let apply = |text: &str, loaded: &mut Dataset| text.parse::<Selection>().unwrap().apply(loaded);
    let error = apply("x > 9", &mut loaded).unwrap_err();
    assert_eq!(error.to_string(), "`x > 9` selects none of the 6 spheres");
    let error = apply("species == Q", &mut loaded).unwrap_err();
    assert_eq!(
        error.to_string(),
        "`species == Q` selects none of the 6 spheres; no sphere has the species Q; there are H, O, Fe"
    );
    // NaN makes columns differ from themselves.
    assert_eq!((&loaded.spheres, loaded.columns.len()), (&before.spheres, before.columns.len()));
    let kept = apply("chain != B", &mut loaded).unwrap();
    assert_eq!((kept.kept, kept.of), (5, 6));
    assert_eq!(kept.notes, ["no sphere has the chain B; there are A, x"]);
    let empty = &mut Dataset::new(SphereArray::F32(Vec::new()));
    assert_eq!(apply("x > 9", empty).unwrap().of, 0);
}
