//! Whether a picture or a scene fits into the machine, asked before it is begun.

use sysinfo::{MemoryRefreshKind, RefreshKind, System};

use super::failure::Failure;
use crate::film::Film;
use crate::image::LayerSet;

/// Bytes per pixel that encoding takes beside the image itself.
const ENCODING_BYTES_PER_PIXEL: u64 = 16;

/// Bytes per pixel, and the most pixels, of what a device works on at a time, and what is copied back.
/// A software device takes them from the same memory.
const TILE_BYTES_PER_PIXEL: u64 = 88;
const MAX_TILE_PIXELS: u64 = 1 << 22;

/// Refuses a picture that this machine, or the control group that the program runs in, cannot hold.
pub(super) fn check(film: &Film, size_from: &str, layers: LayerSet) -> Result<(), Failure> {
    let per_pixel = layers.bytes_per_pixel() + ENCODING_BYTES_PER_PIXEL;
    let pixels = film.pixel_count();
    let tile = pixels.min(MAX_TILE_PIXELS) * TILE_BYTES_PER_PIXEL;
    let needed = pixels.saturating_mul(per_pixel).saturating_add(tile);
    let (width, height) = (film.width(), film.height());
    let what = format!("{size_from}: a picture of {width}x{height} needs");
    check_bytes(&what, needed, "a smaller size").map_err(Failure::usage)
}

/// Refuses what needs more memory than there is; `what` is a sentence up to the number of bytes.
pub(super) fn check_bytes(what: &str, needed: u64, instead: &str) -> Result<(), String> {
    let available = available();
    if needed > available {
        return Err(format!(
            "{what} {} of memory, and {} are free; choose {instead}",
            readable(needed),
            readable(available)
        ));
    }
    Ok(())
}

fn available() -> u64 {
    let what = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
    let system = System::new_with_specifics(what);
    let in_group = system
        .cgroup_limits()
        .map_or(u64::MAX, |limits| limits.total_memory.saturating_sub(limits.rss));
    match system.available_memory() {
        // Not known on this system; then the allocation itself decides.
        0 => u64::MAX,
        free => free.min(in_group),
    }
}

fn readable(bytes: u64) -> String {
    const MIB: f64 = (1 << 20) as f64;
    let mib = bytes as f64 / MIB;
    if mib < 1024.0 { format!("{mib:.0} MiB") } else { format!("{:.1} GiB", mib / 1024.0) }
}
