//! The spheres of a data file in input order, as often as they are needed.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use pinhole::LinearRgb;
use pinhole::geometry::bounds::Bounds;
use pinhole::glam::DVec3;
use pinhole::scene::sphere::Sphere;
use pinhole::scene::{Scene, SceneError, Whole};

use super::array::Array;

/// Spheres of a piece.
const PIECE: usize = 1 << 16;

/// The spheres of a data file.
pub(super) enum Stream {
    /// An array that is read anew each time.
    Array(PathBuf, Array),
    /// A file of another format, which is in memory.
    Scene(Box<Scene>),
}

impl Stream {
    pub(super) fn count(&self) -> u64 {
        match self {
            Self::Array(_, array) => array.count,
            Self::Scene(scene) => scene.len() as u64,
        }
    }

    /// Checks all spheres, and returns their box; `None` without spheres.
    pub(super) fn bounds(&self) -> Result<Option<Bounds>> {
        let Self::Array(path, array) = self else {
            let Self::Scene(scene) = self else { return Ok(None) };
            return Ok(scene.bounds());
        };
        let mut bounds: Option<Bounds> = None;
        let (mut index, mut wrong) = (0, None);
        rows(path, array, &mut |sphere @ [x, y, z, radius]| {
            let checked = Sphere::new([x, y, z], radius, LinearRgb::WHITE).check();
            if let (Err(error), None) = (checked, &wrong) {
                wrong = Some(SceneError::Sphere { index, error });
            }
            let of_sphere = Bounds::of_sphere(DVec3::new(x, y, z), sphere[3]);
            bounds = Some(bounds.map_or(of_sphere, |bounds| bounds.union(of_sphere)));
            index += 1;
            Ok(wrong.is_none())
        })?;
        match wrong {
            Some(error) => Err(anyhow!("{}: {error}", path.display())),
            None => Ok(bounds),
        }
    }

    /// Calls `each` with the id of every sphere and the sphere in the frame of the whole.
    pub(super) fn for_each(
        &self,
        whole: &Whole,
        each: &mut dyn FnMut(u32, [f32; 4]) -> Result<()>,
    ) -> Result<()> {
        match self {
            Self::Array(path, array) => {
                let mut id = 0;
                rows(path, array, &mut |sphere| {
                    each(id, whole.in_frame(sphere))?;
                    id += 1;
                    Ok(true)
                })
            }
            Self::Scene(scene) => {
                (0..).zip(scene.spheres()).try_for_each(|(id, sphere)| each(id, *sphere))
            }
        }
    }
}

/// Calls `each` with every row of an array until it returns false.
fn rows(path: &Path, array: &Array, each: &mut dyn FnMut([f64; 4]) -> Result<bool>) -> Result<()> {
    let cannot = || format!("{}: cannot be read", path.display());
    let mut file = File::open(path).with_context(cannot)?;
    array.begin(&mut file).with_context(cannot)?;
    let mut piece = vec![0; PIECE * array.row()];
    let mut left = array.count;
    while left > 0 {
        let count = left.min(PIECE as u64);
        let bytes = &mut piece[..count as usize * array.row()];
        file.read_exact(bytes).with_context(cannot)?;
        for row in bytes.chunks_exact(array.row()) {
            if !each(array.sphere(row))? {
                return Ok(());
            }
        }
        left -= count;
    }
    Ok(())
}
