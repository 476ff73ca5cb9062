//! Names of columns, and what they make of a table.

use super::*;

fn table(columns: &[(&str, &[f64])]) -> Table {
    let columns =
        columns.iter().map(|(name, numbers)| TableColumn::numbers(*name, numbers.to_vec()));
    Table { columns: columns.collect() }
}

fn labels(name: &str, names: &[&str], indices: &[u32]) -> TableColumn {
    let names = names.iter().map(ToString::to_string).collect();
    TableColumn::labels(name, Labels { names, indices: indices.to_vec() })
}

fn load(table: Table) -> Loaded {
    table.into_loaded(&Options::default()).unwrap()
}

#[test]
fn names_say_what_columns_are() {
    let loaded = load(table(&[
        ("Radius", &[0.5, 2.0]),
        ("position[z]", &[5.0, 6.0]),
        ("Position_X", &[1.0, 2.0]),
        ("Position Y", &[3.0, 4.0]),
        ("red", &[255.0, 0.0]),
        ("green", &[0.0, 255.0]),
        ("blue", &[0.0, 128.0]),
        ("Transparency", &[0.0, 0.25]),
        ("vx", &[7.0, 8.0]),
    ]));
    assert_eq!(loaded.spheres, SphereArray::F64(vec![[1.0, 3.0, 5.0, 0.5], [2.0, 4.0, 6.0, 2.0]]));
    let colors: Vec<_> = loaded.colors.unwrap().iter().map(|color| color.to_srgb8()).collect();
    assert_eq!(colors, [[255, 0, 0], [0, 255, 128]]);
    assert_eq!(loaded.opacities, Some(vec![1.0, 0.75]));
    assert_eq!(
        loaded.columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>(),
        ["vx"]
    );
    assert_eq!(loaded.notes, Vec::<String>::new());
}

#[test]
fn diameters_are_halved_and_elements_have_radii_and_colors() {
    let loaded = load(table(&[("x", &[0.0]), ("y", &[0.0]), ("z", &[0.0]), ("diameter", &[3.0])]));
    assert_eq!(loaded.spheres, SphereArray::F64(vec![[0.0, 0.0, 0.0, 1.5]]));
    let mut atoms = table(&[("x", &[0.0, 9.0]), ("y", &[0.0, 0.0]), ("z", &[0.0, 0.0])]);
    atoms.columns.push(labels("element", &["O", "bead"], &[0, 1]));
    let loaded = load(atoms);
    assert_eq!(loaded.spheres, SphereArray::F64(vec![[0.0, 0.0, 0.0, 1.5], [9.0, 0.0, 0.0, 2.0]]));
    assert_eq!(loaded.colors.unwrap()[0].to_srgb8(), [255, 13, 13]);
    assert!(loaded.notes[0].contains("not chemical elements: bead"), "{:?}", loaded.notes);
    assert_eq!(loaded.columns[0].name, "species");
    // Names that are no elements at all say nothing about radii and colours.
    let mut kinds = table(&[("x", &[0.0, 9.0]), ("y", &[0.0, 0.0]), ("z", &[0.0, 0.0])]);
    kinds.columns.push(labels("element", &["A1x", "Q"], &[0, 1]));
    let loaded = load(kinds);
    assert_eq!((loaded.colors, loaded.notes.len()), (None, 1));
    assert_eq!(
        loaded.spheres.with_color(LinearRgb::WHITE).map(|s| s.radius).collect::<Vec<_>>(),
        [4.5; 2]
    );
}

#[test]
fn what_is_not_used_is_said() {
    let loaded = load(table(&[
        ("x", &[0.0, 1.0]),
        ("y", &[0.0, 1.0]),
        ("z", &[0.0, 1.0]),
        ("red", &[-1.0, 0.5]),
        ("green", &[0.0, 0.5]),
        ("blue", &[0.0, 0.5]),
        ("alpha", &[7.0, 300.0]),
        ("inner_radius", &[1.0, 1.0]),
    ]));
    assert_eq!((loaded.colors, loaded.opacities), (None, None));
    let notes = loaded.notes.join("\n");
    for wanted in [
        "red, green, blue are not used as colors",
        "alpha is not used as opacity",
        "--radius-by inner_radius",
        "the radius 0.866",
    ] {
        assert!(notes.contains(wanted), "{notes}");
    }
    assert_eq!(loaded.columns.len(), 5);
}

#[cfg(feature = "scene-file")]
#[test]
fn colors_may_have_names() {
    let mut named = table(&[
        ("x", &[0.0, 9.0]),
        ("y", &[0.0, 0.0]),
        ("z", &[0.0, 0.0]),
        ("radius", &[1.0, 1.0]),
    ]);
    named.columns.push(labels("color", &["tomato", "#0f0"], &[1, 0]));
    let colors: Vec<_> = load(named).colors.unwrap().iter().map(|color| color.to_srgb8()).collect();
    assert_eq!(colors, [[0, 255, 0], [255, 99, 71]]);
}
