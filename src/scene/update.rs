//! Updates of some spheres of a scene.

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use super::appearance::{Colors, SceneAppearance};
use super::{Scene, SceneError, frame};
use crate::scene::sphere;

/// New centres, radii or colours for consecutive spheres of a scene. Fields that are `None` change nothing.
///
/// ```
/// use pinhole::scene::{Centers, SceneUpdate};
/// use pinhole::{LinearRgb, Scene};
///
/// let mut scene = Scene::from_f32(vec![[0.0, 0.0, 0.0, 0.5]; 3], LinearRgb::WHITE)?;
/// let moved = Centers::F32(&[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
/// scene.apply(&SceneUpdate { first: 1, centers: Some(moved), ..SceneUpdate::default() })?;
/// assert_eq!(scene.spheres()[2], [2.0, 0.0, 0.0, 0.5]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SceneUpdate<'a> {
    /// Index of the first updated sphere, in input order.
    pub first: u32,
    /// New centres in world space.
    pub centers: Option<Centers<'a>>,
    /// New radii.
    pub radii: Option<&'a [f32]>,
    /// New colours.
    pub colors: Option<NewColors<'a>>,
}

/// Centres of spheres in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Centers<'a> {
    /// Centres in f32.
    F32(&'a [[f32; 3]]),
    /// Centres in f64.
    F64(&'a [[f64; 3]]),
}

/// New colours. The colours of the scene must be of the same kind, see [`Colors`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum NewColors<'a> {
    /// Indices into the scene's palette.
    Palette(&'a [u32]),
    /// A colour for each sphere, in sRGB, with alpha.
    Rgba8(&'a [[u8; 4]]),
    /// Numbers for the scene's colour map.
    Scalars(&'a [f32]),
}

/// The reason why an update fails, with the index of the wrong sphere in input order. The scene is then unchanged.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
#[non_exhaustive]
pub struct UpdateError(String);

impl From<SceneError> for UpdateError {
    fn from(error: SceneError) -> Self {
        Self(error.to_string())
    }
}

impl Centers<'_> {
    fn len(&self) -> usize {
        match self {
            Self::F32(centers) => centers.len(),
            Self::F64(centers) => centers.len(),
        }
    }

    fn get(&self, offset: usize) -> [f64; 3] {
        match self {
            Self::F32(centers) => centers[offset].map(f64::from),
            Self::F64(centers) => centers[offset],
        }
    }
}

impl NewColors<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Palette(colors) => colors.len(),
            Self::Rgba8(colors) => colors.len(),
            Self::Scalars(colors) => colors.len(),
        }
    }

    const fn name(&self) -> &'static str {
        match self {
            Self::Palette(_) => PALETTE,
            Self::Rgba8(_) => RGBA8,
            Self::Scalars(_) => SCALARS,
        }
    }
}

impl SceneAppearance {
    /// Replaces the colours of some spheres. The new colours have been checked and are of the same kind.
    fn set_colors(&mut self, range: Range<usize>, new: &NewColors<'_>) {
        match (&mut self.appearance.colors, new) {
            (Colors::Palette { indices, .. }, NewColors::Palette(new)) => {
                indices[range].copy_from_slice(new);
            }
            (Colors::Rgba8(colors), NewColors::Rgba8(new)) => colors[range].copy_from_slice(new),
            (Colors::Scalars { values, .. }, NewColors::Scalars(new)) => {
                values[range].copy_from_slice(new);
            }
            _ => {}
        }
        (self.material_table, self.is_opaque) = (OnceLock::new(), OnceLock::new());
    }
}

const PALETTE: &str = "palette colors";
const RGBA8: &str = "individual colors";
const SCALARS: &str = "numbers for a color map";

impl SceneUpdate<'_> {
    /// The range of updated spheres.
    #[must_use]
    pub fn range(&self) -> Range<u32> {
        // If there are more updated spheres than ids, checking the range later returns an error.
        self.first..self.first.saturating_add(u32::try_from(self.count()).unwrap_or(u32::MAX))
    }

    fn count(&self) -> usize {
        let [centers, radii, colors] = self.lengths();
        centers.or(radii).or(colors).unwrap_or(0)
    }

    fn lengths(&self) -> [Option<usize>; 3] {
        let centers = self.centers.as_ref().map(Centers::len);
        [centers, self.radii.map(<[f32]>::len), self.colors.as_ref().map(NewColors::len)]
    }

    /// Whether centres or radii change, so that acceleration structures must be updated.
    pub(crate) fn changes_shape(&self) -> bool {
        self.centers.is_some() || self.radii.is_some()
    }

    fn check_range(&self, scene: &Scene) -> Result<Range<usize>, UpdateError> {
        let (first, wanted) = (self.first as usize, self.count());
        for (what, length) in ["center", "radius", "color"].into_iter().zip(self.lengths()) {
            if let Some(found) = length.filter(|found| *found != wanted) {
                let index = first.saturating_add(found.min(wanted));
                return Err(UpdateError(format!(
                    "sphere {index} is not in every list: the update has a {what} for {found} spheres, but {wanted} \
                     entries in the list before it"
                )));
            }
        }
        let (end, spheres) = (first.saturating_add(wanted), scene.len());
        if end > spheres {
            let index = end - 1;
            return Err(UpdateError(format!(
                "there is no sphere {index}: the scene has {spheres} spheres, and the update covers {first} to {index}"
            )));
        }
        Ok(first..end)
    }

    /// The centre of a sphere in world space after the update, and the sphere in the scene's frame.
    fn sphere(&self, scene: &Scene, index: usize) -> ([f64; 3], [f32; 4]) {
        let offset = index - self.first as usize;
        let [x, y, z, radius] = scene.spheres()[index];
        let radius = self.radii.map_or(radius, |radii| radii[offset]);
        match self.centers {
            None => {
                let center = scene.origin + glam::Vec3::new(x, y, z).as_dvec3();
                (center.to_array(), [x, y, z, radius])
            }
            Some(centers) => {
                let center @ [x, y, z] = centers.get(offset);
                (center, frame::moved([x, y, z, f64::from(radius)], scene.origin))
            }
        }
    }

    fn check_sphere(&self, scene: &Scene, index: usize) -> Result<(), UpdateError> {
        let ([x, y, z], in_frame) = self.sphere(scene, index);
        let radius = f64::from(in_frame[3]);
        sphere::check([x, y, z, radius]).map_err(|error| SceneError::Sphere { index, error })?;
        // The radius has been checked, so only the centre can be out of range.
        sphere::check(frame::slackened(&in_frame)).map_err(|_| {
            UpdateError(format!(
                "sphere {index} is too far from the scene's origin, {:?}, which an update does not move; make a new scene",
                scene.origin.to_array()
            ))
        })
    }

    fn check_colors(&self, scene: &Scene, first: usize) -> Result<(), UpdateError> {
        let Some(new) = &self.colors else { return Ok(()) };
        let at = |offset: Option<usize>| offset.map(|offset| first + offset);
        let wanted = match (new, scene.appearance().colors()) {
            (NewColors::Palette(indices), Colors::Palette { palette, .. }) => {
                let colors = palette.len();
                let outside = at(indices.iter().position(|index| *index as usize >= colors));
                return outside.map_or(Ok(()), |index| Err(SceneError::color(index, colors).into()));
            }
            (NewColors::Scalars(values), Colors::Scalars { .. }) => {
                let nan = at(values.iter().position(|value| value.is_nan()));
                return nan.map_or(Ok(()), |index| Err(SceneError::scalar(index).into()));
            }
            (NewColors::Rgba8(_), Colors::Rgba8(_)) => return Ok(()),
            (_, Colors::One(_)) => "one common color",
            (_, Colors::Palette { .. }) => PALETTE,
            (_, Colors::Rgba8(_)) => RGBA8,
            (_, Colors::Scalars { .. }) => SCALARS,
        };
        let found = new.name();
        let message = format!("sphere {first} cannot be given {found}: the scene's spheres have {wanted}");
        Err(UpdateError(message))
    }
}

impl Scene {
    /// Gives some spheres new centres, radii or colours. Ids stay the same. The frame does not move, so f32 offsets
    /// lose precision if spheres move far from their original positions.
    ///
    /// The time is proportional to the number of updated spheres. If shapes change, the bounding box of all spheres is
    /// computed as well. Data that is shared with a scene on a device is copied, in 4 bytes per sphere.
    ///
    /// # Errors
    /// Returns an error if the lists have different lengths, the scene has fewer spheres, its colours are of another
    /// kind, or a number is out of range or NaN. The scene is then unchanged.
    pub fn apply(&mut self, update: &SceneUpdate<'_>) -> Result<(), UpdateError> {
        let range = update.check_range(self)?;
        if update.changes_shape() {
            range.clone().try_for_each(|index| update.check_sphere(self, index))?;
        }
        update.check_colors(self, range.start)?;
        if update.changes_shape() {
            let moved: Vec<_> = range.clone().map(|index| update.sphere(self, index).1).collect();
            Arc::make_mut(&mut self.shapes).edit()[range.clone()].copy_from_slice(&moved);
            self.bounds = self.shapes.bounds(self.origin);
        }
        if let Some(new) = &update.colors {
            Arc::make_mut(&mut self.appearance).set_colors(range, new);
        }
        Ok(())
    }
}
