//! Records that cross to WGSL. Twins: the structs of the same names in `shaders/`.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use super::tiles::Tile;
use crate::camera::CameraVectors;
use crate::film::{Film, YAxis};
use crate::settings::{Settings, Shading};

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Camera {
    origin: [f32; 3],
    _pad0: u32,
    right: [f32; 3],
    _pad1: u32,
    up: [f32; 3],
    _pad2: u32,
    forward: [f32; 3],
    _pad3: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Frame {
    camera: Camera,
    background: [f32; 3],
    shading: u32,
    film_size: [u32; 2],
    tile_origin: [u32; 2],
    tile_size: [u32; 2],
    target_origin: [u32; 2],
    y_sign: f32,
    sphere_count: u32,
    _pad: [u32; 2],
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Slice {
    pub(super) first: u32,
    pub(super) count: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Hit {
    t: f32,
    id: u32,
}

/// Centre in the scene's frame, and radius: one `vec4f`.
pub(super) type Sphere = [f32; 4];

/// Linear red, green and blue, and an unused component: one `vec4f`.
pub(super) type Color = [f32; 4];

/// The distance of a miss; `NO_HIT` in `shaders/frame.wgsl`. Kernels have no infinity.
pub(super) const NO_HIT: f32 = 1e30;

impl Camera {
    /// Moves the camera into the scene's frame in f64, then narrows.
    fn new(vectors: &CameraVectors, scene_origin: DVec3) -> Self {
        let narrow = |v: DVec3| v.as_vec3().to_array();
        Self {
            origin: narrow(vectors.origin - scene_origin),
            right: narrow(vectors.right),
            up: narrow(vectors.up),
            forward: narrow(vectors.forward),
            ..Self::zeroed()
        }
    }
}

impl Frame {
    pub(super) fn new(
        vectors: &CameraVectors,
        scene_origin: DVec3,
        sphere_count: u32,
        film: &Film,
        tile: Tile,
        settings: &Settings,
    ) -> Self {
        Self {
            camera: Camera::new(vectors, scene_origin),
            background: settings.background().to_array(),
            shading: match settings.shading() {
                Shading::Flat => 0,
                Shading::Headlight => 1,
            },
            film_size: [film.width(), film.height()],
            tile_origin: tile.origin,
            tile_size: tile.size,
            target_origin: tile.in_target,
            y_sign: match film.y_axis() {
                YAxis::Up => 1.0,
                YAxis::Down => -1.0,
            },
            sphere_count,
            _pad: [0; 2],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shaders;

    /// Name, offset and size of every field, and the size of the whole.
    type Layout = (Vec<(String, usize, usize)>, usize);

    /// Fields are listed once, in the order of the struct; padding is left out.
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
            layout!(Camera { origin, right, up, forward }),
            layout!(Frame {
                camera,
                background,
                shading,
                film_size,
                tile_origin,
                tile_size,
                target_origin,
                y_sign,
                sphere_count
            }),
            layout!(Slice { first, count }),
            layout!(Hit { t, id }),
        ];
        for kernel in shaders::all_kernels() {
            let module = naga::front::wgsl::parse_str(&kernel.source()).unwrap();
            for (name, in_rust) in &records {
                // A kernel that does not use a record has no part that declares it.
                if kernel.source().contains(&format!("struct {name} ")) {
                    assert_eq!(
                        *in_rust,
                        layout_in_wgsl(&module, name),
                        "{name} of {}",
                        kernel.name()
                    );
                }
            }
        }
        let trace = shaders::trace_kernel(crate::camera::CameraKind::Pinhole).source();
        for (name, _) in &records {
            assert!(trace.contains(&format!("struct {name} ")), "no kernel declares {name}");
        }
    }

    #[test]
    fn a_miss_is_the_same_in_rust_and_wgsl() {
        let source = include_str!("../../shaders/frame.wgsl");
        assert!(source.contains(&format!("const NO_HIT: f32 = {NO_HIT:e};")));
        assert!(source.contains(&format!("const NO_ID: u32 = {:#x}u;", crate::image::NO_ID)));
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
        };
        let source = include_str!("../../shaders/shading.wgsl");
        for (shading, name) in [(Shading::Flat, "FLAT"), (Shading::Headlight, "HEADLIGHT")] {
            let settings = Settings::default().with_shading(shading);
            let frame = Frame::new(&vectors, DVec3::ZERO, 0, &film, tile, &settings);
            let constant = format!("const SHADING_{name}: u32 = {}u;", frame.shading);
            assert!(source.contains(&constant), "shading.wgsl lacks `{constant}`");
        }
    }
}
