//! Records that the host writes and kernels read. Twins: the structs of the same names in `shaders/`.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

use crate::camera::View;
use crate::camera::film::{Film, YAxis};
use crate::geometry::bounds::Bounds;
use crate::gpu::device_shape::DeviceShape;
use crate::gpu::passes::tiles::{Groups, Tile};
use crate::gpu::shader::row_order::row_step;
use crate::recording::RequestedCamera;
use crate::render::{PrimarySettings, Shading};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Camera {
    pub(crate) origin: [f32; 3],
    pub(crate) advance: f32,
    pub(crate) right: [f32; 3],
    pub(crate) first: f32,
    pub(crate) up: [f32; 3],
    pub(crate) second: f32,
    pub(crate) forward: [f32; 3],
    pub(crate) third: f32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct FrameParameters {
    camera: Camera,
    background: [f32; 3],
    shading: u32,
    scene_min: [f32; 3],
    iteration_limit: u32,
    scene_max: [f32; 3],
    y_sign: f32,
    film_size: [u32; 2],
    tile_origin: [u32; 2],
    tile_size: [u32; 2],
    target_origin: [u32; 2],
    pub(crate) traced_first: [u32; 2],
    pub(crate) traced_size: [u32; 2],
    pub(crate) first_group: [u32; 2],
    row_step: u32,
    iteration_limit_again: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Brick {
    pub(crate) min: [f32; 3],
    pub(crate) cell_size: f32,
    pub(crate) cell_counts: [u32; 3],
    pub(crate) shape_count: u32,
    pub(crate) first_shape: u32,
    pub(crate) is_first: u32,
    pub(crate) last_appearance: u32,
    pub(crate) color_shift: u32,
    pub(crate) color_mask: u32,
    pub(crate) material_first: u32,
    pub(crate) material_mask: u32,
    pub(crate) first_reference: u32,
    pub(crate) crowd_min: [f32; 3],
    pub(crate) crowd_margin: f32,
    pub(crate) crowd_max: [f32; 3],
    pub(crate) unused: u32,
}

/// The status word, which is nonzero if an invocation reached its iteration limit.
pub(crate) type Status = u32;

/// A hit, which is a `vec4u`: the bits of t, the id, the shape index, and the bits of the distance to the ray's origin.
pub(crate) type Hit = [u32; 4];

/// The two recorded rays of a pixel: the ray that was traced, and the ray with which the hit was shaded. Each is two
/// `vec4f`: origin and distance; direction, and a number that is nonzero if there is a ray.
pub(crate) type RecordedRays = [f32; 16];

/// The position of a scene: the origin of its frame in world space, and its bounds there, to which rays are moved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SceneSpace {
    pub(crate) origin: DVec3,
    pub(crate) min: Vec3,
    pub(crate) max: Vec3,
}

impl SceneSpace {
    /// The box's corners, in the scene's frame.
    pub(crate) fn corners(&self) -> [DVec3; 8] {
        Bounds::between(self.min.as_dvec3(), self.max.as_dvec3()).corners()
    }
}

/// A sphere, which is a `vec4f`: its centre in the scene's frame, and its radius.
pub(crate) type Sphere = [f32; 4];

/// A colour, which is a `vec4f`: linear red, green and blue, and alpha.
pub(crate) type Color = [f32; 4];

/// The value for transparent misses, `SHADING_TRANSPARENT` in `shaders/primary/shading.wgsl`.
const SHADING_TRANSPARENT: u32 = 2;

/// Distance of a miss, `NO_HIT` in `shaders/scene/frame.wgsl`.
pub(crate) use crate::recording::NO_HIT;

impl Camera {
    /// Computes the record in f64 and rounds it to f32: the camera is transformed to the scene's frame and moved along
    /// its forward vector up to the scene's box, if its rays can start there.
    pub(crate) fn new(camera: &RequestedCamera, scene: &SceneSpace) -> Self {
        let RequestedCamera { kind, vectors } = camera;
        let narrow = |v: DVec3| v.as_vec3().to_array();
        let origin = vectors.origin - scene.origin;
        let forward = vectors.forward;
        // The distance to the plane through the nearest corner of the box, in units of the length of `forward`.
        let across = vectors.right.cross(vectors.up);
        let nearest = scene
            .corners()
            .map(|corner| (corner - origin).dot(across) / forward.dot(across))
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        let nearest = if kind.is_linear() { nearest.max(0.0) } else { 0.0 };
        let advance = f64::from(nearest as f32);
        let [first, second, third] = vectors.numbers.map(|number| number as f32);
        Self {
            origin: narrow(origin + advance * forward),
            advance: advance as f32,
            right: narrow(vectors.right),
            up: narrow(vectors.up),
            forward: narrow(forward),
            first,
            second,
            third,
        }
    }
}

impl FrameParameters {
    pub(crate) fn new(
        camera: &RequestedCamera,
        scene: &SceneSpace,
        film: &Film,
        tile: Tile,
        traced: Groups,
        primary: &PrimarySettings,
        iteration_limit: u32,
    ) -> Self {
        Self {
            camera: Camera::new(camera, scene),
            scene_min: scene.min.to_array(),
            scene_max: scene.max.to_array(),
            iteration_limit,
            traced_first: traced.first,
            traced_size: traced.size,
            first_group: [0, 0],
            row_step: row_step(traced.size[1]),
            iteration_limit_again: iteration_limit,
            background: primary.background.to_array(),
            shading: match primary.shading {
                Shading::Flat => 0,
                Shading::Headlight => 1,
            } + if primary.is_transparent { SHADING_TRANSPARENT } else { 0 },
            film_size: [film.whole().width(), film.whole().height()],
            tile_origin: film.in_whole(tile.origin),
            tile_size: tile.size,
            target_origin: tile.in_target,
            y_sign: match film.y_axis() {
                YAxis::Up => 1.0,
                YAxis::Down => -1.0,
            },
        }
    }
}

impl FrameParameters {
    /// Returns the record with the order of rows that suits a device.
    pub(crate) fn in_order_of(self, shape: DeviceShape) -> Self {
        let row_step = if shape.spreads_rows { self.row_step } else { 1 };
        Self { row_step, ..self }
    }

    /// The record for lit pictures. Other records determine their colours.
    pub(crate) fn of_tile(
        view: &View<'_>,
        scene: &SceneSpace,
        tile: Tile,
        traced: Groups,
        iteration_limit: u32,
    ) -> Self {
        let (camera, primary) = (RequestedCamera::of(view.camera), PrimarySettings::default());
        Self::new(&camera, scene, &view.film, tile, traced, &primary, iteration_limit)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::camera::{CameraKind, CameraVectors};
    use crate::gpu::headless::denoise::Denoise;
    use crate::gpu::host::host_view::HostView;
    use crate::gpu::kernels;
    use crate::gpu::passes::lit::records::{DispatchParameters, LightingParameters};
    use crate::gpu::scene::recolor::RecolorRange;
    use crate::gpu::self_test::records::{Arithmetic, Exact, Loop, Operands, SelfTest, Values};
    use crate::recording::cone_rays::{ConeAnswer, RayAndCone};

    /// The name, offset and size of every field, and the size of the struct.
    type Layout = (Vec<(String, usize, usize)>, usize);

    /// Implements the trait from the list of fields, in the order of the struct and without padding.
    macro_rules! layout {
        ($record:ident { $($field:ident),+ }) => {{
            let record = $record::zeroed();
            let fields = vec![$((
                stringify!($field).to_owned(),
                std::mem::offset_of!($record, $field),
                std::mem::size_of_val(&record.$field),
            )),+];
            (stringify!($record), (fields, size_of::<$record>()))
        }};
    }

    fn layout_in_wgsl(module: &naga::Module, name: &str) -> Layout {
        let (_, ty) = module
            .types
            .iter()
            .find(|(_, ty)| ty.name.as_deref() == Some(name))
            .unwrap_or_else(|| panic!("WGSL has no struct {name}"));
        let naga::TypeInner::Struct { members, span } = &ty.inner else {
            panic!("{name} is no struct in WGSL");
        };
        let fields = members
            .iter()
            .map(|member| {
                let size = module.types[member.ty].inner.size(module.to_ctx());
                (member.name.clone().unwrap(), member.offset as usize, size as usize)
            })
            .collect();
        (fields, *span as usize)
    }

    #[test]
    fn records_are_the_same_in_rust_and_wgsl() {
        let records = [
            layout!(Camera { origin, advance, right, first, up, second, forward, third }),
            layout!(FrameParameters {
                camera,
                background,
                shading,
                scene_min,
                iteration_limit,
                scene_max,
                y_sign,
                film_size,
                tile_origin,
                tile_size,
                target_origin,
                traced_first,
                traced_size,
                first_group,
                row_step,
                iteration_limit_again
            }),
            layout!(Brick {
                min,
                cell_size,
                cell_counts,
                shape_count,
                first_shape,
                is_first,
                last_appearance,
                color_shift,
                color_mask,
                material_first,
                material_mask,
                first_reference,
                crowd_min,
                crowd_margin,
                crowd_max,
                unused
            }),
            layout!(SelfTest { limit, limit_again, single, outer, inner }),
            layout!(Operands { a, b, p, q, factor, dividend, divisor, radicand, u, v }),
            layout!(Arithmetic {
                sum,
                back,
                error,
                unfenced_error,
                scaled,
                difference,
                product,
                quotient,
                root,
                inverse_root,
                dot
            }),
            layout!(Values { f, g, whole, i, j, small, other, scale, tiny, speck }),
            layout!(Exact {
                from_whole,
                truncated,
                unsigned,
                floored,
                smaller,
                larger,
                selected,
                comparisons,
                bits,
                from_bits,
                added,
                subtracted,
                multiplied,
                divided,
                remainder,
                shifted_left,
                shifted_right,
                ones,
                lowest,
                tiny_difference,
                tiny_product,
                tiny_sum
            }),
            layout!(RayAndCone { origin, direction, cone }),
            layout!(ConeAnswer { normal, t }),
            layout!(Loop { count, state }),
            layout!(Denoise { size, step, zero }),
            layout!(HostView { column, is_parallel, row, slope, forward, far, film_depth, zero, size, first_pixel }),
            layout!(DispatchParameters {
                sample,
                surface,
                is_last,
                light,
                count,
                list,
                is_new,
                paths,
                first,
                visible_first,
                visible_size
            }),
            layout!(RecolorRange { first, count, shape_count, zero }),
            layout!(LightingParameters {
                background,
                flags,
                ambient,
                light_count,
                zenith,
                roulette_from,
                horizon,
                source_count,
                nadir,
                light_sampling,
                cue_color,
                cue_near,
                ground_normal,
                cue_scale,
                ground_point,
                occlusion_radius,
                ground_color,
                occlusion_samples,
                seed,
                emitter_count,
                material_first,
                lamp_sources,
                environment_size,
                environment_rotation,
                environment_strength,
                filter_table
            }),
        ];
        let mut declared = BTreeSet::new();
        for kernel in kernels::all_kernels() {
            let source = kernel.source();
            let module = naga::front::wgsl::parse_str(&source).unwrap();
            for (name, in_rust) in &records {
                // A kernel that does not use a record does not declare it.
                if source.contains(&format!("struct {name} ")) {
                    declared.insert(*name);
                    assert_eq!(*in_rust, layout_in_wgsl(&module, name), "{name} of {}", kernel.name());
                }
            }
        }
        for (name, _) in &records {
            assert!(declared.contains(name), "no kernel declares {name}");
        }
    }

    #[test]
    fn shading_numbers_are_the_same_in_rust_and_wgsl() {
        let film = Film::new(1, 1).unwrap();
        let tile = Tile { origin: [0, 0], size: [1, 1], in_target: [0, 0] };
        let vectors = CameraVectors {
            origin: DVec3::ZERO,
            right: DVec3::X,
            up: DVec3::Y,
            forward: DVec3::NEG_Z,
            numbers: [0.0; 3],
        };
        let source = include_str!("../../../shaders/primary/shading.wgsl");
        assert!(source.contains(&format!("const SHADING_TRANSPARENT: u32 = {SHADING_TRANSPARENT}u;")));
        for (shading, name) in [(Shading::Flat, "FLAT"), (Shading::Headlight, "HEADLIGHT")] {
            let primary = PrimarySettings { shading, ..PrimarySettings::default() };
            let scene = SceneSpace { origin: DVec3::ZERO, min: Vec3::ZERO, max: Vec3::ZERO };
            let camera = RequestedCamera { kind: CameraKind::Pinhole, vectors };
            let frame = FrameParameters::new(&camera, &scene, &film, tile, Groups::of_size([1, 1]), &primary, 0);
            let constant = format!("const SHADING_{name}: u32 = {}u;", frame.shading);
            assert!(source.contains(&constant), "shading.wgsl lacks `{constant}`");
        }
    }
}
