//! Enumerating adapters, and choosing one.

use wgpu::{Adapter, Backends, DeviceType, Instance, InstanceDescriptor, PowerPreference};

use crate::gpu::error::GpuError;

/// The backend that is used by default. More than one would cost start-up time, and would list every GPU more than
/// once.
const PLATFORM_BACKEND: Backends = if cfg!(target_arch = "wasm32") {
    Backends::BROWSER_WEBGPU
} else if cfg!(target_vendor = "apple") {
    Backends::METAL
} else if cfg!(windows) {
    Backends::DX12
} else {
    Backends::VULKAN
};

/// Returns all adapters, the best first: GPUs before software, and discrete GPUs before integrated ones (the other way
/// round if `WGPU_POWER_PREF=low`).
///
/// Only the backend of the platform is used: Metal, DX12, or Vulkan on all other systems. The environment variable
/// `WGPU_BACKEND` names other backends, such as `vulkan` on Windows. Validation layers are loaded only if
/// `WGPU_VALIDATION=1`. A browser offers one adapter or none.
pub async fn adapters() -> Vec<Adapter> {
    let descriptor = InstanceDescriptor {
        // The default would load validation layers in debug builds: they cost start-up time, and would have to be
        // installed on every machine.
        flags: wgpu::InstanceFlags::empty(),
        ..InstanceDescriptor::new_without_display_handle()
    };
    let mut descriptor = descriptor.with_env();
    if variable("WGPU_BACKEND").is_none() {
        descriptor.backends = PLATFORM_BACKEND;
    }
    let instance = Instance::new(descriptor);
    let mut adapters = instance.enumerate_adapters(Backends::all()).await;
    let low_power = PowerPreference::from_env() == Some(PowerPreference::LowPower);
    // The sort is stable, so adapters of equal rank keep the order of the driver.
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

/// Returns the adapters to try, the best first: the one with the given name, or all if there is no name.
///
/// # Errors
/// As for [`index_of_choice`].
pub async fn candidates(name: Option<&str>) -> Result<Vec<Adapter>, GpuError> {
    let mut adapters = adapters().await;
    let index = index_of_choice(&adapters, name)?;
    if name.is_some() || name_in_environment().is_some() {
        return Ok(vec![adapters.swap_remove(index)]);
    }
    Ok(adapters)
}

/// Returns the first of the [`candidates`].
///
/// # Errors
/// As for [`index_of_choice`].
pub async fn choose(name: Option<&str>) -> Result<Adapter, GpuError> {
    candidates(name).await?.into_iter().next().ok_or(GpuError::NoAdapter)
}

/// Returns the index of the adapter to use: the first whose name contains `name`, or the value of the environment
/// variable `WGPU_ADAPTER_NAME` if `name` is `None`. Upper and lower case are not distinguished. Without either, the
/// first adapter is chosen.
///
/// # Errors
/// If there is no adapter, or none with such a name.
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

/// The value of an environment variable. A variable with an empty value counts as not set.
fn variable(name: &str) -> Option<String> {
    std::env::var(name).ok().filter(|value| !value.is_empty())
}
