//! The description of an adapter in reports.

use serde::Serialize;

#[cfg(feature = "gpu")]
use pinhole::gpu::Headless;
use pinhole::verify::run_file::Provenance;

/// Name of the device's own clock.
#[cfg(feature = "gpu")]
pub(super) const DEVICE_CLOCK: &str = "device";

/// Name of the host's clock. The clock of a software device measures when commands were queued, not when they ran.
#[cfg(feature = "gpu")]
const HOST_CLOCK: &str = "host";

#[derive(Serialize)]
pub(super) struct AdapterReport {
    pub(super) name: String,
    pub(super) backend: String,
    pub(super) device_type: String,
    pub(super) driver: String,
    pub(super) driver_info: String,
}

impl AdapterReport {
    #[cfg(feature = "gpu")]
    pub(super) fn of(headless: &Headless) -> Self {
        let info = headless.adapter_info();
        Self {
            name: info.name.clone(),
            backend: format!("{:?}", info.backend),
            device_type: format!("{:?}", info.device_type),
            driver: info.driver.clone(),
            driver_info: info.driver_info.clone(),
        }
    }

    /// Describes the adapter that rendered a saved run.
    pub(super) fn of_run(provenance: &Provenance) -> Self {
        let Provenance { adapter, backend, device_type, driver, driver_info, .. } = provenance;
        Self {
            name: adapter.clone(),
            backend: backend.clone(),
            device_type: device_type.clone(),
            driver: driver.clone(),
            driver_info: driver_info.clone(),
        }
    }

    /// Returns the clock that measures the work of this adapter.
    #[cfg(feature = "gpu")]
    pub(super) fn clock(&self) -> &'static str {
        if self.device_type == "Cpu" { HOST_CLOCK } else { DEVICE_CLOCK }
    }

    /// Describes the adapter on one line.
    pub(super) fn line(&self) -> String {
        let Self { name, backend, device_type, driver, driver_info } = self;
        format!("{name} ({backend}, {device_type}), driver: {driver} {driver_info}")
    }
}
