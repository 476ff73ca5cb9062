//! Tests of selections on made data.

use super::{SelectError, Selection};
use crate::load::{Dataset, Options, from_bytes};
use pinhole::scene::sphere_array::SphereArray;

/// A made piece of protein, of DNA and RNA, a part of a heme, an ion, two waters, a sulfate and a sugar.
fn molecule() -> Dataset {
    from_bytes(include_bytes!("molecule.pdb"), "a.pdb", &Options::default()).unwrap()
}

fn selected(data: &Dataset, text: &str) -> Result<(Vec<usize>, Vec<String>), SelectError> {
    let (matches, notes) = text.parse::<Selection>()?.matches(data)?;
    Ok(((0..matches.len()).filter(|index| matches[*index]).collect(), notes))
}

/// Writes indices as ranges.
fn ranges(indices: &[usize]) -> String {
    let runs = indices.chunk_by(|a, b| a + 1 == *b);
    let text = |run: &[usize]| match run {
        [one] => one.to_string(),
        run => format!("{}-{}", run[0], run[run.len() - 1]),
    };
    runs.map(text).collect::<Vec<_>>().join(" ")
}

#[test]
fn the_language_selects() {
    let data = molecule();
    let mut wrong = Vec::new();
    for line in include_str!("selected.txt").lines().filter(|line| !line.starts_with('#') && !line.is_empty()) {
        let (text, expected) = line.split_once(" => ").unwrap_or((line, ""));
        let (expected, note) = expected.split_once(" ; ").unwrap_or((expected, ""));
        let (found, notes) = match selected(&data, text) {
            Ok((found, notes)) => (ranges(&found), notes.join(" | ")),
            Err(error) => (error.to_string(), String::new()),
        };
        if found != expected.trim() || notes != note {
            wrong.push(format!("{text} => {found}{}{notes}", if notes.is_empty() { "" } else { " ; " }));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// Each line has the character at which an expression is wrong, or 0 if it selects nothing; and a part of the message.
#[test]
fn errors_say_what_to_write() {
    let xyz = |text: &str| from_bytes(text.as_bytes(), "a.xyz", &Options::default()).unwrap();
    let types = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\nITEM: ATOMS id type x \
                 y z\n1 1 1 1 1\n2 2 3 3 3\n3 3 5 5 5\n";
    let data = [
        ("pdb", molecule()),
        ("xyz", xyz("3\n\nO 0 0 0\nH 0.96 0 0\nH -0.2 0.9 0\n")),
        ("types", from_bytes(types.as_bytes(), "a.lammpstrj", &Options::default()).unwrap()),
    ];
    let mut wrong = Vec::new();
    for line in include_str!("refused.txt").lines().filter(|line| !line.starts_with('#') && !line.is_empty()) {
        let (start, expected) = line.split_once(" => ").unwrap_or((line, ""));
        let (name, rest) = start.split_once(' ').unwrap();
        let (place, text) = rest.split_once(' ').unwrap();
        let data = &data.iter().find(|(known, _)| *known == name).unwrap().1;
        let error = text.parse::<Selection>().and_then(|selection| selection.apply(&mut data.clone()));
        let (found, message) = match error {
            Ok(kept) => (-1, format!("kept {}", kept.kept)),
            Err(SelectError::At { character, problem, .. }) => (character as i64, problem),
            Err(SelectError::Nothing { hint, .. }) => (0, hint.trim_start_matches("; ").to_owned()),
        };
        if found.to_string() != place || message != expected || message.lines().count() > 1 {
            wrong.push(format!("{name} {found} {text} => {message}"));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// Distances by the grid are those of a search of all pairs and images, in open space and in skewed cells that repeat in
/// some directions; and many spheres in one place do no harm.
#[test]
fn distances_are_those_of_a_search_of_all_pairs() {
    let mut random = fastrand::Rng::with_seed(5);
    let edges = [[9.0, 0.0, 0.0], [3.0, 8.0, 0.0], [-2.0, 1.0, 7.0]];
    let (mut found, mut across) = (0, 0);
    for round in 0..32 {
        let place = |random: &mut fastrand::Rng| [0; 3].map(|_| 30.0 * random.f64() - 12.0);
        let mut points: Vec<[f64; 3]> = (0..120).map(|_| place(&mut random)).collect();
        points.extend([[f64::NAN, 0.0, 0.0], [1.0; 3], [1.0; 3]]);
        let mut data = Dataset::new(SphereArray::F64(points.iter().map(|[x, y, z]| [*x, *y, *z, 1.0]).collect()));
        let repeats = [round & 1, round & 2, round & 4].map(|bit| bit != 0);
        (data.cell, data.is_periodic, data.cell_origin) = (Some(edges), repeats, [0.5, -1.0, 2.0]);
        let steps = repeats.map(|is| if is { -8..=8 } else { 0..=0 });
        let distance = |a: usize, b: usize| {
            let mut least = f64::NAN;
            for x in steps[0].clone() {
                for y in steps[1].clone() {
                    for z in steps[2].clone() {
                        let shift =
                            |k: usize| [x, y, z].iter().zip(edges).map(|(n, e)| f64::from(*n) * e[k]).sum::<f64>();
                        let squared = (0..3).map(|k| (points[a][k] - points[b][k] + shift(k)).powi(2)).sum::<f64>();
                        least = least.min(squared.sqrt());
                    }
                }
            }
            least
        };
        let least = |a: usize| (0..4).map(|b| distance(a, b)).fold(f64::NAN, f64::min);
        let all: Vec<f64> = (0..points.len()).map(least).collect();
        let reach = 0.2 + 8.0 * random.f64();
        let near = |is_wanted: &dyn Fn(usize) -> bool| (0..points.len()).filter(|i| is_wanted(*i)).collect::<Vec<_>>();
        let check = |text: &str, expected: Vec<usize>| assert_eq!(selected(&data, text).unwrap().0, expected, "{text}");
        check(&format!("within {reach} of index 0 to 3"), near(&|i| all[i] <= reach));
        check(&format!("exwithin {reach} of index 0 to 3"), near(&|i| all[i] <= reach && i > 3));
        check(&format!("beyond {reach} of index 0 to 3"), near(&|i| all[i] > reach));
        check(&format!("not within {reach} of index 0 to 3"), near(&|i| all[i] > reach));
        check(&format!("x > 1 and within {reach} of index 0 to 3"), near(&|i| all[i] <= reach && points[i][0] > 1.0));
        let count = random.usize(1..119);
        let mut order: Vec<usize> = (4..points.len()).filter(|i| all[*i].is_finite()).collect();
        order.sort_by(|a, b| all[*a].total_cmp(&all[*b]));
        order.truncate(count);
        order.sort_unstable();
        check(&format!("nearest {count} to index 0 to 3"), order);
        let apart = |a: usize, b: usize| (0..3).map(|k| (points[a][k] - points[b][k]).powi(2)).sum::<f64>().sqrt();
        let open = |a: usize| (0..4).map(|b| apart(a, b)).fold(f64::NAN, f64::min);
        found += near(&|i| all[i] <= reach).len();
        across += near(&|i| all[i] <= reach && open(i) > reach).len();
        data.is_part_of_crystal = true;
        let plain = near(&|i| open(i) <= reach);
        assert_eq!(selected(&data, &format!("within {reach} of index 0 to 3")).unwrap().0, plain);
        if repeats.contains(&true) {
            let text = format!("pbwithin {reach} of index 0 to 3");
            assert_eq!(selected(&data, &text).unwrap().0, near(&|i| all[i] <= reach));
        }
    }
    assert!(found > 500 && across > 200, "{found}, {across}");
    let crowd = Dataset::new(SphereArray::F64(vec![[1.0, 1.0, 1.0, 1.0]; 5000]));
    assert_eq!(selected(&crowd, "within 0 of index 7").unwrap().0.len(), 5000);
    assert_eq!(selected(&crowd, "nearest 2 to index 0").unwrap().0, [1, 2]);
    let far = Dataset::new(SphereArray::F64([0.0, 1e90, -1e90, 1e300].map(|x| [x, 0.0, 0.0, 1.0]).to_vec()));
    assert_eq!(selected(&far, "within 1e-9 of all").unwrap().0, [0, 1, 2]);
    assert_eq!(selected(&far, "within 1e300 of index 0").unwrap().0, [0, 1, 2]);
    let mut small = Dataset::new(SphereArray::F64([0.0, 0.3, 0.5].map(|x| [x, 0.0, 0.0, 1.0]).to_vec()));
    small.cell = Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    assert_eq!(selected(&small, "within 1000 of index 0").unwrap().0, [0, 1, 2]);
    small.is_periodic = [true, true, false];
    assert!(selected(&small, "within 1e6 of index 0").unwrap_err().to_string().contains("too many images"));
}

/// Words of the language in any order are read or refused, in one line and without a crash.
#[test]
fn any_words_are_read_or_refused() {
    let (data, mut random) = (molecule(), fastrand::Rng::with_seed(3));
    let lines = include_str!("selected.txt").lines();
    let whole: Vec<&str> = lines.filter_map(|line| line.split(" => ").next()).collect();
    let words: Vec<&str> = whole
        .iter()
        .flat_map(|text| text.split(' '))
        .chain([
            "(", ")", "[", "]", ",", "|", "'", "\"", "`", "Å", "-", "+", "*", "=~", "1e999", "nm", "to", "of", "as",
            "\n",
        ])
        .collect();
    let mut read = 0;
    for _ in 0..20_000 {
        let count = random.usize(1..9);
        let mut text = String::new();
        for _ in 0..count {
            text += if random.u8(..) < 60 {
                whole[random.usize(..whole.len())]
            } else {
                words[random.usize(..words.len())]
            };
            text += if random.u8(..) < 220 { " " } else { "" };
        }
        match selected(&data, &text) {
            Ok((_, notes)) => {
                read += 1;
                assert!(notes.iter().all(|note| note.lines().count() <= 1), "{text}: {notes:?}");
            }
            Err(error) => assert_eq!(error.to_string().lines().count(), 1, "{text}: {error}"),
        }
    }
    assert!(read > 1000, "{read}");
}

/// Nesting of every kind has a limit, and what is long is not deep.
#[test]
fn nesting_is_limited() {
    let data = molecule();
    let deep = |start: &str, middle: &str, end: &str| format!("{}{middle}{}", start.repeat(200), end.repeat(200));
    for text in [
        deep("(", "name CA", ")"),
        deep("byres ", "name CA", ""),
        deep("within 1 of ", "name CA", ""),
        deep("not (", "name CA", ")"),
        deep("", "name CA", " around 1"),
        deep("abs(", "x", ")") + " > 1",
        deep("2^", "x > 1", ""),
        "(".repeat(100_000),
    ] {
        assert!(selected(&data, &text).is_err(), "{}", &text[..40]);
    }
    for text in [
        deep("not ", "name CA", ""),
        deep("", "name CA", " CB"),
        deep("name CA or ", "name CB", ""),
        deep("name CA ", "", ""),
        deep("x + ", "x > 1", ""),
        deep("- ", "x < 1", ""),
        deep("x < ", "x", " < x"),
    ] {
        assert!(selected(&data, &text).is_ok(), "{text}");
    }
}

/// Columns whose names have signs of arithmetic need no backquotes in comparisons.
#[test]
fn columns_of_the_file_come_before_arithmetic() {
    let csv = "x,y,z,my-column,a*b,c_1[2]\n0,0,0,1,2,3\n1,0,0,4,5,6\n";
    let data = from_bytes(csv.as_bytes(), "a.csv", &Options::default()).unwrap();
    for text in ["my-column > 1", "1 < my-column", "a*b == 5", "c_1[2] > 4", "c_1[2] - `my-column` == 2 and x > 0"] {
        assert_eq!(selected(&data, text).unwrap().0, [1], "{text}");
    }
}

#[test]
fn molecules_of_water_are_found_without_residues() {
    let text = "8\n\nO 0 0 0\nH 0.96 0 0\nH -0.2 0.9 0\nO 9 0 0\nO 10.2 0 0\nC 20 0 0\nO 21.2 0 0\nH 30 0 0\n";
    let data = from_bytes(text.as_bytes(), "a.xyz", &Options::default()).unwrap();
    assert_eq!(selected(&data, "water").unwrap().0, [0, 1, 2]);
    assert_eq!(selected(&data, "fragment 1").unwrap().0, [3, 4]);
    assert_eq!(selected(&data, "hydrogen and not water").unwrap().0, [7]);
}
