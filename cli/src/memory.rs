//! Whether a picture or a scene fits into the machine, asked before it is begun.

use sysinfo::{MemoryRefreshKind, RefreshKind, System};

use super::failure::Failure;
use pinhole::camera::film::Film;
use pinhole::image::LayerSet;

/// Bytes per pixel that encoding takes beside the image itself, at most: 8 of samples and as many of a PNG made of
/// them; or that PNG, on its way to standard output, and 12 of an array. EXR is written row by row.
pub(super) const ENCODING_BYTES_PER_PIXEL: u64 = 20;

/// Refuses a picture of the CPU reference that this machine, or the control group that the program runs in,
/// cannot hold, with so many bytes a pixel beside its layers. What an adapter takes is in its plan.
pub(super) fn check(
    film: &Film,
    size_from: &str,
    layers: LayerSet,
    beside: u64,
) -> Result<(), Failure> {
    let per_pixel = layers.bytes_per_pixel() + beside;
    let needed = film.pixel_count().saturating_mul(per_pixel);
    let (width, height) = (film.width(), film.height());
    let what = format!("{size_from}: a picture of {width}x{height} needs");
    Ok(check_bytes(&what, needed, "a smaller size").map_err(anyhow::Error::msg)?)
}

/// Refuses what needs more memory than there is; `what` is a sentence up to the number of bytes.
pub(super) fn check_bytes(what: &str, needed: u64, instead: &str) -> Result<(), String> {
    if let Some(available) = available()
        && needed > available
    {
        return Err(format!(
            "{what} {} of memory, and {} are free; choose {instead}",
            readable(needed),
            readable(available)
        ));
    }
    Ok(())
}

/// Arrays up to this many bytes are read without asking for the machine's memory, which takes time.
const SMALL: u64 = 1 << 24;

/// Refuses an array of so many bytes that this machine cannot hold together with the spheres that are made of
/// it; `what` is a sentence up to the number of bytes.
pub(super) fn check_reading(what: &str, size: u64) -> Result<(), String> {
    if size <= SMALL {
        return Ok(());
    }
    // Of three numbers, four are made.
    check_bytes(what, size.saturating_mul(7) / 3, "a smaller file")
}

/// Bytes that are free for this program; `None` is not known, and then the allocation itself decides.
pub(super) fn available() -> Option<u64> {
    let what = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
    let system = System::new_with_specifics(what);
    let in_group = system
        .cgroup_limits()
        .map_or(u64::MAX, |limits| limits.total_memory.saturating_sub(limits.rss));
    match system.available_memory() {
        0 => None,
        free => Some(free.min(in_group)),
    }
}

/// Bytes as people read them.
pub(super) fn readable(bytes: u64) -> String {
    const MIB: f64 = (1 << 20) as f64;
    let mib = bytes as f64 / MIB;
    if mib < 1024.0 { format!("{mib:.0} MiB") } else { format!("{:.1} GiB", mib / 1024.0) }
}
