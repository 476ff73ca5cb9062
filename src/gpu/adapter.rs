//! Which adapters there are, and which one to use.

use wgpu::{Adapter, Backends, DeviceType, Instance, InstanceDescriptor, PowerPreference};

use crate::gpu::error::GpuError;

/// More than one would cost start-up time, and list each GPU more than once.
const PLATFORM_BACKEND: Backends = if cfg!(target_vendor = "apple") {
    Backends::METAL
} else if cfg!(windows) {
    Backends::DX12
} else {
    Backends::VULKAN
};

/// Every adapter, the best first: real GPUs before software, and of real GPUs the discrete before the
/// integrated (the other way round if `WGPU_POWER_PREF=low`).
///
/// One backend is asked, the platform's own: Metal, DX12, or elsewhere Vulkan. `WGPU_BACKEND` names
/// others, such as `vulkan` on Windows. Validation layers are loaded only if `WGPU_VALIDATION=1`.
#[must_use]
pub fn adapters() -> Vec<Adapter> {
    let descriptor = InstanceDescriptor {
        // Not the default, which loads validation layers in debug builds: they cost start-up time,
        // and the same layers would have to be installed everywhere.
        flags: wgpu::InstanceFlags::empty(),
        ..InstanceDescriptor::new_without_display_handle()
    };
    let mut descriptor = descriptor.with_env();
    if variable("WGPU_BACKEND").is_none() {
        descriptor.backends = PLATFORM_BACKEND;
    }
    let instance = Instance::new(descriptor);
    let mut adapters = pollster::block_on(instance.enumerate_adapters(Backends::all()));
    let low_power = PowerPreference::from_env() == Some(PowerPreference::LowPower);
    // Stable, so that equals stay in the driver's order.
    adapters.sort_by_key(|adapter| rank(adapter.get_info().device_type, low_power));
    adapters
}

fn rank(device_type: DeviceType, low_power: bool) -> u32 {
    match device_type {
        DeviceType::DiscreteGpu if low_power => 1,
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu if low_power => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    }
}

/// The adapters to try, the best first: one, if it is named, or all.
///
/// # Errors
/// As [`index_of_choice`].
pub fn candidates(name: Option<&str>) -> Result<Vec<Adapter>, GpuError> {
    let mut adapters = adapters();
    let index = index_of_choice(&adapters, name)?;
    if name.is_some() || name_in_environment().is_some() {
        return Ok(vec![adapters.swap_remove(index)]);
    }
    Ok(adapters)
}

/// The first of the [`candidates`].
///
/// # Errors
/// As [`index_of_choice`].
pub fn choose(name: Option<&str>) -> Result<Adapter, GpuError> {
    candidates(name)?.into_iter().next().ok_or(GpuError::NoAdapter)
}

/// Which of [`adapters`] to use: the best whose name contains `name`, or else the value of
/// `WGPU_ADAPTER_NAME`, regardless of case; without either, the best of all.
///
/// # Errors
/// If there is no adapter, or none has such a name.
pub fn index_of_choice(adapters: &[Adapter], name: Option<&str>) -> Result<usize, GpuError> {
    if adapters.is_empty() {
        if let Some(value) = variable("WGPU_BACKEND") {
            return Err(GpuError::NoAdapterOfBackend { value });
        }
        if name.is_none() {
            return Err(GpuError::NoAdapter);
        }
    }
    let Some(wanted) = name.map(str::to_owned).or_else(name_in_environment) else {
        return Ok(0);
    };
    let available: Vec<String> = adapters.iter().map(|a| a.get_info().name).collect();
    let wanted_lowercase = wanted.to_lowercase();
    available
        .iter()
        .position(|name| name.to_lowercase().contains(&wanted_lowercase))
        .ok_or(GpuError::UnknownAdapter { wanted, available })
}

fn name_in_environment() -> Option<String> {
    variable("WGPU_ADAPTER_NAME")
}

/// A variable that is set to nothing counts as not set.
fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok().filter(|value| !value.is_empty())
}
