//! What a lit picture will take of the device and of the host.

use wgpu::{DeviceType, Limits};

use super::film::BYTES_PER_PIXEL;
use super::look::Lit;
use super::records::{FILM_SLOTS, PATH_SLOTS};
use super::tile::{lit_tile_size, sky_image};
use crate::accel::{AccelPlan, PlannedBuffer};
use crate::camera::Camera;
use crate::film::Film;
use crate::gpu::headless::Headless;
use crate::gpu::plan::{HostPeak, RenderPlan, scene_buffers, tile_count, total};
use crate::gpu::records::Hit;
use crate::image::LayerSet;
use crate::lighting::Lighting;
use crate::scene::Scene;

/// Bytes of a pixel's sums as they come from a tile.
const FOUND_BYTES: u64 = 16 * FILM_SLOTS;

impl RenderPlan {
    /// As [`RenderPlan::new`], of a lit picture. `opaque` is of the spheres that cast shadows, unless that is all.
    #[must_use]
    pub fn of_lit(
        scene: &Scene,
        (camera, film): (&dyn Camera, &Film),
        lighting: &Lighting,
        layers: LayerSet,
        (accel, opaque): (AccelPlan, Option<AccelPlan>),
        (limits, device_type): (&Limits, DeviceType),
        host_bytes_per_pixel: u64,
    ) -> Self {
        let layers = lighting.layers_for(layers);
        // Depth, normals and ids are rendered first, by one ray a pixel; then that tile is gone.
        let device = (limits, device_type);
        let data = Self::new(scene, film, layers, accel, device, host_bytes_per_pixel);
        let data_bytes = total(&data.tile_buffers) + total(&data.tile_textures);
        let mut scene_buffers = data.scene_buffers;
        let shadows = opaque.as_ref().map_or(Vec::new(), |opaque| shadow_buffers(scene, opaque));
        scene_buffers.extend(shadows);

        let tile_size = lit_tile_size(limits, film);
        let pixels = u64::from(tile_size[0]) * u64::from(tile_size[1]);
        let mut tile_buffers = vec![
            PlannedBuffer::one("hits", pixels * size_of::<Hit>() as u64),
            PlannedBuffer::one("paths", pixels * 16 * PATH_SLOTS),
            PlannedBuffer::one("film", pixels * FOUND_BYTES),
            PlannedBuffer::one("tables", Lit::new(lighting, scene, camera).table_bytes()),
        ];
        let sky = sky_image(lighting).map_or(0, |sky| {
            let texels = 16 * sky.texels().len() as u64;
            let shares = 4 * (sky.rows().len() + sky.columns().len()) as u64;
            tile_buffers.push(PlannedBuffer::one("sky", texels));
            tile_buffers.push(PlannedBuffer::one("sky shares", shares));
            texels + shares
        });
        let tile_textures = vec![PlannedBuffer::one("film read-back", pixels * FOUND_BYTES)];
        let scene_bytes = total(&scene_buffers);
        let tile_bytes = (total(&tile_buffers) + total(&tile_textures)).max(data_bytes);

        let in_host = |bytes| if device_type == DeviceType::Cpu { bytes } else { 0 };
        let opaque_bytes = opaque.as_ref().map_or(0, AccelPlan::device_bytes);
        // What is built second is built beside the first, from a copy of its spheres.
        let building = opaque.as_ref().map_or(0, |opaque| {
            let spheres = 16 * opaque.statistics.count as u64;
            data.accel.device_bytes() + spheres + opaque.host_bytes()
        });
        let queued: u64 = scene_buffers.iter().map(|buffer| buffer.bytes_per_binding).sum();
        let uploading = data.accel.device_bytes() + opaque_bytes + queued;
        // Sums, those of one batch, and coverage by lines; or what the caller makes of the picture.
        let beside = host_bytes_per_pixel.max(BYTES_PER_PIXEL + FOUND_BYTES + 4);
        let per_pixel = layers.bytes_per_pixel().saturating_add(beside);
        // An image is widened, and then waits for the device.
        let picture = film.pixel_count().saturating_mul(per_pixel).saturating_add(2 * sky);
        let moments = [
            (HostPeak::Building, data.accel.host_bytes().max(building + in_host(scene_bytes))),
            (HostPeak::Uploading, uploading + in_host(scene_bytes)),
            (HostPeak::Picture, picture.saturating_add(in_host(scene_bytes + tile_bytes))),
        ];
        let worst = moments.into_iter().max_by_key(|(_, bytes)| *bytes);
        let (host_peak, host_bytes) = worst.unwrap_or((HostPeak::Picture, 0));
        Self {
            accel: data.accel,
            scene_buffers,
            tile_buffers,
            tile_textures,
            tile_size,
            tile_count: tile_count(film, tile_size),
            device_bytes: scene_bytes + tile_bytes,
            host_bytes,
            host_peak,
        }
    }
}

/// Of the structure for shadows; nothing is shaded in it but a palette of one colour.
fn shadow_buffers(scene: &Scene, opaque: &AccelPlan) -> Vec<PlannedBuffer> {
    scene_buffers(scene, opaque).into_iter().filter(|buffer| buffer.name != "colors").collect()
}

impl Headless {
    /// What a lit picture will take on this device, of a scene in the structure that [`Headless::plan`] planned.
    /// `host_bytes_per_pixel` is as in [`RenderPlan::new`].
    #[must_use]
    pub fn plan_lit(
        &self,
        scene: &Scene,
        accel: AccelPlan,
        view: (&dyn Camera, &Film),
        lighting: &Lighting,
        layers: LayerSet,
        host_bytes_per_pixel: u64,
    ) -> RenderPlan {
        let limits = self.device().limits();
        let device = (&limits, self.adapter_info().device_type);
        let choice = accel.structure.choice();
        let opaque = scene.opaque().map(|opaque| self.plan(&opaque, choice));
        let plans = (accel, opaque);
        RenderPlan::of_lit(scene, view, lighting, layers, plans, device, host_bytes_per_pixel)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::AccelChoice;
    use crate::camera::{PinholeCamera, Pose};
    use crate::color::LinearRgb;
    use crate::environment::Environment;
    use crate::image::Layer;
    use crate::lighting::{Integrator, Outline, PathTracing, Sky, SkyLight, Studio};
    use crate::outline;
    use crate::sphere::Sphere;

    fn planned(
        opacity: f32,
        size: u32,
        lighting: &Lighting,
        layers: LayerSet,
        device_type: DeviceType,
    ) -> RenderPlan {
        let spheres: Vec<Sphere> = (0..1000)
            .map(|i| {
                let sphere = Sphere::new([f64::from(i), 0.0, 0.0], 0.5, LinearRgb::WHITE);
                if i < 100 { sphere.with_opacity(opacity) } else { sphere }
            })
            .collect();
        let scene = Scene::new(&spheres).unwrap();
        let plan = |scene: &Scene| AccelPlan::new(scene.spheres(), AccelChoice::List, 1 << 27);
        let film = Film::new(size, size).unwrap();
        let pose = Pose::looking_at([0.0, 0.0, 9.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
        let camera = PinholeCamera::with_vertical_fov(pose, 0.5, 1.0).unwrap();
        let plans = (plan(&scene), scene.opaque().map(|opaque| plan(&opaque)));
        let device = (&Limits::default(), device_type);
        RenderPlan::of_lit(&scene, (&camera, &film), lighting, layers, plans, device, 16)
    }

    fn bytes(plan: &RenderPlan, name: &str) -> u64 {
        let all = plan.scene_buffers.iter().chain(&plan.tile_buffers).chain(&plan.tile_textures);
        all.filter(|buffer| buffer.name == name).map(|buffer| buffer.bytes).sum()
    }

    const GPU: DeviceType = DeviceType::DiscreteGpu;

    #[test]
    fn a_tile_takes_its_paths_and_sums() {
        let lighting = Lighting::default();
        let plan = planned(1.0, 512, &lighting, LayerSet::COLOR, GPU);
        assert_eq!((plan.tile_size, plan.tile_count), ([512, 512], 1));
        let pixels = 1 << 18;
        assert_eq!(bytes(&plan, "paths"), 16 * PATH_SLOTS * pixels);
        assert_eq!(bytes(&plan, "hits"), 16 * pixels);
        assert_eq!(
            (bytes(&plan, "film"), bytes(&plan, "film read-back")),
            (32 * pixels, 32 * pixels)
        );
        let all = plan.scene_buffers.iter().chain(&plan.tile_buffers).chain(&plan.tile_textures);
        assert_eq!(plan.device_bytes, all.map(|buffer| buffer.bytes).sum::<u64>());
        assert_eq!(plan.host_bytes, (12 + 56 + 32 + 4) * pixels);
        assert_eq!(plan.check(&Limits::default(), None), Ok(()));

        let software = planned(1.0, 512, &lighting, LayerSet::COLOR, DeviceType::Cpu);
        assert_eq!(software.host_bytes, plan.host_bytes + plan.device_bytes);
    }

    #[test]
    fn what_is_larger_than_a_tile_is_cut() {
        let plan = planned(1.0, 4096, &Lighting::default(), LayerSet::COLOR, GPU);
        assert!(bytes(&plan, "paths") <= (16 * PATH_SLOTS) << 19);
        assert!(plan.tile_count >= 32);
        let low = Limits { max_storage_buffer_binding_size: 1 << 20, ..Limits::default() };
        let size = lit_tile_size(&low, &Film::new(4096, 4096).unwrap());
        assert!(u64::from(size[0] * size[1]) * 16 * PATH_SLOTS <= 1 << 20, "{size:?}");
    }

    #[test]
    fn shadows_of_some_spheres_have_a_structure_of_their_own() {
        let lighting = Lighting::default();
        let opaque = planned(1.0, 64, &lighting, LayerSet::COLOR, GPU);
        let clear = planned(0.5, 64, &lighting, LayerSet::COLOR, GPU);
        assert_eq!(bytes(&opaque, "spheres"), 16_000);
        assert_eq!(bytes(&clear, "spheres"), 16_000 + 14_400);
    }

    #[test]
    fn lines_take_the_layers_that_they_are_found_by() {
        let mut lighting = Lighting::default();
        let before = planned(1.0, 512, &lighting, LayerSet::COLOR, GPU);
        let studio = Studio { outline: Some(Outline::default()), ..Studio::default() };
        lighting.integrator = Integrator::Studio(studio);
        let after = planned(1.0, 512, &lighting, LayerSet::COLOR, GPU);
        let layers = outline::LAYERS.bytes_per_pixel() - Layer::Color.bytes_per_pixel();
        assert_eq!(after.host_bytes, before.host_bytes + (layers << 18));
    }

    #[test]
    fn only_paths_need_the_image_of_a_sky() {
        let environment = Environment::new(1024, 512, vec![[1.0; 3]; 1024 * 512]).unwrap();
        let light =
            SkyLight::Image { environment: environment.into(), strength: 1.0, rotation: 0.0 };
        let sky = Sky { light, is_visible: true };
        let mut lighting = Lighting { sky, ..Lighting::default() };
        let studio = planned(1.0, 64, &lighting, LayerSet::COLOR, GPU);
        lighting.integrator = Integrator::Path(PathTracing::default());
        let path = planned(1.0, 64, &lighting, LayerSet::COLOR, GPU);
        assert_eq!((bytes(&studio, "sky"), bytes(&path, "sky")), (0, 16 << 19));
        assert_eq!(bytes(&path, "sky shares"), 4 * (513 + 1025 * 512));
        let low = Limits { max_storage_buffer_binding_size: 1 << 22, ..Limits::default() };
        let refused = path.check(&low, None).unwrap_err().to_string();
        assert!(refused.starts_with("the image of the sky"), "{refused}");
    }
}
