//! Planning the memory that a lit picture needs on the device and on the host.

use crate::accel::{AccelPlan, PlannedBuffer};
use crate::gpu::device_shape::DeviceLimits;
use crate::gpu::headless::plan::{
    BUILDING, PICTURE, PictureRequest, RenderPlan, StructurePlans, UPLOADING, scene_buffers, tile_count, total,
};
use crate::gpu::passes::emitter_table;
use crate::gpu::passes::lit::lighting::LightingData;
use crate::gpu::passes::lit::records::{GROUPS_NEEDED, LitSizes};
use crate::gpu::scene::scene_summary::SceneSummary;
use crate::scene::Scene;

impl RenderPlan {
    /// Plans a lit picture.
    pub(crate) fn of_lit(
        request: &PictureRequest<'_>,
        StructurePlans { accel, occluders }: StructurePlans,
        device: &DeviceLimits,
    ) -> Self {
        let PictureRequest { scene, view, settings, host_bytes_per_pixel, .. } = *request;
        let (film, limits) = (&view.film, &device.limits);
        let layers = settings.layers_for(request.layers);
        // Depth, normals and ids are rendered first, with one ray for each pixel. The buffers
        // of this render are then freed.
        let data = Self::planned(&PictureRequest { layers, ..*request }, accel, device, false);
        let data_bytes = total(&data.tile_buffers) + total(&data.tile_textures);
        let all_buffers = data.scene_buffers;
        let shadows = occluders.as_ref().map_or(Vec::new(), |plan| shadow_buffers(scene, plan));
        let scene_buffers = [&all_buffers[..], &shadows].concat();

        let summary = SceneSummary::of(scene);
        let lighting = LightingData::new(settings, &summary, view.camera);
        let sizes = LitSizes::new(limits, device.shape(), film, lighting.mode, settings.sampling.samples);
        let tile_size = sizes.tile;
        let tile_count = tile_count(film, tile_size);
        let film_bytes = sizes.film_bytes();
        let mut tile_buffers = vec![
            PlannedBuffer::one("paths", sizes.path_bytes()),
            PlannedBuffer::one("lists", sizes.queue_bytes() + GROUPS_NEEDED),
            // The sums of all tiles stay allocated.
            PlannedBuffer { name: "sums", bytes: film_bytes * tile_count, bytes_per_binding: film_bytes },
            PlannedBuffer::one("variations", 2 * sizes.variation_bytes()),
            PlannedBuffer::one("tables", lighting.table_bytes()),
        ];
        let sky = lighting.sky.as_ref().map_or(0, |sky| {
            let texels = 16 * sky.texels().len() as u64;
            let shares = 4 * (sky.rows().len() + sky.columns().len()) as u64;
            tile_buffers.push(PlannedBuffer::one("sky", texels));
            tile_buffers.push(PlannedBuffer::one("sky shares", shares));
            texels + shares
        });
        let mut tile_textures = vec![PlannedBuffer::one("sums read-back", film_bytes)];
        tile_textures.extend(emitter_table::planned(lighting.emitters.len()));
        // The table itself, its copy that is queued for the device, and the emissive spheres from which it was made.
        let emitters = (2 * size_of_val(&lighting.emitters[..])) as u64
            + summary.emissive.len() as u64 * SceneSummary::BYTES_PER_EMITTER;
        let scene_bytes = total(&scene_buffers);
        let tile_bytes = (total(&tile_buffers) + total(&tile_textures)).max(data_bytes);

        let in_host = |bytes| device.in_host(bytes);
        let phases = [DeviceLimits::building_bytes, DeviceLimits::uploading_bytes];
        let of_all = phases.map(|bytes| bytes(device, &data.accel, &all_buffers));
        // The second structure is built from a copy of its spheres and their ids, while the device has the first.
        let [building, uploading] = [0, 1].map(|phase| {
            let of_occluders = occluders.as_ref().map_or(0, |plan| {
                let before = in_host(total(&all_buffers)) + 20 * plan.statistics.count as u64;
                before + phases[phase](device, plan, &shadows)
            });
            of_all[phase].max(of_occluders)
        });
        // The coverage of the outline takes 4 bytes. The memory of the caller is needed later.
        let beside = host_bytes_per_pixel.max(4);
        let per_pixel = layers.bytes_per_pixel().saturating_add(beside);
        // The image of the sky is converted to four components, and its copy is queued for the device.
        let picture = film.pixel_count().saturating_mul(per_pixel).saturating_add(2 * sky + emitters);
        let moments = [
            (BUILDING, building),
            (UPLOADING, uploading),
            (PICTURE, picture.saturating_add(in_host(scene_bytes + tile_bytes))),
        ];
        let worst = moments.into_iter().max_by_key(|(_, bytes)| *bytes);
        let (host_peak, host_bytes) = worst.unwrap_or((PICTURE, 0));
        Self {
            accel: data.accel,
            by_tiles: false,
            occluders,
            scene_buffers,
            tile_buffers,
            tile_textures,
            tile_size,
            tile_count,
            device_bytes: scene_bytes + tile_bytes,
            host_bytes,
            host_peak,
        }
    }
}

/// The buffers of the structure of occluders. Its only appearance data are a palette of one colour.
fn shadow_buffers(scene: &Scene, plan: &AccelPlan) -> Vec<PlannedBuffer> {
    scene_buffers(scene, plan.buffers.clone()).into_iter().filter(|buffer| buffer.name != "colors").collect()
}

#[cfg(test)]
mod tests {
    use wgpu::{DeviceType, Limits};

    use crate::gpu::device_shape::DeviceShape;

    use super::super::kernels::Mode;
    use super::*;
    use crate::accel::AccelChoice;
    use crate::camera::film::Film;
    use crate::camera::{PinholeCamera, Pose, View};
    use crate::image::color::LinearRgb;
    use crate::image::{Layer, LayerSet};
    use crate::light::environment::Environment;
    use crate::light::{Sky, SkyLight};
    use crate::render::{Integrator, Outline, RenderSettings, Studio};
    use crate::scene::sphere::Sphere;

    fn planned(opacity: f32, size: u32, settings: &RenderSettings, device_type: DeviceType) -> RenderPlan {
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
        let occluders = scene.opaque().map(|opaque| plan(&opaque));
        let structures = StructurePlans { accel: plan(&scene), occluders };
        let device = DeviceLimits { limits: Limits::default(), device_type };
        let request = PictureRequest {
            is_only: false,
            is_shaded: true,
            scene: &scene,
            view: View::new(&camera, film),
            settings,
            layers: LayerSet::COLOR,
            host_bytes_per_pixel: 16,
        };
        RenderPlan::of_lit(&request, structures, &device)
    }

    fn bytes(plan: &RenderPlan, name: &str) -> u64 {
        let all = plan.scene_buffers.iter().chain(&plan.tile_buffers).chain(&plan.tile_textures);
        all.filter(|buffer| buffer.name == name).map(|buffer| buffer.bytes).sum()
    }

    const GPU: DeviceType = DeviceType::IntegratedGpu;

    #[test]
    fn a_tile_takes_its_paths_and_every_pixel_its_sums() {
        let settings = RenderSettings::studio();
        let plan = planned(1.0, 512, &settings, GPU);
        assert_eq!((plan.tile_size, plan.tile_count), ([512, 256], 2));
        let pixels = 1 << 18;
        // Four samples of every pixel of a tile are in flight, with ten vectors each.
        assert_eq!(bytes(&plan, "paths"), 4 * 160 * pixels / 2);
        assert_eq!(bytes(&plan, "lists"), 4 * 12 * pixels / 2 + 16 + 24);
        assert_eq!((bytes(&plan, "sums"), bytes(&plan, "sums read-back")), (48 * pixels, 48 * pixels / 2));
        let all = plan.scene_buffers.iter().chain(&plan.tile_buffers).chain(&plan.tile_textures);
        assert_eq!(plan.device_bytes, all.map(|buffer| buffer.bytes).sum::<u64>());
        assert_eq!(plan.host_bytes, (12 + 16) * pixels);
        assert_eq!(plan.check(&Limits::default(), None), Ok(()));

        let software = planned(1.0, 512, &settings, DeviceType::Cpu);
        assert_eq!(software.host_bytes, plan.host_bytes + plan.device_bytes);
    }

    #[test]
    fn paths_have_only_the_slots_that_the_lighting_needs() {
        let at_most = |settings: &RenderSettings| bytes(&planned(1.0, 512, settings, GPU), "paths");
        let lighting = RenderSettings::path();
        let sky_alone = RenderSettings { lights: Vec::new(), ..RenderSettings::path() };
        assert_eq!(at_most(&RenderSettings::studio()), 160 << 19);
        assert_eq!(at_most(&lighting), 144 << 19);
        assert_eq!(at_most(&sky_alone), 112 << 19);
    }

    /// Large GPUs trace more paths together, as many as fit into a binding.
    #[test]
    fn a_gpu_with_memory_of_its_own_has_more_paths() {
        let studio = &RenderSettings::studio();
        let plan = |device| planned(1.0, 4096, studio, device);
        let [small, large] = [GPU, DeviceType::DiscreteGpu].map(plan);
        assert!(bytes(&large, "paths") > bytes(&small, "paths"));
        assert!(large.tile_count < small.tile_count);
        assert!(bytes(&large, "paths") <= 128 << 20, "the limit of WebGPU");
    }

    #[test]
    fn large_pictures_are_divided_into_tiles() {
        let plan = planned(1.0, 4096, &RenderSettings::studio(), GPU);
        assert!(bytes(&plan, "paths") <= 160 << 19);
        assert!(plan.tile_count >= 32);
        assert!(bytes(&plan, "sums") >= 48 << 24, "those of all tiles stay");
        let low = Limits { max_storage_buffer_binding_size: 1 << 20, ..Limits::default() };
        let film = Film::new(4096, 4096).unwrap();
        let sizes = LitSizes::new(&low, DeviceShape::of(GPU), &film, Mode::Studio, 16);
        assert!(sizes.path_bytes().max(sizes.film_bytes()) <= 1 << 20, "{sizes:?}");
    }

    #[test]
    fn shadows_of_some_spheres_have_a_structure_of_their_own() {
        let settings = RenderSettings::studio();
        let opaque = planned(1.0, 64, &settings, GPU);
        let clear = planned(0.5, 64, &settings, GPU);
        assert_eq!(bytes(&opaque, "spheres"), 16_000);
        assert_eq!(bytes(&clear, "spheres"), 16_000 + 14_400);
    }

    #[test]
    fn an_outline_needs_the_layers_that_it_is_computed_from() {
        let mut settings = RenderSettings::studio();
        let before = planned(1.0, 512, &settings, GPU);
        let studio = Studio { outline: Some(Outline::default()), ..Studio::default() };
        settings.integrator = Integrator::Studio(studio);
        let after = planned(1.0, 512, &settings, GPU);
        let layers = Outline::default().layers().bytes_per_pixel() - Layer::Color.bytes_per_pixel();
        assert_eq!(after.host_bytes, before.host_bytes + (layers << 18));
    }

    /// Emissive spheres are in a texture, which no limit of buffers bounds.
    #[test]
    fn emitters_are_bounded_by_the_layers_of_a_texture() {
        let settings = RenderSettings::path();
        let mut plan = planned(1.0, 64, &settings, GPU);
        assert_eq!(bytes(&plan, emitter_table::NAME), 0);
        plan.tile_textures.extend(emitter_table::planned(3 * 300_000_000));
        let limits = Limits::default();
        assert_eq!(plan.check(&limits, None), Ok(()));
        let low = Limits { max_texture_array_layers: 200, ..limits };
        let refused = plan.check(&low, None).unwrap_err().to_string();
        assert!(refused.starts_with("the table of emissive spheres needs 14"), "{refused}");
    }

    #[test]
    fn only_paths_need_the_image_of_a_sky() {
        let environment = Environment::new(1024, 512, vec![[1.0; 3]; 1024 * 512]).unwrap();
        let light = SkyLight::Image { environment: environment.into(), strength: 1.0, rotation: 0.0 };
        let sky = Sky { light, is_visible: true };
        let studio = planned(1.0, 64, &RenderSettings::studio(), GPU);
        let settings = RenderSettings { sky, ..RenderSettings::path() };
        let path = planned(1.0, 16, &settings, GPU);
        assert_eq!((bytes(&studio, "sky"), bytes(&path, "sky")), (0, 16 << 19));
        assert_eq!(bytes(&path, "sky shares"), 4 * (513 + 1025 * 512));
        let low = Limits { max_storage_buffer_binding_size: 6 << 20, ..Limits::default() };
        let refused = path.check(&low, None).unwrap_err().to_string();
        assert!(refused.starts_with("the image of the sky"), "{refused}");
    }
}
