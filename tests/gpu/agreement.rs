//! Tests that pictures of the GPU agree with those of the CPU reference.

use libtest_mimic::Trial;
use pinhole::LayerSet;

use crate::headless;
use crate::scenes;
use crate::support::compare::{Picture, compare};

/// Maximum fraction of pixels whose id may differ because two ids are correct.
const MAX_AMBIGUOUS: f64 = 1e-3;

pub(crate) fn trials() -> Vec<Trial> {
    scenes::all()
        .into_iter()
        .map(|(name, view)| {
            Trial::test(format!("agreement::{name}"), move || {
                let image =
                    headless()?.render(&view.scene, &view.seen(), &view.settings, LayerSet::ALL)?;
                let reference = Picture::from(&view.reference());
                let comparison = compare(&view, &reference, &Picture::from(&image));
                if let Some(first) = comparison.violations.first() {
                    let count = comparison.violations.len();
                    return Err(format!("{count} violations, the first is {first:?}").into());
                }
                let ambiguous = comparison.ambiguous as f64 / view.film.pixel_count() as f64;
                if ambiguous > MAX_AMBIGUOUS {
                    return Err(format!("{ambiguous} of all pixels are ambiguous").into());
                }
                Ok(())
            })
        })
        .collect()
}
