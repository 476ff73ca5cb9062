//! The program `pinhole`. Everything is in [`pinhole::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    #[cfg(target_os = "linux")]
    quieten_device_select();
    pinhole::cli::main()
}

/// Without a desktop session, Mesa's device-select layer fails to reach a Wayland display and has
/// libwayland print a line that starts with `error:`, for every Vulkan instance. What the layer does,
/// putting one GPU first, the program does by itself, so it is switched off; but not for a user who has
/// configured it.
#[cfg(target_os = "linux")]
#[expect(unsafe_code, reason = "the layer reads nothing but the environment")]
fn quieten_device_select() {
    let is_set = |name| std::env::var_os(name).is_some();
    if !is_set("XDG_RUNTIME_DIR") && !is_set("MESA_VK_DEVICE_SELECT") {
        // SAFETY: the first thing that `main` does; there is no other thread yet.
        unsafe { std::env::set_var("NODEVICE_SELECT", "1") };
    }
}
