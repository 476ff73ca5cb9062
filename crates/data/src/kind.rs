//! Kinds of data, such as crystals and biomolecules, which are drawn in different ways if nobody says how.

mod axes;
mod curve;
mod whole;

use glam::{DMat3, DVec3};

use crate::cell::PeriodicCell;
use crate::load::{ColumnValues, Dataset, element_symbol, is_metal};
use crate::select::Selection;
use whole::{Whole, whole};

/// A kind of data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Many points that have colours, but no radii.
    Scan,
    /// Residues whose spheres are groups of atoms, such as beads of Martini, or CA alone.
    Coarse,
    /// At least three residues of protein or nucleic acid.
    Biomolecule,
    /// A periodic cell of atoms with an empty layer.
    Slab,
    /// A small periodic cell of atoms that are joined to their images.
    Crystal,
    /// Few atoms that form molecules.
    Molecules,
    /// Many atoms that form molecules, or single atoms.
    Liquid,
    /// Other atoms.
    Atoms,
    /// Beads that are no atoms, with bonds.
    Polymer,
    /// Spheres with different kinds in a cell, which are no atoms.
    Particles,
    /// Many points of which a few are far away.
    Stars,
    /// Points without radii in the order of a smooth curve.
    Curve,
    /// Anything else.
    Plain,
}

impl Kind {
    /// All kinds, in the order in which they are tried.
    pub const ALL: [Self; 13] = [
        Self::Scan,
        Self::Coarse,
        Self::Biomolecule,
        Self::Slab,
        Self::Crystal,
        Self::Molecules,
        Self::Liquid,
        Self::Atoms,
        Self::Polymer,
        Self::Particles,
        Self::Stars,
        Self::Curve,
        Self::Plain,
    ];

    /// The name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Scan => "scan",
            Self::Coarse => "coarse",
            Self::Biomolecule => "biomolecule",
            Self::Slab => "slab",
            Self::Crystal => "crystal",
            Self::Molecules => "molecules",
            Self::Liquid => "liquid",
            Self::Atoms => "atoms",
            Self::Polymer => "polymer",
            Self::Particles => "particles",
            Self::Stars => "stars",
            Self::Curve => "curve",
            Self::Plain => "plain",
        }
    }

    /// The kind with this name.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

/// The least width of the empty layer of a slab, in Å.
const GAP: f64 = 6.0;

/// The number of slices of a cell among which empty ones are searched.
const SLICES: usize = 1 << 13;

/// Distances between neighbouring atoms, in Å, and those between beads.
const ATOMS: std::ops::Range<f64> = 0.6..5.5;
const BEADS: f64 = 2.0;

/// The most atoms of a crystal, and of molecules that are drawn as balls.
const CRYSTAL: usize = 2_000;
const MOLECULES: usize = 5_000;

/// The most atoms that are searched for molecules.
const SEARCHED: usize = 200_000;

/// The fewest points that may be stars, and those that may be a scan.
const STARS: usize = 20_000;
const SCAN: usize = 1_000;

/// The fewest spheres of which a few may lie outside the picture, the most that are looked at for that, and the parts of all
/// between which the others lie.
const FRAMED: usize = 1_000;
const SAMPLE: usize = 1 << 17;
const WITHIN: [f64; 2] = [0.005, 0.995];
const STARS_WITHIN: [f64; 2] = [0.005, 0.995];

/// The most spheres of which as many as possible shall be seen.
const CLEAR: usize = 100;

/// The part of the longest side that a side of flat data has at most, and the part of the diagonal of the box that a point
/// needs as its radius to be seen.
const FLAT: f64 = 1e-6;
const SEEN: f64 = 1.0 / 250.0;

/// Facts about data, by which its kind is chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Traits {
    /// The kind.
    pub kind: Kind,
    /// Returns true if the data has a periodic cell of its own, and not that of a crystal of which it is a part.
    pub has_cell: bool,
    /// The median distance to the nearest neighbour; for a scan, that which 90 % have at most.
    pub spacing: f64,
    /// The direction, of length 1, in which the widest empty layer of the cell lies; that of the third edge if there is
    /// none.
    pub up: DVec3,
    /// Returns true if most atoms are metals.
    pub is_metal: bool,
    /// Returns true if residues of polymers have several chains.
    pub has_chains: bool,
    /// Returns true if there is water, and something else.
    pub has_water: bool,
    /// Returns true if there are residues that are neither polymers nor water.
    pub has_ligands: bool,
    /// Returns true if more than a tenth of the spheres have a species that is no element, and nothing gives colours, and
    /// the same for radii.
    pub beads_lack: [bool; 2],
    /// The direction towards the eye from which molecules look widest, and the direction that is up then, if they do not
    /// look alike from all sides. Those with a cell are seen as it lies, unless they are biomolecules.
    pub widest_view: Option<[DVec3; 2]>,
    /// Two corners of the box in which nearly all centres lie, if some lie so far away that all would be small in a
    /// picture.
    pub bulk: Option<[DVec3; 2]>,
    /// Returns true if nothing in the data gives colours: no colours, species or types.
    pub is_uncolored: bool,
    /// A radius with which few points can be seen, if they have none and about touch where they are small; that of the tube
    /// for a curve.
    pub seen_radius: Option<f64>,
    /// Returns true if the data has points without radii.
    pub are_points: bool,
    /// The axis along which the data has no extent, if there is just one.
    pub flat: Option<usize>,
}

impl Traits {
    /// The traits of data without anything but spheres.
    #[must_use]
    pub fn plain(is_uncolored: bool) -> Self {
        Self {
            kind: Kind::Plain,
            has_cell: false,
            spacing: 0.0,
            up: DVec3::Z,
            is_metal: false,
            has_chains: false,
            has_water: false,
            has_ligands: false,
            beads_lack: [false; 2],
            widest_view: None,
            bulk: None,
            is_uncolored,
            seen_radius: None,
            are_points: false,
            flat: None,
        }
    }

    /// Finds the traits of data, or of the part that is selected, and its kind unless one is asked for. Data that shall be plain
    /// is not looked at.
    #[must_use]
    pub fn of(data: &Dataset, select: Option<&Selection>, asked: Option<Kind>) -> Self {
        let plain =
            || Self::plain(data.colors.is_none() && ["species", "type"].iter().all(|name| data.labels(name).is_none()));
        if asked == Some(Kind::Plain) {
            return plain();
        }
        if let Some(select) = select {
            let mut part = data.clone();
            // An error shows when the scene is made.
            drop(select.apply(&mut part));
            return Self::of(&part, None, asked);
        }
        let count = data.spheres.len();
        let species = data.labels("species");
        let residues = data.labels("residue").map_or(0, |labels| {
            let has_name = |index: &&u32| labels.names.get(**index as usize).is_some_and(|name| !name.is_empty());
            labels.indices.iter().filter(has_name).count()
        });
        let has_residues = count > 0 && 2 * residues >= count;
        let cell = PeriodicCell::of(data).filter(|_| !data.is_part_of_crystal).map(|cell| cell.edges);
        if asked.is_none() && species.is_none() && !has_residues && cell.is_none() && data.bonds.is_empty() {
            // Large data of this kind is common, so it takes no more than one look at each sphere.
            if count >= SCAN && data.colors.is_some() && data.guessed_radius().is_some() {
                return Self { kind: Kind::Scan, spacing: scan_spacing(data), bulk: bulk(data, WITHIN), ..plain() };
            }
            let radius = |index: usize| data.spheres.at(index)[3].to_bits();
            let may_be_stars =
                count >= STARS && data.colors.is_none() && (1..count).all(|index| radius(index) == radius(0));
            return match may_be_stars.then(|| bulk(data, STARS_WITHIN)).flatten() {
                Some(bulk) => Self { kind: Kind::Stars, bulk: Some(bulk), ..plain() },
                None => {
                    let extent = extent(data);
                    let mut flat = (0..3).filter(|axis| extent[*axis] <= FLAT * extent.max_element());
                    let is_curve = data.guessed_radius().is_some() && curve::is_curve(data, extent.length());
                    Self {
                        kind: if is_curve { Kind::Curve } else { Kind::Plain },
                        bulk: bulk(data, WITHIN),
                        are_points: data.guessed_radius().is_some(),
                        seen_radius: match is_curve {
                            true => curve::radius(data, extent.length()),
                            false => seen_radius(data, extent),
                        },
                        flat: if flat.clone().count() == 1 { flat.next() } else { None },
                        ..plain()
                    }
                }
            };
        }
        let spacing = data.spacing();
        let are_elements = species.is_some_and(|labels| labels.names.iter().all(|name| element_symbol(name).is_some()));
        let are_atoms = are_elements && ATOMS.contains(&spacing);
        let polymer = if has_residues { matches("polymer", data) } else { Vec::new() };
        let water = if has_residues { matches("water", data) } else { Vec::new() };
        let (gap, gap_up) = cell.map_or((0.0, DVec3::Z), |cell| widest_gap(data, &cell));
        let third = cell.and_then(|cell| cell.z_axis.try_normalize()).unwrap_or(DVec3::Z);
        let with_species = |is: fn(Option<&'static str>) -> bool| {
            species.map_or(0, |labels| {
                let is: Vec<bool> = labels.names.iter().map(|name| is(element_symbol(name))).collect();
                labels.indices.iter().filter(|index| is.get(**index as usize) == Some(&true)).count()
            })
        };
        let metals = with_species(|symbol| symbol.is_some_and(is_metal));
        let has_beads = !has_residues && 10 * with_species(|symbol| symbol.is_none()) > count;
        // Some atoms of all are far apart, too.
        let are_coarse = || !are_atoms || (spacing >= BEADS && are_guides(data));
        let found = || {
            if count < if cell.is_some() { 1 } else { 2 } {
                Kind::Plain
            } else if has_residues && residues_of(data, &polymer) >= 3 && are_coarse() {
                Kind::Coarse
            } else if has_residues && residues_of(data, &polymer) >= 3 {
                Kind::Biomolecule
            } else if are_atoms {
                match if count <= SEARCHED { whole(data) } else { Whole::Solid } {
                    Whole::Solid if cell.is_some() && gap >= GAP => Kind::Slab,
                    Whole::Solid if cell.is_some() && count <= CRYSTAL => Kind::Crystal,
                    Whole::Solid => Kind::Atoms,
                    // Metals touch, so that they have no bonds.
                    Whole::Molecules if 2 * metals > count => Kind::Atoms,
                    Whole::Molecules if count <= MOLECULES => Kind::Molecules,
                    Whole::Molecules | Whole::Single => Kind::Liquid,
                }
            } else if !data.bonds.is_empty() && !has_residues {
                Kind::Polymer
            } else if cell.is_some() || species.is_some() {
                Kind::Particles
            } else {
                Kind::Plain
            }
        };
        let kind = asked.unwrap_or_else(found);
        let is_turned = match kind {
            Kind::Biomolecule | Kind::Coarse => true,
            Kind::Molecules => cell.is_none(),
            _ => false,
        };
        Self {
            kind,
            has_cell: cell.is_some(),
            spacing: if kind == Kind::Scan { scan_spacing(data) } else { spacing },
            up: if kind == Kind::Slab { gap_up } else { third },
            is_metal: 2 * metals > count,
            has_chains: has_several(data, &polymer),
            has_water: water.contains(&true) && water.contains(&false),
            has_ligands: polymer.iter().zip(&water).any(|(is_polymer, is_water)| !is_polymer && !is_water),
            beads_lack: data.unknown_lack().map(|lack| lack && has_beads),
            widest_view: if is_turned { widest_view(data, &water) } else { None },
            bulk: bulk(data, if kind == Kind::Stars { STARS_WITHIN } else { WITHIN }),
            seen_radius: (kind == Kind::Curve).then(|| curve::radius(data, extent(data).length())).flatten(),
            ..plain()
        }
    }
}

/// Tells whether the data follows a smooth curve in its order.
pub(crate) fn is_curve(data: &Dataset) -> bool {
    curve::is_curve(data, extent(data).length())
}

/// Tells whether most atoms are those of which each residue has one.
fn are_guides(data: &Dataset) -> bool {
    let guides = matches("guide or (polymer and name BB)", data);
    data.labels("name").is_none() || 2 * guides.iter().filter(|is| **is).count() >= data.spheres.len()
}

/// The sides of the box around all centres.
fn extent(data: &Dataset) -> DVec3 {
    let centers = (0..data.spheres.len()).map(|index| data.center(index)).filter(|center| center.is_finite());
    let ends = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = centers.fold(ends, |(low, high), center| (low.min(center), high.max(center)));
    (high - low).max(DVec3::ZERO)
}

/// The radius with which points without radii can be seen, where neighbours on a curve or in clusters are so close that
/// spheres that touch would be specks; so small that all spheres side by side do not fill a picture.
fn seen_radius(data: &Dataset, extent: DVec3) -> Option<f64> {
    let (guessed, _) = data.guessed_radius()?;
    // Places at random are nearer to each other in some places: smaller points show where they are many.
    let spread = || Some(data.spacing_of(0.9)? / data.spacing_of(0.5)?);
    let is_random = (FRAMED..=SEARCHED).contains(&data.spheres.len()) && spread().is_some_and(|spread| spread > 1.3);
    let touching = if is_random { 0.6 * guessed } else { guessed };
    let seen = extent.length() * (0.35 / (data.spheres.len() as f64).sqrt()).min(SEEN);
    (is_random || seen > touching).then_some(seen.max(touching))
}

/// The distance to the nearest neighbour of nearly all points, which leaves few holes in surfaces of points in random places.
fn scan_spacing(data: &Dataset) -> f64 {
    data.spacing_of(0.9).unwrap_or_else(|| data.spacing())
}

/// The spheres that an expression selects; none if the data lacks what it needs.
fn matches(expression: &str, data: &Dataset) -> Vec<bool> {
    let selection = expression.parse::<Selection>();
    selection.and_then(|selection| selection.matches(data)).map(|(matches, _)| matches).unwrap_or_default()
}

/// The view of data, without water, in which it is widest; near one from the front, right and above.
fn widest_view(data: &Dataset, is_water: &[bool]) -> Option<[DVec3; 2]> {
    let seen = (0..data.spheres.len()).filter(|index| is_water.get(*index) != Some(&true));
    let seen = seen.map(|index| data.center(index));
    let view = axes::widest_view(seen.clone(), [DVec3::new(0.47, 0.34, 0.81), DVec3::Y])?;
    Some(match seen.clone().count() <= CLEAR {
        true => axes::clearest_view(&seen.collect::<Vec<_>>(), view, 0.7 * data.spacing()),
        false => view,
    })
}

/// The number of residues, up to three, of the spheres that are chosen.
fn residues_of(data: &Dataset, is_chosen: &[bool]) -> usize {
    let Some(ColumnValues::Numbers(numbers)) = data.column("residue_number") else { return 0 };
    let mut found: Vec<f64> = Vec::new();
    for (number, _) in numbers.iter().zip(is_chosen).filter(|(_, is)| **is) {
        if !found.iter().any(|other| other.to_bits() == number.to_bits()) {
            found.push(*number);
        }
        if found.len() == 3 {
            break;
        }
    }
    found.len()
}

/// Returns true if the spheres that are chosen belong to several chains.
fn has_several(data: &Dataset, is_chosen: &[bool]) -> bool {
    let Some(labels) = data.labels("chain") else { return false };
    let mut chosen = labels.indices.iter().zip(is_chosen).filter(|(_, is)| **is).map(|(index, _)| index);
    chosen.next().is_some_and(|first| chosen.any(|other| other != first))
}

/// The width of the widest layer of the cell without centres, and the direction in which it lies.
fn widest_gap(data: &Dataset, cell: &DMat3) -> (f64, DVec3) {
    let rows = cell.inverse().transpose();
    let mut widest = (0.0, DVec3::Z);
    for (axis, row) in [rows.x_axis, rows.y_axis, rows.z_axis].into_iter().enumerate() {
        let mut is_filled = vec![false; SLICES];
        for place in (0..data.spheres.len()).map(|index| row.dot(data.center(index))).filter(|place| place.is_finite())
        {
            is_filled[(((place - place.floor()) * SLICES as f64) as usize).min(SLICES - 1)] = true;
        }
        let filled: Vec<usize> = (0..SLICES).filter(|slice| is_filled[*slice]).collect();
        let (Some(first), Some(last)) = (filled.first(), filled.last()) else { continue };
        let across = SLICES + first - last;
        let empty = filled.windows(2).map(|pair| pair[1] - pair[0]).fold(across, usize::max);
        let gap = (empty - 1) as f64 / SLICES as f64 / row.length();
        if gap > widest.0 {
            widest = (gap, cell.col(axis).dot(row).signum() * row / row.length());
        }
    }
    widest
}

/// The box between two parts of the centres, in their order along each axis, and a little around it; `None` if that of all
/// centres is less than twice as long, or if there are few.
fn bulk(data: &Dataset, [first, last]: [f64; 2]) -> Option<[DVec3; 2]> {
    let count = data.spheres.len();
    if count < FRAMED {
        return None;
    }
    let side = |axis: usize| -> Option<[f64; 4]> {
        let place = |index: usize| data.center(index)[axis];
        let finite = (0..count).map(place).filter(|place| place.is_finite());
        let ends = [f64::INFINITY, f64::NEG_INFINITY];
        let [low, high] = finite.fold(ends, |[low, high], place| [low.min(place), high.max(place)]);
        // A sample of large data is enough for parts of all.
        let step = count.div_ceil(SAMPLE).max(1);
        let mut some: Vec<f64> = (0..count).step_by(step).map(place).filter(|place| place.is_finite()).collect();
        some.sort_unstable_by(f64::total_cmp);
        let most = some.len().checked_sub(1)?;
        let at = |part: f64| some.get((most as f64 * part) as usize).copied();
        Some([low, high, at(first)?, at(last)?])
    };
    let sides = [side(0)?, side(1)?, side(2)?];
    let corner = |which: usize| DVec3::from(sides.map(|side| side[which]));
    let (whole, low, high) = (corner(1) - corner(0), corner(2), corner(3));
    let around = DVec3::splat(0.05 * (high - low).max_element());
    (whole.max_element() > 2.0 * (high - low).max_element()).then_some([low - around, high + around])
}

#[cfg(test)]
mod tests;
