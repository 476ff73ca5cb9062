//! What the system knows of this process. On Linux it is in `/proc`; elsewhere it is not known.

/// The most bytes of memory that the process has ever had; it only grows.
#[cfg(feature = "gpu")]
pub(super) fn peak_bytes() -> Option<u64> {
    let kibibytes = field("VmHWM:")?;
    kibibytes.strip_suffix("kB")?.trim().parse::<u64>().ok().map(|kib| kib * 1024)
}

/// Whether the process was started so that it outlives its terminal, as by `nohup`.
#[cfg(unix)]
pub(super) fn ignores_hang_up() -> bool {
    /// SIGHUP is 1, the lowest bit of the mask.
    const HANG_UP: u64 = 1;
    let mask = field("SigIgn:").and_then(|mask| u64::from_str_radix(&mask, 16).ok());
    mask.is_some_and(|mask| mask & HANG_UP != 0)
}

fn field(name: &str) -> Option<String> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| Some(line.strip_prefix(name)?.trim().to_owned()))
}
