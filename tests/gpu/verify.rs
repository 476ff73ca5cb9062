//! Every scene is rendered as a conforming device may, and, on a device that rounds to the nearest, as the
//! kernels' twins on the CPU do, to the bit.

use libtest_mimic::Trial;

use crate::headless;
use crate::scenes;

pub(crate) fn trials() -> Vec<Trial> {
    scenes::all()
        .into_iter()
        .map(|(name, view)| {
            Trial::test(format!("verify::{name}"), move || {
                let camera = view.camera.as_ref();
                let certificate =
                    headless()?.verify(&view.scene, camera, &view.film, &view.settings)?;
                println!("{name}\n{certificate}");
                if !certificate.is_legal() {
                    return Err(certificate.to_string().into());
                }
                Ok(())
            })
        })
        .collect()
}
