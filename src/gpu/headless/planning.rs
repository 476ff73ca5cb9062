//! Planning renders on a device, for every integrator. Drivers that are known to compute wrong results get another
//! structure. `docs/explain/drivers.md` contains the evidence.

use crate::accel::{AccelChoice, AccelPlan, Structure};
use crate::camera::View;
use crate::gpu::device_shape::DeviceLimits;
use crate::gpu::headless::Headless;
use crate::gpu::headless::plan::{PictureRequest, RenderPlan, StructurePlans};
use crate::gpu::scene::scene_buffers::search_limit;
use crate::image::LayerSet;
use crate::render::RenderSettings;
use crate::scene::Scene;

impl RenderPlan {
    /// Plans a picture on a device with the given limits and planned structures. A picture that is the only one
    /// of its scene may need none.
    #[must_use]
    pub fn new(request: &PictureRequest<'_>, structures: StructurePlans, device: &DeviceLimits) -> Self {
        if request.settings.integrator.is_primary() {
            Self::planned(request, structures.accel, device, false)
        } else if let Some(smooth) = request.smooth() {
            let of_ids = request.of_ids(&smooth);
            let of_caller = request.host_bytes_per_pixel.saturating_mul(request.view.film.pixel_count());
            let bytes = smooth.bytes().saturating_add(of_caller);
            let host_bytes_per_pixel = bytes.div_ceil(of_ids.view.film.pixel_count());
            Self::planned(&PictureRequest { host_bytes_per_pixel, ..of_ids }, structures.accel, device, false)
        } else {
            Self::of_lit(request, structures, device)
        }
    }
}

impl Headless {
    /// Plans the structures, buffers, tiles and host memory of a picture on this device. `choice` determines all
    /// structures, including the separate one for shadows that a studio needs if some spheres are not opaque.
    #[must_use]
    pub fn plan(&self, request: &PictureRequest<'_>, choice: AccelChoice) -> RenderPlan {
        let PictureRequest { scene, settings, .. } = *request;
        let accel = self.plan_accel(scene, choice);
        let opaque = settings.studio_parameters().and_then(|_| scene.opaque());
        let occluders = opaque.map(|opaque| self.plan_accel(&opaque, choice));
        let is_only = request.is_only && (choice == AccelChoice::Tiles || !self.leaves_loops_wrongly());
        let request = PictureRequest { is_only, ..*request };
        RenderPlan::new(&request, StructurePlans { accel, occluders }, &self.device_limits())
    }

    /// Plans [`Headless::record`] and the check of its recording, in the same way as [`Headless::plan`].
    /// `host_bytes_per_pixel` is explained in [`PictureRequest`].
    #[must_use]
    pub fn plan_record(
        &self,
        scene: &Scene,
        view: &View<'_>,
        choice: AccelChoice,
        host_bytes_per_pixel: u64,
    ) -> RenderPlan {
        let (settings, layers) = (&RenderSettings::default(), LayerSet::DATA);
        let request = PictureRequest { host_bytes_per_pixel, ..PictureRequest::new(scene, view, settings, layers) };
        let accel = self.plan_accel(scene, choice);
        RenderPlan::planned(&request, accel, &self.device_limits(), true)
    }

    /// Plans the structure of a scene for this device.
    #[must_use]
    pub fn plan_accel(&self, scene: &Scene, choice: AccelChoice) -> AccelPlan {
        let binding = search_limit(self.device());
        let planned = |choice| AccelPlan::new(scene.spheres(), choice, binding);
        let mut plan = planned(choice);
        // Grids are traversed in loops that invocations leave at different times. Trees are not.
        let is_grid = matches!(plan.structure, Structure::Grid | Structure::NestedGrid);
        if choice == AccelChoice::Auto && is_grid && self.leaves_loops_wrongly() {
            plan = planned(AccelChoice::Tree);
            plan.reason = format!("{} spheres, and this driver computes grids wrongly", scene.len());
        }
        match scene.whole() {
            Some(whole) => plan.within((whole.min, whole.max)),
            None => plan.with_cones(scene.cones(), binding),
        }
    }

    /// Whether this device has a defect of `SwiftShader` of Chromium 156: if invocations that run together leave a loop by
    /// `break` at different times, the first to leave lose the values that they assigned in the loop.
    fn leaves_loops_wrongly(&self) -> bool {
        self.info.name.starts_with("SwiftShader")
    }

    /// Returns the properties of this device that bound the size of pictures and scenes.
    #[must_use]
    pub fn device_limits(&self) -> DeviceLimits {
        let device_type = self.adapter_info().device_type;
        DeviceLimits { limits: self.device().limits(), device_type }
    }
}
