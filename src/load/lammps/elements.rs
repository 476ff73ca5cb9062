//! Tells the chemical elements of types by their labels or masses.

use mendeleev::Element;

use super::data::relabelled;
use crate::load::elements::appearance;
use crate::load::loaded::ColumnValues;
use crate::load::table::Table;
use crate::text::shortened;

/// What a data file says about types. Types are numbers, as text, or labels.
#[derive(Debug, Default)]
pub(super) struct Types {
    pub(super) masses: Vec<(String, f64)>,
    /// The label of each number.
    pub(super) labels: Vec<(String, String)>,
}

impl Types {
    fn label_of<'a>(&'a self, name: &'a str) -> &'a str {
        let label = self.labels.iter().find(|(number, _)| number == name);
        label.map_or(name, |(_, label)| label)
    }

    /// The symbol of a type, by its label or else by its mass.
    fn symbol_of(&self, name: &str) -> Option<String> {
        let label = self.label_of(name);
        if label.parse::<f64>().is_err() && appearance(label).is_element {
            return Some(label.to_owned());
        }
        // Where nothing has another mass than 1, masses are in units of their own.
        if self.masses.iter().all(|(_, mass)| (mass - 1.0).abs() < 1e-9) {
            return None;
        }
        let of_type =
            |found: &str| found == name || found == label || self.label_of(found) == label;
        let (_, mass) = self.masses.iter().find(|(found, _)| of_type(found))?;
        let distance = |element: &Element| (f64::from(element.atomic_weight()) - mass).abs();
        let nearest = Element::list().iter().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        // Programs round masses to one digit after the point.
        (distance(nearest) < 0.06).then(|| nearest.symbol().to_owned())
    }
}

/// Gives the types their labels, and the atoms the elements that these or the masses tell. Returns a note.
pub(super) fn name_types(table: &mut Table, types: &Types) -> Option<String> {
    let column = table.columns.iter().find(|column| column.name == "type")?;
    let ColumnValues::Labels(labels) = &column.values else { return None };
    let symbols: Vec<_> = labels.names.iter().map(|name| (name, types.symbol_of(name))).collect();
    let known: Vec<String> = symbols
        .iter()
        .filter_map(|(name, symbol)| {
            let (label, symbol) = (types.label_of(name), symbol.as_ref()?);
            (label != symbol).then(|| format!("{} is {symbol}", shortened(label)))
        })
        .collect();
    let is_any = symbols.iter().any(|(_, symbol)| symbol.is_some());
    let name_of =
        |name: &str| types.symbol_of(name).unwrap_or_else(|| types.label_of(name).to_owned());
    let species = is_any.then(|| relabelled(column, "species", name_of)).flatten();
    let types = relabelled(column, "type", |name| types.label_of(name).to_owned())?;
    table.columns.retain(|column| column.name != "type");
    table.columns.push(types);
    let has_elements = table.columns.iter().any(|column| column.name == "element");
    if has_elements {
        return None;
    }
    table.columns.extend(species);
    let note =
        format!("types are taken as chemical elements by their masses: {}", known.join(", "));
    (!known.is_empty()).then_some(note)
}
