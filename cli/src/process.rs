//! Reads what the system knows about this process. On Linux that is in `/proc`; elsewhere it is not known.

/// Returns the largest memory use of the process so far, in bytes.
#[cfg(feature = "gpu")]
pub(super) fn peak_bytes() -> Option<u64> {
    let kibibytes = field("VmHWM:")?;
    kibibytes.strip_suffix("kB")?.trim().parse::<u64>().ok().map(|kib| kib * 1024)
}

/// Whether the process was started so that it outlives its terminal, as by `nohup`.
#[cfg(unix)]
pub(super) fn ignores_hang_up() -> bool {
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
