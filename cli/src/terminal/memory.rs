//! The memory of the machine, and the part that this process takes.

use std::fs::read_to_string;
use std::path::Path;

use anyhow::{Result, bail};
use sysinfo::{MemoryRefreshKind, RefreshKind, System};

use crate::terminal::failure::Failure;
use pinhole::camera::film::Film;
use pinhole::image::LayerSet;

/// The most bytes per pixel that encoding needs besides the picture: 8 for the encoded pixels and 8 for the PNG made
/// of them; or 8 for a PNG that waits for standard output and 12 for an array. EXR is written row by row.
pub(crate) const ENCODING_BYTES_PER_PIXEL: u64 = 20;

/// Refuses a picture of the CPU reference for which the machine, or the program's control group, has not enough memory.
/// Each pixel needs `extra_bytes_per_pixel` in addition to the layers. The plan of an adapter has the memory that it
/// needs.
pub(crate) fn check(film: &Film, size_from: &str, layers: LayerSet, extra_bytes_per_pixel: u64) -> Result<(), Failure> {
    let per_pixel = layers.bytes_per_pixel() + extra_bytes_per_pixel;
    let needed = film.pixel_count().saturating_mul(per_pixel);
    let (width, height) = (film.width(), film.height());
    let what = format!("{size_from}: a picture of {width}x{height} needs");
    Ok(check_bytes(&what, needed, "a smaller size")?)
}

/// Refuses work that needs more memory than is free. `what` is the start of the sentence, up to the number of bytes.
pub(crate) fn check_bytes(what: &str, needed: u64, instead: &str) -> Result<()> {
    if let Some(available) = available()
        && needed > available
    {
        bail!("{what} {} of memory, but only {} are free; choose {instead}", readable(needed), readable(available));
    }
    Ok(())
}

/// Maximum bytes of a file that is read without a check of the free memory, because the check takes time.
const SMALL: u64 = 1 << 24;

/// Refuses a file of `size` bytes if there is not enough memory for it and for its spheres. `what` is the start of the
/// sentence, up to the number of bytes.
pub(crate) fn check_reading(what: &str, size: u64) -> Result<()> {
    // Three numbers of an array become four numbers of a sphere.
    if size > SMALL { check_spheres(what, size.saturating_mul(7) / 3) } else { Ok(()) }
}

/// Refuses a file whose spheres take so many bytes, if there is not enough memory for them.
pub(crate) fn check_spheres(what: &str, bytes: u64) -> Result<()> {
    if bytes > SMALL { check_bytes(what, bytes, "a smaller file") } else { Ok(()) }
}

/// Returns the bytes that are free for this program; `None` if they are not known, so that only allocations can fail.
pub(crate) fn available() -> Option<u64> {
    let what = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
    let system = System::new_with_specifics(what);
    let in_group = free_of_groups().unwrap_or(u64::MAX);
    match system.available_memory() {
        0 => None,
        free => Some(free.min(in_group)),
    }
}

/// Formats a number of bytes in KiB, MiB or GiB.
pub(crate) fn readable(bytes: u64) -> String {
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

/// The bytes that the control groups of this process leave free; `None` if no group has a limit.
fn free_of_groups() -> Option<u64> {
    let groups = read_to_string("/proc/self/cgroup").ok()?;
    free_in(Path::new("/sys/fs/cgroup"), &groups)
}

/// Returns the same for the groups in a text like `/proc/self/cgroup`, in a folder of control groups.
fn free_in(root: &Path, groups: &str) -> Option<u64> {
    groups.lines().filter_map(|line| free_of_line(root, line)).min()
}

/// Returns the same for a line, which is `0::/path` for version 2 and `number:memory:/path` for version 1.
fn free_of_line(root: &Path, line: &str) -> Option<u64> {
    let mut fields = line.splitn(3, ':').skip(1);
    let (controllers, path) = (fields.next()?, fields.next()?);
    let (root, files) = match controllers {
        "" => (root.to_path_buf(), &VERSION_2),
        _ if controllers.split(',').any(|controller| controller == "memory") => (root.join("memory"), &VERSION_1),
        _ => return None,
    };
    let own = root.join(path.trim_start_matches('/'));
    let all = own.ancestors().take_while(|folder| folder.starts_with(&root));
    all.filter_map(|folder| files.free(folder)).min()
}

/// Names in a version of control groups: the file of the limit, and statistics of memory that cannot be given back.
struct Files {
    limit: &'static str,
    used: [&'static str; 2],
}

const VERSION_1: Files = Files { limit: "memory.limit_in_bytes", used: ["total_rss", "total_shmem"] };

const VERSION_2: Files = Files { limit: "memory.max", used: ["anon", "shmem"] };

impl Files {
    /// The bytes that a group leaves free; `None` if it has no limit.
    fn free(&self, folder: &Path) -> Option<u64> {
        let limit: u64 = read_to_string(folder.join(self.limit)).ok()?.trim().parse().ok()?;
        let statistics = read_to_string(folder.join("memory.stat")).ok()?;
        let value = |line: &str| {
            let (name, value) = line.split_once(' ')?;
            self.used.contains(&name).then_some(value)?.trim().parse::<u64>().ok()
        };
        let used = statistics.lines().filter_map(value).fold(0_u64, u64::saturating_add);
        Some(limit.saturating_sub(used))
    }
}

/// Returns the largest memory use of the process so far, in bytes.
#[cfg(feature = "gpu")]
pub(crate) fn peak_bytes() -> Option<u64> {
    let kibibytes = field("VmHWM:")?;
    kibibytes.strip_suffix("kB")?.trim().parse::<u64>().ok().map(|kib| kib * 1024)
}

/// Whether the process was started to outlive its terminal, as with `nohup`.
#[cfg(unix)]
pub(crate) fn ignores_hang_up() -> bool {
    /// The bit of SIGHUP in the mask, which is signal 1.
    const HANG_UP: u64 = 1;
    let mask = field("SigIgn:").and_then(|mask| u64::from_str_radix(&mask, 16).ok());
    mask.is_some_and(|mask| mask & HANG_UP != 0)
}

/// Returns the value of a line of `/proc/self/status`.
fn field(name: &str) -> Option<String> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| Some(line.strip_prefix(name)?.trim().to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(root: &Path, path: &str, files: [(&str, &str); 2]) {
        let folder = root.join(path);
        std::fs::create_dir_all(&folder).unwrap();
        for (name, text) in files {
            std::fs::write(folder.join(name), text).unwrap();
        }
    }

    #[test]
    fn the_tightest_of_nested_groups_counts() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let of = |limit, statistics| [("memory.max", limit), ("memory.stat", statistics)];
        group(root, "slurm", of("1000\n", "anon 100\nfile 500\nshmem 20\n"));
        group(root, "slurm/job", of("2000\n", "anon 10\nfile 500\n"));
        group(root, "slurm/job/step", of("max\n", "anon 10\n"));
        assert_eq!(free_in(root, "0::/slurm/job/step\n"), Some(880));
        assert_eq!(free_in(root, "0::/slurm/job/step/task\n"), Some(880));
        group(root, "slurm/job/step", of("300\n", "anon 400\n"));
        assert_eq!(free_in(root, "0::/slurm/job/step\n"), Some(0));
        assert_eq!(free_in(root, "0::/\n"), None);
        assert_eq!(free_in(root, "nonsense\n1:\n"), None);
    }

    #[test]
    fn version_1_has_a_folder_for_memory() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let files = [
            ("memory.limit_in_bytes", "5000\n"),
            ("memory.stat", "rss 7\ntotal_rss 1200\ntotal_shmem 300\ntotal_cache 3000\n"),
        ];
        group(root, "memory/pin", files);
        let groups = "4:cpu,cpuacct:/\n3:memory:/pin\n0::/unified\n";
        assert_eq!(free_in(root, groups), Some(3500));
    }
}
