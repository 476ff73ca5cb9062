//! The program `pinhole-viewer`: a window that shows what `pinhole render` renders. `pinhole view` starts it.
//!
//! The state of the window is a list of flags of `pinhole render`, so that the command that it copies and the pictures
//! that it saves match the view by construction.

use std::process::ExitCode;
use std::sync::{Arc, PoisonError};
use std::time::Duration;

use eframe::{egui, egui_wgpu, wgpu};
use pinhole_cli::viewing::{self, RenderFlags, ViewError};

use crate::app::{App, Ending};
use crate::state::State;
use crate::worker::{Message, Worker};
use pinhole::gpu::{GpuError, Wait};

mod app;
mod blit;
mod details;
mod orbit;
mod panels;
mod picture;
mod quick;
mod sections;
mod state;
mod worker;

fn main() -> ExitCode {
    let flags = match RenderFlags::of_process() {
        Ok(flags) => flags,
        Err(code) => return code,
    };
    match run(flags) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            viewing::print_error(&error);
            error.exit_code()
        }
    }
}

fn run(flags: RenderFlags) -> Result<(), ViewError> {
    viewing::prepare()?;
    let state = State::new(flags);
    let adapter = state.flags.get("adapter").map(str::to_owned);
    let worker = Worker::start(state.request(false))
        .map_err(|error| ViewError::new(format!("a thread cannot be started: {error}")))?;
    // A file that cannot be read is reported at once, without a window.
    let first = worker.message_within(Duration::from_millis(400));
    if let Some(Message::Failed { error, .. }) = first {
        return Err(error);
    }
    let ending = Ending::default();
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title(format!("{} – pinhole", state.flags.path()))
            .with_inner_size([1180.0, 760.0])
            .with_min_inner_size([480.0, 360.0]),
        wgpu_options: wgpu_options(adapter.clone()),
        // Dithering would change the picture's bytes.
        dithering: false,
        ..eframe::NativeOptions::default()
    };
    let left = Arc::clone(&ending);
    let opened = eframe::run_native(
        "pinhole-viewer",
        options,
        Box::new(move |context| Ok(Box::new(App::new(context, state, worker, first, left)?))),
    );
    opened.map_err(|error| explained(&error, adapter.as_deref()))?;
    let ending = ending.lock().unwrap_or_else(PoisonError::into_inner).take();
    ending.map_or(Ok(()), Err)
}

/// Explains why there is no window: no display, no adapter, or another reason.
fn explained(error: &eframe::Error, adapter: Option<&str>) -> ViewError {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let displays = ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"];
    if cfg!(all(unix, not(target_os = "macos"))) && !displays.into_iter().any(is_set) {
        return ViewError::new(
            "no window can be opened, because there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set; \
             `pinhole render` needs none",
        );
    }
    match pinhole::gpu::adapter::choose(adapter).wait() {
        Err(error @ GpuError::UnknownAdapter { .. }) => ViewError::usage(error.to_string()),
        Err(error) => ViewError::new(format!("no window can be opened: {error}")),
        Ok(_) => ViewError::new(format!("no window can be opened: {error}")),
    }
}

/// Chooses the adapter that `pinhole render` would use, if it can show windows, with all of its limits.
fn wgpu_options(name: Option<String>) -> egui_wgpu::WgpuConfiguration {
    let mut setup = egui_wgpu::WgpuSetupCreateNew::without_display_handle();
    setup.native_adapter_selector = Some(Arc::new(move |adapters, surface| {
        let can_show = |adapter: &&wgpu::Adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface));
        let mut able: Vec<wgpu::Adapter> = adapters.iter().filter(can_show).cloned().collect();
        able.sort_by_key(|adapter| match adapter.get_info().device_type {
            wgpu::DeviceType::DiscreteGpu => 0,
            wgpu::DeviceType::IntegratedGpu => 1,
            wgpu::DeviceType::VirtualGpu => 2,
            wgpu::DeviceType::Other => 3,
            wgpu::DeviceType::Cpu => 4,
        });
        let index = pinhole::gpu::adapter::index_of_choice(&able, name.as_deref());
        Ok(able.swap_remove(index.map_err(|error| error.to_string())?))
    }));
    setup.device_descriptor = Arc::new(|adapter| wgpu::DeviceDescriptor {
        label: Some("pinhole-viewer"),
        required_limits: adapter.limits(),
        ..wgpu::DeviceDescriptor::default()
    });
    egui_wgpu::WgpuConfiguration {
        wgpu_setup: egui_wgpu::WgpuSetup::CreateNew(setup),
        ..egui_wgpu::WgpuConfiguration::default()
    }
}
