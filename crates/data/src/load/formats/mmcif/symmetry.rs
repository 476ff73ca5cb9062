//! The symmetry of crystals: operators of CIF files, and the atoms of the cell that follow from those that a file lists.

use glam::{DMat3, DVec3};

use super::tokens::{Place, Token, Tokens, is_unknown};
use crate::load::error::LoadError;
use crate::load::{Column, ColumnValues, Dataset};
use pinhole::internals::text::{one_line, shortened};

/// The names of the item with an operator as text, in lower case.
const OPERATORS: [&[u8]; 4] = [
    b"_symmetry_equiv_pos_as_xyz",
    b"_symmetry_equiv.pos_as_xyz",
    b"_space_group_symop_operation_xyz",
    b"_space_group_symop.operation_xyz",
];

/// The names of the item with the symbol or the number of the space group, in lower case. Later ones are preferred.
const GROUPS: [&[u8]; 12] = [
    b"_symmetry_int_tables_number",
    b"_space_group_it_number",
    b"_symmetry.int_tables_number",
    b"_space_group.it_number",
    b"_symmetry_space_group_name_hall",
    b"_space_group_name_hall",
    b"_symmetry.space_group_name_hall",
    b"_space_group.name_hall",
    b"_symmetry_space_group_name_h-m",
    b"_space_group_name_h-m_alt",
    b"_symmetry.space_group_name_h-m",
    b"_space_group.name_h-m_alt",
];

/// Images of an atom that are closer than this length, in Å, are one: the atom is on an element of symmetry, and its
/// position is rounded in the file.
const SAME: f64 = 0.05;

/// The most atoms in a cell.
const MOST: usize = 10_000_000;

/// The most operators. No space group has more than 192 in its usual cell, and images of an atom are compared in pairs.
const MOST_OPERATORS: usize = 1000;

/// An operator on fractions of the edges of a cell: a matrix and a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Operator {
    matrix: DMat3,
    shift: DVec3,
}

/// The symmetry that a file states.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Symmetry {
    /// Different operators, with shifts from 0 to 1.
    operators: Vec<Operator>,
    /// The symbol of the space group, or its number, with its place in the list of names.
    group: Option<(usize, String)>,
    /// The first operator that is none. It is an error only if the block of the atoms has it.
    wrong: Option<LoadError>,
}

impl Symmetry {
    /// Adds what a text says that begins after some lines. Another block ends it if `to_block` is true; otherwise what
    /// stands before the block is forgotten.
    pub(super) fn add(&mut self, text: &[u8], lines_before: usize, to_block: bool) -> Result<(), LoadError> {
        let mut tokens = Tokens::new(text, lines_before);
        // The names of a loop, or the one before a value, and how many values followed.
        let (mut names, mut values, mut is_loop) = (Vec::new(), 0, false);
        loop {
            let place = tokens.place();
            let Some(token) = tokens.next_at(place)? else { return Ok(()) };
            if !matches!(token, Token::Value(_)) && (values > 0 || !is_loop || !matches!(token, Token::Name(_))) {
                (names, values, is_loop) = (Vec::new(), 0, matches!(token, Token::Loop));
            }
            match token {
                Token::Name(name) => names.push(name.to_ascii_lowercase()),
                Token::Value(value) => {
                    if let Some(name) = names.get(values % names.len().max(1))
                        && !is_unknown(value)
                    {
                        self.take(name, value, place);
                    }
                    values += 1;
                }
                Token::Data if to_block => return Ok(()),
                Token::Data => *self = Self::default(),
                Token::Loop | Token::Other => {}
            }
        }
    }

    fn take(&mut self, name: &[u8], value: &[u8], place: Place) {
        let text = String::from_utf8_lossy(value);
        // After an error, further operators do not count.
        if OPERATORS.contains(&name) && self.wrong.is_none() {
            let text = one_line(&text);
            let found = Operator::of(&text).map(|Operator { matrix, shift }| {
                // Files list some operators twice, under the old and the new name.
                Operator { matrix, shift: shift - shift.floor() }
            });
            let wrong = |message: String| Some(LoadError::at(place.of_error(), message));
            match found {
                Some(operator) if self.operators.contains(&operator) => {}
                Some(_) if self.operators.len() == MOST_OPERATORS => {
                    self.wrong = wrong(format!(
                        "there are more than {MOST_OPERATORS} operators of symmetry, but no space group has more than 192; \
                         remove those that are too many"
                    ));
                }
                Some(operator) => self.operators.push(operator),
                None => {
                    self.wrong = wrong(format!(
                        "`{}` is no operator of a symmetry; write one such as -x,y+1/2,z, in quotes if it has blanks",
                        shortened(&text)
                    ));
                }
            }
        } else if let Some(rank) = GROUPS.iter().position(|known| *known == name)
            && self.group.as_ref().is_none_or(|(former, _)| *former <= rank)
        {
            self.group = Some((rank, text.split_whitespace().collect::<Vec<_>>().join(" ")));
        }
    }

    /// Adds the atoms of the cell that follow from those that are there. If there are several operators, all atoms are
    /// moved into the cell, and the column `symmetry` has the numbers of their operators, counted from 1.
    pub(super) fn fill(&self, data: &mut Dataset) -> Result<(), LoadError> {
        if let Some(wrong) = &self.wrong {
            return Err(wrong.clone());
        }
        let Some(cell) = data.cell.map(|edges| DMat3::from_cols_array_2d(&edges)) else { return Ok(()) };
        let group = self.group.as_ref().map(|(_, group)| group.as_str());
        if self.operators.is_empty() {
            let group = group.unwrap_or_default();
            if matches!(group.replace(' ', "").as_str(), "P1" | "p1" | "1") {
                return Ok(());
            }
            let what = match group {
                "" => "the file says nothing of a symmetry".to_owned(),
                group => {
                    format!("the file names the space group {} but lists no operators", shortened(&one_line(group)))
                }
            };
            data.is_part_of_crystal = true;
            data.notes.push(format!(
                "{what}, so only the atoms that it lists are there; add a loop_ of _space_group_symop_operation_xyz"
            ));
            return Ok(());
        }
        if self.operators == [Operator { matrix: DMat3::IDENTITY, shift: DVec3::ZERO }] {
            return Ok(());
        }
        let to_fractions = cell.inverse();
        if !to_fractions.is_finite() {
            return Ok(());
        }
        let count = data.spheres.len();
        if count.saturating_mul(self.operators.len()) > MOST {
            let operators = self.operators.len();
            return Err(LoadError::new(format!(
                "{operators} operators of {count} atoms make more than {MOST} atoms; list fewer atoms or operators"
            )));
        }
        let mut of: Vec<u32> = Vec::new();
        let mut numbers: Vec<f64> = Vec::new();
        let mut centers: Vec<DVec3> = Vec::new();
        let fractions: Vec<DVec3> = (0..count).map(|index| to_fractions * data.center(index)).collect();
        // The images of each atom that were found.
        let mut images: Vec<Vec<DVec3>> = vec![Vec::new(); count];
        for (operator, number) in self.operators.iter().zip(1_u32..) {
            for (index, fraction) in fractions.iter().enumerate() {
                let image = operator.matrix * *fraction + operator.shift;
                // What is rounded at a face is at the face where the cell starts.
                let image = image - (image + 1e-6).floor();
                let is_same = |other: &DVec3| {
                    let apart = image - *other;
                    (cell * (apart - apart.round())).length() < SAME
                };
                if !images[index].iter().any(is_same) {
                    images[index].push(image);
                    of.push(index as u32);
                    numbers.push(f64::from(number));
                    centers.push(cell * image);
                }
            }
        }
        data.repeat(&of);
        data.move_centers(|index, center| centers.get(index).copied().unwrap_or(center));
        data.columns.push(Column { name: "symmetry".to_owned(), values: ColumnValues::Numbers(numbers) });
        let name = group.map_or(String::new(), |group| format!(" of {}", shortened(&one_line(group))));
        data.notes.push(format!(
            "the {} operators{name} make {} atoms of the {count} that the file lists",
            self.operators.len(),
            data.spheres.len()
        ));
        Ok(())
    }
}

impl Operator {
    /// Reads an operator such as `-x,y+1/2,z`; `None` if it is none.
    fn of(text: &str) -> Option<Self> {
        let mut rows = [DVec3::ZERO; 3];
        let mut shift = [0.0; 3];
        let mut parts = text.split(',');
        for (row, shift) in rows.iter_mut().zip(&mut shift) {
            (*row, *shift) = row_of(parts.next()?)?;
        }
        let operator = Self { matrix: DMat3::from_cols(rows[0], rows[1], rows[2]).transpose(), shift: shift.into() };
        // A symmetry keeps volumes.
        let is_regular = (operator.matrix.determinant().abs() - 1.0).abs() < 1e-6;
        (parts.next().is_none() && is_regular).then_some(operator)
    }
}

/// Reads the sum of an operator for one edge: the factors of x, y and z, and the shift.
fn row_of(text: &str) -> Option<(DVec3, f64)> {
    let plain: String = text.chars().filter(|c| !c.is_whitespace()).collect::<String>().to_lowercase();
    let (mut row, mut shift) = (DVec3::ZERO, 0.0);
    let mut rest = plain.as_str();
    if rest.is_empty() {
        return None;
    }
    while !rest.is_empty() {
        let sign = if rest.starts_with('-') { -1.0 } else { 1.0 };
        rest = rest.strip_prefix(['+', '-']).unwrap_or(rest);
        let end = rest.find(['+', '-']).unwrap_or(rest.len());
        let (term, after) = rest.split_at(end);
        rest = after;
        match term {
            "x" => row.x += sign,
            "y" => row.y += sign,
            "z" => row.z += sign,
            term => {
                let (over, under) = term.split_once('/').unwrap_or((term, "1"));
                let is_plain = |text: &str| text.chars().all(|c| c.is_ascii_digit() || c == '.');
                let [over, under] = [over, under].map(|text| text.parse::<f64>().ok().filter(|_| is_plain(text)));
                shift += sign * over? / under.filter(|under| *under > 0.0)?;
            }
        }
    }
    (shift.is_finite() && shift.abs() < 1e3).then_some((row, shift))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::{self, Options};

    #[test]
    fn operators_are_read_as_files_write_them() {
        let at = DVec3::new(0.1, 0.2, 0.3);
        for (text, image) in [
            ("x,y,z", [0.1, 0.2, 0.3]),
            ("-Y+1/2, X , z-0.25", [0.3, 0.1, 0.05]),
            ("1/2+x,1/2-y,-z", [0.6, 0.3, -0.3]),
            ("x-y,x,+z+5/6", [-0.1, 0.1, 0.3 + 5.0 / 6.0]),
        ] {
            let operator = Operator::of(text).unwrap();
            let found = operator.matrix * at + operator.shift;
            assert!((found - DVec3::from(image)).length() < 1e-12, "{text}: {found}");
        }
        for text in
            ["", "x,y", "x,y,z,x", "x,x,z", "x,y,w", "x,y,z+1/0", "x,y,z+1/x", "x,,z", "x,y,z+", "2x,y,z", "x,y,z+1e9"]
        {
            assert_eq!(Operator::of(text), None, "{text}");
        }
    }

    const RUTILE: &str = "_cell_length_a 4.594(1)\n_cell_length_b 4.594\n_cell_length_c 2.958\n_cell_angle_alpha 90\n\
        _cell_angle_beta 90\n_cell_angle_gamma 90\n_symmetry_space_group_name_H-M 'P 42/m n m'\n";
    const RUTILE_OPERATORS: [&str; 16] = [
        "x,y,z",
        "-x,-y,z",
        "-y+1/2,x+1/2,z+1/2",
        "y+1/2,-x+1/2,z+1/2",
        "-x+1/2,y+1/2,-z+1/2",
        "x+1/2,-y+1/2,-z+1/2",
        "y,x,-z",
        "-y,-x,-z",
        "-x,-y,-z",
        "x,y,-z",
        "y+1/2,-x+1/2,-z+1/2",
        "-y+1/2,x+1/2,-z+1/2",
        "x+1/2,-y+1/2,z+1/2",
        "-x+1/2,y+1/2,z+1/2",
        "-y,-x,z",
        "y,x,z",
    ];
    const RUTILE_ATOMS: &str = "loop_\n_atom_site_label\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\n\
        Ti1 0 0 0\nO1 0.305 0.305 0\n";

    fn list(operators: &[impl AsRef<str>]) -> String {
        let rows: String = operators.iter().map(|text| format!("'{}'\n", text.as_ref())).collect();
        format!("loop_\n_symmetry_equiv_pos_as_xyz\n{rows}\n")
    }

    fn read(text: &str) -> Result<Dataset, LoadError> {
        load::from_bytes(format!("data_a\n{text}").as_bytes(), "a.cif", &Options::default())
    }

    /// The number of atoms of each element.
    fn counts(data: &Dataset) -> Vec<(String, usize)> {
        let labels = data.labels("species").unwrap();
        let count = |index: u32| labels.indices.iter().filter(|other| **other == index).count();
        labels.names.iter().zip(0..).map(|(name, index)| (name.clone(), count(index))).collect()
    }

    #[test]
    fn operators_fill_the_cell_wherever_they_stand() {
        let operators = list(&RUTILE_OPERATORS);
        for text in [format!("{RUTILE}{operators}{RUTILE_ATOMS}"), format!("{RUTILE}{RUTILE_ATOMS}{operators}")] {
            let data = read(&text).unwrap();
            assert_eq!(counts(&data), [("Ti".to_owned(), 2), ("O".to_owned(), 4)]);
            assert_eq!(data.colors.as_ref().unwrap().len(), 6);
            assert_eq!(data.column("symmetry"), Some(&ColumnValues::Numbers(vec![1.0, 1.0, 2.0, 3.0, 3.0, 4.0])));
            let middle = data.center(3);
            assert!((middle - DVec3::new(2.297, 2.297, 1.479)).length() < 1e-6, "{middle}");
            assert_eq!(data.notes, ["the 16 operators of P 42/m n m make 6 atoms of the 2 that the file lists"]);
            assert!(!data.is_part_of_crystal);
        }
    }

    #[test]
    fn centred_and_hexagonal_cells_are_filled() {
        // All signs and orders of three axes, with the four centrings of F.
        let mut operators = Vec::new();
        for shift in ["", "+0,+1/2,+1/2", "+1/2,+0,+1/2", "+1/2,+1/2,+0"] {
            let shifts: Vec<&str> = if shift.is_empty() { vec![""; 3] } else { shift.split(',').collect() };
            for axes in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
                for signs in 0..8 {
                    let part = |k: usize| {
                        let sign = if signs >> k & 1 == 1 { "-" } else { "" };
                        format!("{sign}{}{}", ["x", "y", "z"][axes[k]], shifts[k])
                    };
                    operators.push(format!("{},{},{}", part(0), part(1), part(2)));
                }
            }
        }
        let salt = RUTILE.replace("4.594(1)", "5.64").replace("4.594", "5.64").replace("2.958", "5.64");
        let atoms = RUTILE_ATOMS.replace("Ti1", "Na1").replace("O1 0.305 0.305 0", "Cl1 0.5 0.5 0.5");
        let data = read(&format!("{salt}{}{atoms}", list(&operators))).unwrap();
        assert_eq!(counts(&data), [("Na".to_owned(), 4), ("Cl".to_owned(), 4)]);
        assert_eq!(operators.len(), 192);

        let quartz = RUTILE.replace("4.594(1)", "4.913").replace("4.594", "4.913").replace("2.958", "5.405");
        let quartz = quartz.replace("gamma 90", "gamma 120").replace("P 42/m n m", "P 32 2 1");
        let operators = ["x,y,z", "-y,x-y,z+2/3", "-x+y,-x,z+1/3", "y,x,-z", "x-y,-y,-z+1/3", "-x,-x+y,-z+2/3"];
        let atoms =
            RUTILE_ATOMS.replace("Ti1 0 0 0", "Si1 0.4697 0 0.66667").replace("0.305 0.305 0", "0.4133 0.2672 0.78547");
        let data = read(&format!("{quartz}{}{atoms}", list(&operators))).unwrap();
        assert_eq!(counts(&data), [("Si".to_owned(), 3), ("O".to_owned(), 6)]);
        // Each silicon has four oxygens at 1.6 Å.
        let cell = DMat3::from_cols_array_2d(&data.cell.unwrap());
        let labels = data.labels("species").unwrap();
        for one in (0..9).filter(|index| labels.indices[*index] == 0) {
            let near = (0..9).filter(|other| labels.indices[*other] == 1).flat_map(|other| {
                let apart = data.center(other) - data.center(one);
                (0..27).map(move |k| {
                    (apart + cell * DVec3::new((k % 3) as f64 - 1.0, (k / 3 % 3) as f64 - 1.0, (k / 9) as f64 - 1.0))
                        .length()
                })
            });
            assert_eq!(near.filter(|length| (1.55..1.67).contains(length)).count(), 4);
        }
    }

    #[test]
    fn what_a_file_says_of_its_symmetry_is_said_again() {
        let named = |group: &str| format!("{}{RUTILE_ATOMS}", RUTILE.replace("P 42/m n m", group));
        let note = |text: &str| read(text).unwrap().notes.join("; ");
        assert_eq!(note(&named("P 1")), "");
        assert_eq!(note(&format!("{}{}", list(&["x, y, z"]), named("P -1"))), "");
        let remedy = "so only the atoms that it lists are there; add a loop_ of _space_group_symop_operation_xyz";
        assert_eq!(
            note(&named("P -1")),
            format!("the file names the space group P -1 but lists no operators, {remedy}")
        );
        assert_eq!(note(&named("?")), format!("the file says nothing of a symmetry, {remedy}"));
        let wrong = format!("{}{}", list(&["x,y,z", "x,y,2"]), named("P -1"));
        let error = read(&wrong).unwrap_err().to_string();
        assert_eq!(
            error,
            "line 5, column 1: `x,y,2` is no operator of a symmetry; write one such as -x,y+1/2,z, in quotes if it has blanks"
        );
    }

    #[test]
    fn blocks_have_their_own_symmetry() {
        let remarks = "_remark\n;\ndata_old\na \"quote that does not end\n;\n";
        let block =
            |keyword: &str, first: &str, last: &str| format!("{keyword}\n{first}\n{RUTILE}{RUTILE_ATOMS}{last}");
        let two = list(&["x,y,z", "-x,-y,z+1/2"]);
        // What stands in one block, also what is wrong there, is nothing to another.
        let wrong = list(&["x,y,z", "x,y"]);
        for (text, atoms) in [
            (block("data_a", &list(&["x,y,z"]), "") + &block("data_b", &two, ""), [2, 4]),
            (block("DATA_a", "", &two) + &block("DATA_b", &list(&["x,y,z"]), ""), [4, 2]),
            (block("data_a", &two, remarks) + &block("data_b", remarks, &two), [4, 4]),
            (block("data_a", &two, "") + &block("data_b", &wrong, ""), [4, 0]),
            (block("data_a", "", &wrong) + &block("data_b", &two, ""), [0, 4]),
        ] {
            for (frame, expected) in atoms.into_iter().enumerate() {
                let options = Options::default().with_frame(frame);
                let found = load::from_bytes(text.as_bytes(), "a.cif", &options).map(|data| data.spheres.len());
                assert_eq!(found.clone().unwrap_or(0), expected, "frame {frame} of {text}: {found:?}");
            }
        }
    }

    #[test]
    fn repeated_and_unknown_operators_add_nothing() {
        let note = |text: &str| read(&format!("{RUTILE}{text}{RUTILE_ATOMS}")).map(|data| data.notes.join("; "));
        let one = list(&["x,y,z"]);
        assert_eq!(
            note(&format!("{one}{}", one.replace("_symmetry_equiv_pos_as", "_space_group_symop_operation"))),
            note(&one)
        );
        assert_eq!(note(&list(&["x,y,z", "x+1,y,z-1"])), Ok(String::new()));
        let unknown = "_symmetry_equiv_pos_as_xyz ?\n_symmetry_Int_Tables_number 136\n";
        assert!(note(unknown).unwrap().starts_with("the file names the space group P 42/m n m but"));
        let many: Vec<String> = (0..=MOST_OPERATORS).map(|number| format!("x+{number}/2000,y,z")).collect();
        let error = note(&list(&many)).unwrap_err().to_string();
        assert!(error.starts_with("line 1011, column 1: there are more than 1000 operators"), "{error}");
        let error = note("loop_\n_symmetry_equiv_pos_as_xyz\nx, y, z\n").unwrap_err().to_string();
        assert!(error.contains("`x,` is no operator"), "{error}");
    }

    /// Texts of the letters of operators in any order.
    #[test]
    fn any_text_is_an_operator_or_none() {
        let mut random = fastrand::Rng::with_seed(5);
        let letters: Vec<char> = "xyzXYZ+-/.,,0123456789 \n\u{130}\u{df}".chars().collect();
        for _ in 0..100_000 {
            let text: String = (0..random.usize(..24)).filter_map(|_| random.choice(&letters)).collect();
            if let Some(Operator { matrix, shift }) = Operator::of(&text) {
                assert!(matrix.is_finite() && shift.is_finite(), "{text}");
            }
        }
    }
}
