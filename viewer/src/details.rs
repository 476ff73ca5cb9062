//! Details of a picked shape.

use std::sync::Arc;

use pinhole::glam::DVec3;
use pinhole::scene::Scene;
use pinhole_data::load::{Column, ColumnValues};

/// A picked shape, with its values.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Details {
    /// Index of the shape in the scene.
    pub(crate) id: u32,
    pub(crate) center: DVec3,
    /// The radius; of a cone, the larger one.
    pub(crate) radius: f64,
    /// Whether the shape is none of the data's spheres, such as a bond.
    pub(crate) is_added: bool,
    pub(crate) rows: Vec<Row>,
}

/// A value of a sphere.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    pub(crate) name: String,
    pub(crate) value: String,
    /// The expression that selects spheres with this value, if there is one.
    pub(crate) select: Option<String>,
}

impl Details {
    /// Describes a shape; `None` if the scene has no such shape.
    pub(crate) fn of(scene: &Arc<Scene>, columns: &[Column], id: u32) -> Option<Self> {
        let index = id as usize;
        let wide = |[x, y, z]: [f32; 3]| DVec3::new(x.into(), y.into(), z.into());
        let (center, radius) = match scene.spheres().get(index) {
            Some(&[x, y, z, radius]) => (wide([x, y, z]), radius),
            None => {
                let cone = scene.cones().get(index - scene.len())?;
                (0.5 * (wide(cone.start) + wide(cone.end)), cone.first_radius.abs().max(cone.second_radius.abs()))
            }
        };
        let (center, radius) = (scene.origin() + center, radius.into());
        let of_data = scene.len() - scene.added();
        let is_added = index >= of_data;
        let rows = columns.iter().filter(|_| !is_added).filter_map(|column| {
            let count = match &column.values {
                ColumnValues::Labels(labels) => labels.indices.len(),
                ColumnValues::Numbers(numbers) => numbers.len(),
            };
            // Spheres of the data follow those in the scene file itself.
            let index = index.checked_sub(of_data.checked_sub(count)?)?;
            row(column, index)
        });
        Some(Self { id, center, radius, is_added, rows: rows.collect() })
    }

    pub(crate) fn value(&self, name: &str) -> Option<&str> {
        self.rows.iter().find(|row| row.name == name).map(|row| row.value.as_str())
    }

    /// A short name, such as `CA 42 A`, from the columns of files of atoms.
    pub(crate) fn title(&self) -> String {
        if self.is_added {
            return "bond, cone, or edge of the cell".to_owned();
        }
        let of = |names: &[&str]| names.iter().find_map(|name| self.value(name));
        let kind = of(&["name", "atom", "species", "type"]);
        let place = ["residue", "residue_number", "chain"].into_iter().filter_map(|name| of(&[name]));
        let parts: Vec<&str> = kind.into_iter().chain(place).collect();
        if parts.is_empty() { format!("sphere {}", self.id) } else { parts.join(" ") }
    }
}

fn row(column: &Column, index: usize) -> Option<Row> {
    let name = column.name.clone();
    Some(match &column.values {
        ColumnValues::Labels(labels) => {
            let text = labels.names.get(*labels.indices.get(index)? as usize)?;
            let quote = if text.contains('"') { '\'' } else { '"' };
            let select = format!("{name} == {quote}{text}{quote}");
            Row { name, value: text.clone(), select: Some(select) }
        }
        ColumnValues::Numbers(numbers) => {
            let number = *numbers.get(index)?;
            let is_whole = number.fract() == 0.0 && number.abs() < 1e9;
            let select = is_whole.then(|| format!("{name} == {number}"));
            Row { name, value: readable(number), select }
        }
    })
}

/// Writes a number with the usual number of digits of files.
pub(crate) fn readable(number: f64) -> String {
    if !number.is_finite() || number == 0.0 || (1e-4..1e7).contains(&number.abs()) {
        // The text has seven significant digits, without zeros at the end.
        let before = number.abs().max(1.0).log10().floor();
        let digits = (6.0 - before).clamp(0.0, 8.0) as usize;
        let text = format!("{number:.digits$}");
        let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        return text.to_owned();
    }
    format!("{number:.6e}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use pinhole::scene::cone::Cone;
    use pinhole_data::load::{self, Options};

    #[test]
    fn a_sphere_is_described_by_its_columns() {
        let text = "2\nProperties=species:S:1:pos:R:3:charge:R:1\nO 0 0 0 -0.8\nH 0.96 0 0 0.4\n";
        let loaded = load::from_bytes(text.as_bytes(), "a.xyz", &Options::default()).unwrap();
        let columns = loaded.columns.clone();
        let scene = Arc::new(loaded.clone().scene(pinhole::LinearRgb::WHITE).unwrap());
        let details = Details::of(&scene, &columns, 1).unwrap();
        assert_eq!((details.value("species"), details.value("charge")), (Some("H"), Some("0.4")));
        assert_eq!(details.title(), "H");
        assert_eq!(details.rows[0].select.as_deref(), Some("species == \"H\""));
        assert_eq!(Details::of(&scene, &columns, 2), None);
        let bond = Cone::cylinder([0.0; 3], [0.96, 0.0, 0.0], 0.1);
        let bonded = Scene::from_shapes(loaded.spheres, &[bond], pinhole::LinearRgb::WHITE.into()).unwrap();
        let bond = Details::of(&Arc::new(bonded), &columns, 2).unwrap();
        assert!(bond.is_added && bond.rows.is_empty());
        assert!((bond.center.x - 0.48).abs() < 1e-6 && (bond.radius - 0.1).abs() < 1e-6);
    }

    #[test]
    fn numbers_are_short() {
        for (number, text) in [
            (0.0, "0"),
            (1.5, "1.5"),
            (-0.1, "-0.1"),
            (12_345.678_9, "12345.68"),
            (2e-7, "2.000000e-7"),
            (100.0, "100"),
        ] {
            assert_eq!(readable(number), text);
        }
        assert_eq!(readable(f64::NAN), "NaN");
    }
}
