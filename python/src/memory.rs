//! How much memory is free, so that a picture that does not fit is refused before work on it begins.

use crate::fault::{Fault, Outcome};
use crate::look::Look;
use pinhole::LayerSet;
use pinhole::cpu::{SampledPicture, SearchPlan};

/// The most bytes per pixel that encoding needs in addition to the picture: 8 for the encoded pixels and 8 for the PNG made
/// of them; or 8 for one and 12 for an array.
pub(crate) const ENCODING_BYTES_PER_PIXEL: u64 = 20;

/// The bytes that are free on this machine or in the control group of the process; `None` if that is not known, as on
/// systems other than Linux, so that only the allocation can fail.
pub(crate) fn available() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    let of_group = |name: &str| -> Option<u64> {
        std::fs::read_to_string(format!("/sys/fs/cgroup/{name}")).ok()?.trim().parse().ok()
    };
    let group = of_group("memory.max").zip(of_group("memory.current"));
    let group = group.map_or(u64::MAX, |(most, used)| most.saturating_sub(used));
    Some(group.min(kibibytes.saturating_mul(1024)))
}

/// Refuses a picture of the CPU for which there is not enough memory. That of a device is in its plan.
pub(crate) fn check_on_cpu(plan: &SearchPlan<'_>, look: &Look, layers: LayerSet) -> Outcome<()> {
    let Some(available) = available() else { return Ok(()) };
    let views = if look.eyes.is_some() { 4 } else { 1 };
    let is_lit = !look.settings.integrator.is_primary();
    let sums = if is_lit { SampledPicture::BYTES_PER_PIXEL } else { 0 };
    let per_pixel = views * layers.bytes_per_pixel() + ENCODING_BYTES_PER_PIXEL + sums;
    let pictures = look.film.pixel_count().saturating_mul(per_pixel);
    let needed = pictures.saturating_add(plan.bytes());
    if needed <= available {
        return Ok(());
    }
    let (width, height) = (look.film.width(), look.film.height());
    Err(Fault::Input(format!(
        "a picture of {width}x{height} of {} spheres needs {needed} bytes of memory, but only {available} are free; choose a \
         smaller size or fewer spheres",
        plan.scene().len()
    )))
}
