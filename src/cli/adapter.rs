//! The device in use, as reports name it.

use serde::Serialize;

use super::bench_report::{DEVICE_CLOCK, HOST_CLOCK};
use crate::gpu::Headless;

#[derive(Serialize)]
pub(super) struct AdapterReport {
    pub(super) name: String,
    pub(super) backend: String,
    pub(super) device_type: String,
    pub(super) driver: String,
    pub(super) driver_info: String,
}

impl AdapterReport {
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

    /// Which clock tells how long it works.
    pub(super) fn clock(&self) -> &'static str {
        if self.device_type == "Cpu" { HOST_CLOCK } else { DEVICE_CLOCK }
    }

    /// On one line.
    pub(super) fn line(&self) -> String {
        let Self { name, backend, device_type, driver, driver_info } = self;
        format!("{name} ({backend}, {device_type}), driver: {driver} {driver_info}")
    }
}
