//! Checks that a picture or a scene fits into memory before work on it begins.

mod control_group;

use sysinfo::{MemoryRefreshKind, RefreshKind, System};

use crate::failure::Failure;
use pinhole::camera::film::Film;
use pinhole::image::LayerSet;

/// The most bytes per pixel that encoding needs in addition to the picture: 8 for the encoded pixels and 8 for the PNG
/// made of them; or 8 for a PNG that waits for standard output and 12 for an array. EXR is written row by row.
pub(super) const ENCODING_BYTES_PER_PIXEL: u64 = 20;

/// Refuses a picture of the CPU reference for which the machine, or the control group that the program runs in, has not
/// enough memory. Each pixel needs `extra_bytes_per_pixel` in addition to the layers. The memory that an adapter needs
/// is in its plan.
pub(super) fn check(
    film: &Film,
    size_from: &str,
    layers: LayerSet,
    extra_bytes_per_pixel: u64,
) -> Result<(), Failure> {
    let per_pixel = layers.bytes_per_pixel() + extra_bytes_per_pixel;
    let needed = film.pixel_count().saturating_mul(per_pixel);
    let (width, height) = (film.width(), film.height());
    let what = format!("{size_from}: a picture of {width}x{height} needs");
    Ok(check_bytes(&what, needed, "a smaller size").map_err(anyhow::Error::msg)?)
}

/// Refuses work that needs more memory than is free. `what` is the start of the sentence, up to the number of bytes.
pub(super) fn check_bytes(what: &str, needed: u64, instead: &str) -> Result<(), String> {
    if let Some(available) = available()
        && needed > available
    {
        return Err(format!(
            "{what} {} of memory, but only {} are free; choose {instead}",
            readable(needed),
            readable(available)
        ));
    }
    Ok(())
}

/// Files of at most this many bytes are read without a check of the free memory, which takes time.
const SMALL: u64 = 1 << 24;

/// Refuses a file of `size` bytes if there is not enough memory for it and for its spheres. `what` is the start of the
/// sentence, up to the number of bytes.
pub(super) fn check_reading(what: &str, size: u64) -> Result<(), String> {
    if size <= SMALL {
        return Ok(());
    }
    // Three numbers of an array become four numbers of a sphere.
    check_bytes(what, size.saturating_mul(7) / 3, "a smaller file")
}

/// Returns the bytes that are free for this program; `None` if that is not known, so that only the allocation can fail.
pub(super) fn available() -> Option<u64> {
    let what = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
    let system = System::new_with_specifics(what);
    let in_group = control_group::free().unwrap_or(u64::MAX);
    match system.available_memory() {
        0 => None,
        free => Some(free.min(in_group)),
    }
}

/// Formats a number of bytes in KiB, MiB or GiB.
pub(super) fn readable(bytes: u64) -> String {
    const KIB: f64 = 1024.0;
    let kib = bytes as f64 / KIB;
    if kib < KIB {
        format!("{kib:.0} KiB")
    } else if kib < KIB * KIB {
        format!("{:.0} MiB", kib / KIB)
    } else {
        format!("{:.1} GiB", kib / KIB / KIB)
    }
}
