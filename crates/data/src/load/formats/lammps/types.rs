//! The types of atoms in a data file: their labels, and the elements that these or masses identify.

use std::collections::HashMap;

use mendeleev::Element;

use crate::load::dataset::ColumnValues;
use crate::load::elements::appearance;
use crate::load::labels::LabelsBuilder;
use crate::load::table::{Table, TableColumn};
use pinhole::internals::text::shortened;

/// The descriptions of types in a data file. A type is a number, as text, or a label.
#[derive(Debug, Default)]
pub(super) struct Types {
    /// The mass of each type, by its number or label. The first of several masses counts.
    masses: Vec<(String, f64)>,
    /// The label of each number.
    labels: HashMap<String, String>,
}

impl Types {
    pub(super) fn add_mass(&mut self, name: String, mass: f64) {
        self.masses.push((name, mass));
    }

    pub(super) fn add_label(&mut self, number: String, label: String) {
        self.labels.entry(number).or_insert(label);
    }

    fn label_of<'a>(&'a self, name: &'a str) -> &'a str {
        self.labels.get(name).map_or(name, String::as_str)
    }

    /// The symbol of each type, by its label or else by its mass.
    fn symbols_of(&self, names: &[String]) -> Vec<Option<String>> {
        // The index of a mass, by the number or label in the file and by the label of the number.
        let mut places = HashMap::new();
        for (place, (name, _)) in self.masses.iter().enumerate() {
            for name in [name, self.label_of(name)] {
                places.entry(name).or_insert(place);
            }
        }
        // If all masses are 1, they are in units of the simulation and name no elements.
        let has_masses = self.masses.iter().any(|(_, mass)| (mass - 1.0).abs() >= 1e-9);
        let symbol = |name: &String| {
            let label = self.label_of(name);
            if label.parse::<f64>().is_err() && appearance(label).is_element {
                return Some(label.to_owned());
            }
            let place = [name, label].into_iter().filter_map(|name| places.get(name)).min();
            let (_, mass) = self.masses[*place.filter(|_| has_masses)?];
            let distance = |element: &Element| (f64::from(element.atomic_weight()) - mass).abs();
            let nearest = Element::list().iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            // Programs round masses to one digit after the point.
            (distance(nearest) < 0.06).then(|| nearest.symbol().to_owned())
        };
        names.iter().map(symbol).collect()
    }
}

/// Gives the types their labels, and the atoms the elements that labels or masses identify. Returns a note.
pub(super) fn name_types(table: &mut Table, types: &Types) -> Option<String> {
    /// Maximum number of types in the note.
    const MOST: usize = 16;
    let column = table.columns.iter().find(|column| column.name == "type")?;
    let ColumnValues::Labels(labels) = &column.values else { return None };
    let symbols = types.symbols_of(&labels.names);
    let named = || labels.names.iter().zip(&symbols);
    let mut known = named().filter_map(|(name, symbol)| {
        let (label, symbol) = (types.label_of(name), symbol.as_ref()?);
        (label != symbol).then(|| format!("{} is {symbol}", shortened(label)))
    });
    let mut shown: Vec<String> = known.by_ref().take(MOST).collect();
    let more = known.count();
    if more > 0 {
        shown.push(format!("{more} more"));
    }
    let species: Vec<&str> =
        named().map(|(name, symbol)| symbol.as_deref().unwrap_or_else(|| types.label_of(name))).collect();
    let is_any = symbols.iter().any(Option::is_some);
    let species = is_any.then(|| relabelled(column, "species", &species)).flatten();
    let labels: Vec<&str> = labels.names.iter().map(|name| types.label_of(name)).collect();
    let types = relabelled(column, "type", &labels)?;
    table.columns.retain(|column| column.name != "type");
    table.columns.push(types);
    let has_elements = table.columns.iter().any(|column| column.name == "element");
    if has_elements {
        return None;
    }
    table.columns.extend(species);
    let note = format!("types are taken as chemical elements by their masses: {}", shown.join(", "));
    (!shown.is_empty()).then_some(note)
}

/// Makes a column of text from another one by replacing its names.
fn relabelled(column: &TableColumn, name: &str, names: &[&str]) -> Option<TableColumn> {
    let ColumnValues::Labels(labels) = &column.values else { return None };
    let mut labels = labels.clone();
    // Several types may be of the same element.
    let mut unique = LabelsBuilder::default();
    let renumbered: Vec<u32> = names.iter().map(|name| unique.index(name.as_bytes())).collect();
    labels.indices.iter_mut().for_each(|index| *index = renumbered[*index as usize]);
    labels.names = unique.names;
    Some(TableColumn::labels(name, labels))
}
