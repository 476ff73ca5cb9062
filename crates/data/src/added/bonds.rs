//! Bonds between atoms.

use glam::DVec3;

use super::atoms::{Atoms, no_elements};
use super::neighbours::{Neighbours, neighbours};
use super::shapes::{AddError, AddedShapes, Look, between};
use crate::load::Dataset;
use pinhole::scene::Appearance;
use pinhole::scene::material::Material;

/// The choice of bonded atoms. Bonds are drawn as cylinders, each half with the look of its atom.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Bonds {
    /// The greatest distance of bonded atoms.
    pub length: BondLength,
}

/// The greatest distance of bonded atoms, or spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BondLength {
    /// The bonds that the file lists, and atoms that are closer than this factor times the sum of their covalent radii
    /// (Cordero et al. 2008), in Å. Distances never join two atoms of hydrogen, two metals, or an ion: a metal or halogen
    /// that is alone in its residue.
    Covalent(f64),
    /// Two spheres of any kind are bonded if they are closer than this length. Bonds of the file are not used.
    Below(f64),
}

impl Bonds {
    /// The factor of covalent radii by default: bonds may be a fifth longer than usual, as `CovalentBond.is_bonded` of
    /// pymatgen allows. Psi4 uses 1.3.
    pub const FACTOR: f64 = 1.2;

    /// Bonds of this length.
    #[must_use]
    pub fn new(length: BondLength) -> Self {
        Self { length }
    }
}

impl Default for Bonds {
    fn default() -> Self {
        Self::new(BondLength::Covalent(Self::FACTOR))
    }
}

/// The radius of the stick at one end of a bond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StickSize {
    /// There is no stick.
    None,
    /// A part of the smaller ball of a bond.
    OfBalls,
    /// That of the ball.
    Ball,
    /// This radius.
    Radius(f64),
}

/// The note about metals without sticks, which who asks for bonds misses.
pub(super) const METALS: &str = "metals are not joined; --bond-length L joins all that are closer";

/// The factor by which bonded atoms are smaller than their van der Waals radius.
const BALL: f64 = 0.25;

/// The factor by which bonded spheres are smaller that are not atoms of an element. Neighbours among them often
/// touch.
const OTHER_BALL: f64 = 0.5;

/// The radius of a stick, in radii of the smaller of the spheres that it joins.
const STICK: f64 = 0.45;

/// The factor by which bonds make a sphere smaller that is an atom of an element, or is not.
pub(crate) fn radius_factor(is_element: bool) -> f64 {
    if is_element { BALL } else { OTHER_BALL }
}

impl Bonds {
    /// Adds sticks. `sticks` has their sizes at each sphere.
    pub(super) fn add(
        &self,
        data: &Dataset,
        appearance: &Appearance,
        sticks: Option<&[StickSize]>,
        added: &mut AddedShapes,
    ) -> Result<(), AddError> {
        let count = data.spheres.len();
        let points: Vec<DVec3> = (0..count).map(|index| data.center(index)).collect();
        let Neighbours { within, across } = match self.length {
            BondLength::Below(length) => {
                check("length", length)?;
                neighbours(data, &points, length, |_, _, squared| squared > 0.0)?
            }
            BondLength::Covalent(factor) => {
                check("factor", factor)?;
                covalent_bonds(factor, data, &points, &mut added.notes)?
            }
        };
        let size = |index: u32| sticks.map_or(StickSize::OfBalls, |sticks| sticks[index as usize]);
        let surface = |id: u32| appearance.surface_indices().and_then(|all| all.get(id as usize).copied());
        let within = within.into_iter().map(|[a, b]| (a, b, None));
        let across = across.into_iter().map(|(a, b, image)| (a, b, Some(image)));
        let are_sticks = |(a, b, _): &(u32, u32, Option<DVec3>)| ![*a, *b].map(size).contains(&StickSize::None);
        let mut halves = 0;
        for (a, b, image) in within.chain(across).filter(are_sticks) {
            // A bond across the border of the cell is there from both sides.
            halves += if image.is_none() { 2 } else { 1 };
            let [from, to] = [a, b].map(|index| data.center(index as usize));
            let [ball_a, ball_b] = [a, b].map(|index| data.spheres.at(index as usize)[3]);
            let to = image.unwrap_or(to);
            let radius_of = |index, ball| match size(index) {
                StickSize::None | StickSize::OfBalls => STICK * ball_a.min(ball_b),
                StickSize::Ball => ball,
                StickSize::Radius(radius) => radius,
            };
            let radius = radius_of(a, ball_a).min(radius_of(b, ball_b));
            let (length, middle) = ((to - from).length(), 0.5 * (from + to));
            let along = (to - from) / length;
            // The stick leaves a ball at this distance from its centre.
            let [out_a, out_b] = [ball_a, ball_b].map(|ball| (ball * ball - radius * radius).max(0.0).sqrt());
            // It starts deeper by its radius, so that no part is short, but not behind the centre.
            let deep = |out: f64| (out - radius).max(0.0) * along;
            let ends = [from + deep(out_a), to - deep(out_b)];
            let halves = [(a, [ends[0], middle], 0.5 * length - out_a), (b, [middle, ends[1]], 0.5 * length - out_b)];
            let whole = [(a, ends, length - out_a - out_b)];
            let are_alike = appearance.color(a) == appearance.color(b) && surface(a) == surface(b);
            let parts = match image {
                // The other half begins at the other side of the cell.
                Some(_) => &halves[..1],
                None if are_alike => &whole[..],
                None => &halves,
            };
            for (atom, ends, _) in parts.iter().filter(|(.., seen)| *seen > 0.0 && radius > 0.0) {
                added.push(between(*ends, radius), Look::Sphere(*atom)).map_err(|error| {
                    AddError(format!(
                        "the bond between the spheres {a} and {b} cannot be drawn: {error}; choose larger radii, or a \
                         smaller factor or length of bonds"
                    ))
                })?;
            }
        }
        added.bonds = halves / 2;
        let shines = appearance.surfaces().iter().any(|surface| matches!(surface.material, Material::Emissive { .. }));
        if shines && added.bonds > 0 {
            added.notes.push("bonds of spheres that emit light are drawn without light".to_owned());
        }
        Ok(())
    }
}

fn check(what: &str, value: f64) -> Result<(), AddError> {
    match value.is_finite() && value > 0.0 {
        true => Ok(()),
        false => Err(AddError(format!("`bonds`: the {what} is {value}; it must be finite and greater than 0"))),
    }
}

/// The pairs of bonded atoms with the factor by default, also across the borders of a periodic cell.
pub(crate) fn bonded_pairs(data: &Dataset) -> Result<Vec<[u32; 2]>, AddError> {
    let points: Vec<DVec3> = (0..data.spheres.len()).map(|index| data.center(index)).collect();
    let Neighbours { mut within, across } = covalent_bonds(Bonds::FACTOR, data, &points, &mut Vec::new())?;
    within.extend(across.into_iter().filter(|(a, b, _)| a < b).map(|(a, b, _)| [a, b]));
    within.sort_unstable();
    within.dedup();
    Ok(within)
}

/// Finds the bonds of the file, and pairs of atoms that are closer than `factor` times the sum of their covalent radii.
fn covalent_bonds(
    factor: f64,
    data: &Dataset,
    points: &[DVec3],
    notes: &mut Vec<String>,
) -> Result<Neighbours, AddError> {
    let listed = Neighbours::nearest(data, points, &data.bonds);
    let is_enough = |atoms: &Atoms<'_>| data.has_all_bonds && !atoms.are_all_known();
    let atoms = match Atoms::of(data) {
        None if data.bonds.is_empty() && !data.has_all_bonds => return Err(no_elements()),
        Some(atoms) if data.bonds.is_empty() || !is_enough(&atoms) => atoms,
        _ => return Ok(listed),
    };
    notes.extend(atoms.note());
    if atoms.are_metals() {
        notes.push(METALS.to_owned());
    }
    let found = neighbours(data, points, 2.0 * factor * atoms.largest, |a, b, squared| {
        atoms.most(a, b).is_some_and(|most| squared > 0.0 && squared < (factor * most).powi(2))
    })?;
    Ok(found.joined(listed))
}
