//! The renderer of a picture: the device that is open, or the CPU reference in its place.

#[cfg(feature = "gpu")]
use std::sync::Once;

use crate::input::Input;
use crate::render::device::OpenDevice;
#[cfg(feature = "gpu")]
use crate::terminal::progress::tell;
#[cfg(feature = "gpu")]
use pinhole::gpu::Headless;

#[cfg(feature = "gpu")]
static CPU: OpenDevice = OpenDevice::Cpu;

/// The renderer of a picture: the CPU reference in the place of a device that takes longer, or cannot light the scene, if
/// light is sampled at random and no flag asks for an adapter. Unless `quiet`, a note says so.
#[cfg_attr(not(feature = "gpu"), expect(unused_variables, reason = "there is no device"))]
pub(crate) fn renderer<'a>(opened: &'a OpenDevice, input: &Input, quiet: bool) -> &'a OpenDevice {
    match opened {
        #[cfg(feature = "gpu")]
        OpenDevice::Device { headless, or_cpu: true, .. } => match reason_for_cpu(headless, input) {
            None => opened,
            Some(reason) => {
                let or = if input.scene.cones().is_empty() { "; or add --backend gpu" } else { "" };
                if !quiet {
                    tell_once(|| format!("note: the CPU reference follows random rays, as {reason}{or}"));
                }
                &CPU
            }
        },
        _ => opened,
    }
}

/// Why the CPU reference should render a picture in the place of a device; `None` if it should not.
#[cfg(feature = "gpu")]
pub(crate) fn reason_for_cpu(headless: &Headless, input: &Input) -> Option<String> {
    let reason = || headless.reason_for_cpu(&input.scene, input.camera.as_ref(), &input.settings);
    input.bricks.is_none().then(reason).flatten()
}

/// Prints one line if the device is not as expected, however many pictures are rendered.
#[cfg(feature = "gpu")]
pub(super) fn tell_once(text: impl FnOnce() -> String) {
    static SAID: Once = Once::new();
    SAID.call_once(|| tell(text()));
}
