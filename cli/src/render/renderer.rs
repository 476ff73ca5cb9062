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

/// The renderer of a picture: the CPU reference in the place of a software device, which takes longer, if light is
/// sampled at random and no flag asks for an adapter. Unless `quiet`, a note says so.
#[cfg_attr(not(feature = "gpu"), expect(unused_variables, reason = "there is no device"))]
pub(crate) fn renderer<'a>(opened: &'a OpenDevice, input: &Input, quiet: bool) -> &'a OpenDevice {
    match opened {
        #[cfg(feature = "gpu")]
        OpenDevice::Device { headless, or_cpu: true, .. } if is_quicker_on_cpu(headless, input) => {
            let name = &headless.adapter_info().name;
            if !quiet {
                tell_once(|| {
                    format!("note: the CPU reference follows random rays, as {name} is slower; or add --backend gpu")
                });
            }
            &CPU
        }
        _ => opened,
    }
}

/// True if the CPU reference takes less time for a picture than a device.
#[cfg(feature = "gpu")]
pub(crate) fn is_quicker_on_cpu(headless: &Headless, input: &Input) -> bool {
    input.bricks.is_none() && headless.is_slower_than_cpu(&input.scene, input.camera.as_ref(), &input.settings)
}

/// Prints one line if the device is not as expected, however many pictures are rendered.
#[cfg(feature = "gpu")]
pub(super) fn tell_once(text: impl FnOnce() -> String) {
    static SAID: Once = Once::new();
    SAID.call_once(|| tell(text()));
}
