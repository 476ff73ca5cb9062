//! Tables that are made here.

use crate::load::{self, ColumnValues, Loaded, Options};
use crate::scene::sphere_array::SphereArray;

fn read(text: &str, options: &Options) -> Result<Loaded, String> {
    load::from_bytes(text.as_bytes(), "a.csv", options).map_err(|error| error.to_string())
}

fn loaded(text: &str) -> Loaded {
    read(text, &Options::default()).unwrap()
}

fn spheres(loaded: &Loaded) -> &[[f64; 4]] {
    match &loaded.spheres {
        SphereArray::F64(spheres) => spheres,
        SphereArray::F32(_) => panic!("f32"),
    }
}

const ROWS: [[f64; 4]; 2] = [[1.0, -2.5, 3.0, 0.5], [4.0, 5.0, 0.006, 2.0]];

#[test]
fn separators_headers_and_comments() {
    let text = "x,y,z,radius\n1,-2.5,3,0.5\n4,5,6e-3,2\n";
    for text in [
        text.to_owned(),
        text.replace(',', "\t"),
        text.replace(',', ";"),
        text.replace(',', "  "),
        text.replace(',', " , "),
        text.replace('\n', "\r\n"),
        format!("\u{feff}{text}"),
        text.trim_end().to_owned(),
        format!("# a comment\n\n{}", text.replace('\n', "\n\n# another\n")),
        text.replace("x,", "# made by me\n#x,"),
        text.replace("x,y,z,radius", "# x y z radius"),
        text.replace("x,y,z,radius", "\"X\",\"Y\", Z ,Radius"),
        text.replace("2.5", "\"2.5\"").replace("-\"", "\"-"),
    ] {
        assert_eq!(spheres(&loaded(&text)), ROWS, "{text:?}");
    }
    let options = Options::default().with_columns(["x", "y", "z", "radius"]);
    for separator in [",", " ", "\t"] {
        let bare = text.replace("x,y,z,radius\n", "").replace(',', separator);
        assert_eq!(spheres(&read(&bare, &options).unwrap()), ROWS);
        // Numbers alone are recognised by their content, and names are asked for.
        let named = load::from_bytes(bare.as_bytes(), "", &options).unwrap();
        assert_eq!(spheres(&named), ROWS);
    }
    assert_eq!(
        spheres(&load::from_bytes(text.as_bytes(), "a", &Options::default()).unwrap()),
        ROWS
    );
}

#[test]
fn texts_and_missing_values() {
    let found = loaded(
        "name,x,y,z,radius,element,q,note,id\n\"a, b\",1,2,3,1,O,,\"two\nlines\",1\nc,4,5,6,1,H,NA,,A2\n",
    );
    assert_eq!(found.labels("name").unwrap().names, ["a, b", "c"]);
    assert_eq!(found.labels("note").unwrap().names, ["two\nlines", ""]);
    assert_eq!(found.labels("id").unwrap().names, ["1", "A2"]);
    assert_eq!(found.labels("species").unwrap().names, ["O", "H"]);
    let Some(ColumnValues::Numbers(q)) = found.column("q") else { panic!("no numbers") };
    assert!(q.iter().all(|q| q.is_nan()));
    // Atomic numbers are elements too.
    assert_eq!(spheres(&loaded("x y z element\n0 0 0 8\n"))[0][3], 1.5);
}

#[test]
fn no_input_panics() {
    let text = "# c\nname,x,y,z,q\n\"a\",1,2,3,\nb,4,5,6,x\n";
    let mut random = fastrand::Rng::with_seed(1);
    for _ in 0..5000 {
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..random.usize(1..6) {
            let at = random.usize(..bytes.len());
            match random.u8(..3) {
                0 => bytes[at] = random.u8(..),
                1 => drop(bytes.remove(at)),
                _ => bytes.insert(at, *random.choice(b"\n\t \"';,#.\xff\0").unwrap()),
            }
        }
        drop(load::from_bytes(&bytes, "a.csv", &Options::default()));
        drop(load::from_bytes(&bytes, "", &Options::default()));
    }
}
