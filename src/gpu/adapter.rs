//! Which adapters there are, and which one to use.

use wgpu::{Adapter, Backends, DeviceType, Instance, InstanceDescriptor, PowerPreference};

use super::error::GpuError;

/// Every adapter, the best first: real GPUs before software, and of real GPUs the discrete before the
/// integrated (the other way round if `WGPU_POWER_PREF=low`).
///
/// `WGPU_BACKEND` restricts the backends. Validation layers are loaded only if `WGPU_VALIDATION=1`.
#[must_use]
pub fn adapters() -> Vec<Adapter> {
    let descriptor = InstanceDescriptor {
        backends: Backends::VULKAN | Backends::METAL | Backends::DX12,
        // Not the default, which loads validation layers in debug builds: they cost start-up time,
        // and the same layers would have to be installed everywhere.
        flags: wgpu::InstanceFlags::empty(),
        ..InstanceDescriptor::new_without_display_handle()
    };
    let instance = Instance::new(descriptor.with_env());
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

/// The adapter that [`index_of_choice`] names.
///
/// # Errors
/// If there is no adapter, or none has such a name.
pub fn choose(name: Option<&str>) -> Result<Adapter, GpuError> {
    let mut adapters = adapters();
    let index = index_of_choice(&adapters, name)?;
    Ok(adapters.swap_remove(index))
}

/// Which of [`adapters`] to use: the best whose name contains `name`, or else the value of
/// `WGPU_ADAPTER_NAME`, regardless of case; without either, the best of all.
///
/// # Errors
/// If there is no adapter, or none has such a name.
pub fn index_of_choice(adapters: &[Adapter], name: Option<&str>) -> Result<usize, GpuError> {
    let from_environment = std::env::var("WGPU_ADAPTER_NAME").ok();
    let Some(wanted) = name.or(from_environment.as_deref()) else {
        return if adapters.is_empty() { Err(GpuError::NoAdapter) } else { Ok(0) };
    };
    let available: Vec<String> = adapters.iter().map(|a| a.get_info().name).collect();
    let wanted_lowercase = wanted.to_lowercase();
    available
        .iter()
        .position(|name| name.to_lowercase().contains(&wanted_lowercase))
        .ok_or_else(|| GpuError::UnknownAdapter { wanted: wanted.to_owned(), available })
}
