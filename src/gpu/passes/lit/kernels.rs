//! The kernels of lit pictures. `shaders/README.md` lists them, and `shaders/kernels.txt` their parts.

use std::collections::HashSet;

use crate::accel::{BrickKind, Primitive, Structure};
use crate::camera::CameraKind;
use crate::gpu::scene::scene_summary::ExcludeBy;
use crate::gpu::shader::BrickPass::{First, Later};
use crate::gpu::shader::{BrickPass, Constant, Kernel, camera_constant, structure_choice};

/// The properties of a lighting that determine its kernels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Mode {
    Studio,
    Path(Materials, Sources, SkyKind),
}

impl Mode {
    /// All modes.
    fn all() -> impl Iterator<Item = Self> {
        let paths = OnePass::ALL.into_iter().filter_map(|pass| match pass.mode() {
            Self::Path(materials, sources, _) => Some((materials, sources)),
            Self::Studio => None,
        });
        let paths = paths.flat_map(|(materials, sources)| {
            [SkyKind::Plain, SkyKind::Image].map(|sky| Self::Path(materials, sources, sky))
        });
        std::iter::once(Self::Studio).chain(paths)
    }

    /// Whether paths sample lights.
    pub(crate) fn samples_light(self) -> bool {
        matches!(self, Self::Path(_, Sources::Any, _))
    }

    /// Whether light may be absorbed between surfaces.
    pub(crate) fn has_medium(self) -> bool {
        matches!(self, Self::Path(Materials::Any, ..))
    }

    pub(crate) fn is_studio(self) -> bool {
        self == Self::Studio
    }

    /// The constants of `path/choices.wgsl`.
    fn constants(self) -> [Constant; 2] {
        [("ANY_MATERIALS", u32::from(self.has_medium())), ("SAMPLES_LIGHT", u32::from(self.samples_light()))]
    }
}

/// Whether all surfaces are matt or emissive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Materials {
    Matt,
    Any,
}

/// Whether there is a light source that can be sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Sources {
    None,
    Any,
}

/// Whether the sky is an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum SkyKind {
    Plain,
    Image,
}

/// The paths that a dispatch processes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Schedule {
    /// One path for each pixel and each sample in flight.
    Pixels,
    /// The paths of a list.
    Queue,
}

impl Schedule {
    fn constant(self) -> Constant {
        ("TAKES_LIST", u32::from(self == Self::Queue))
    }
}

/// The pictures whose samples one pass takes as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum OnePass {
    /// A studio of opaque spheres with any lamps without a ground.
    Lamps,
    /// A studio of opaque spheres with any lamps and a ground.
    Ground,
    /// Paths under a sky without an image.
    Paths(Materials, Sources),
}

impl OnePass {
    /// All kinds of such pictures.
    pub(crate) const ALL: [Self; 6] = [
        Self::Lamps,
        Self::Ground,
        Self::Paths(Materials::Matt, Sources::None),
        Self::Paths(Materials::Matt, Sources::Any),
        Self::Paths(Materials::Any, Sources::None),
        Self::Paths(Materials::Any, Sources::Any),
    ];

    /// Whether the samples are paths.
    pub(super) fn is_paths(self) -> bool {
        matches!(self, Self::Paths(..))
    }

    /// The properties of the lighting of such a picture.
    fn mode(self) -> Mode {
        match self {
            Self::Paths(materials, sources) => Mode::Path(materials, sources, SkyKind::Plain),
            Self::Lamps | Self::Ground => Mode::Studio,
        }
    }

    fn entry_point(self) -> &'static str {
        if self.is_paths() { "whole_paths" } else { "one_pass" }
    }
}

/// Whether a kernel may have all the buffers that one pass over whole samples needs: the status word, the sums, the
/// tables, two buffers of the appearance, and the buffers of the structure.
pub(super) fn one_pass_fits(structure: Structure, limits: &wgpu::Limits) -> bool {
    let of_structure = if structure == Structure::List { 2 } else { 3 };
    5 + of_structure <= limits.max_storage_buffers_per_shader_stage
}

/// The properties in which sets of passes differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct LitKey {
    pub(crate) camera: CameraKind,
    pub(crate) mode: Mode,
    pub(crate) structure: Structure,
    /// The structure of the spheres that cast shadows.
    pub(crate) occluders: Structure,
    /// How rays exclude the sphere on which they start, among all spheres and among the spheres that cast shadows.
    pub(crate) exclude_by: [ExcludeBy; 2],
    /// Whether the scene has several bricks.
    pub(crate) several_bricks: bool,
    /// The kind of picture, if one pass takes whole samples, which needs one brick.
    pub(crate) one_pass: Option<OnePass>,
}

/// The entry point of a pass's kernel, the paths that it processes, and whether it searches the first brick.
pub(super) type PassName = (&'static str, Schedule, BrickPass);

impl LitKey {
    /// The keys of all pictures of scenes with these structures.
    pub(super) fn all(structures: &[Structure]) -> impl Iterator<Item = Self> {
        let one_pass = OnePass::ALL.into_iter().map(|pass| (pass.mode(), Some(pass)));
        let modes = Mode::all().map(|mode| (mode, None)).chain(one_pass);
        modes.flat_map(move |(mode, one_pass)| {
            structures.iter().flat_map(move |&structure| {
                ExcludeBy::ALL.into_iter().flat_map(move |exclude_by| {
                    CameraKind::ALL.iter().map(move |&camera| Self {
                        camera,
                        mode,
                        structure,
                        occluders: structure,
                        exclude_by: [exclude_by; 2],
                        several_bricks: true,
                        one_pass,
                    })
                })
            })
        })
    }

    /// The passes that take samples of the pictures.
    pub(super) fn passes(&self) -> Vec<PassName> {
        use Schedule::{Pixels, Queue};
        if let Some(pass) = self.one_pass {
            return vec![(pass.entry_point(), Pixels, First)];
        }
        let steps: &[PassName] = match self.mode {
            Mode::Studio => &[
                ("surface", Pixels, First),
                ("surface", Queue, First),
                ("shadow", Queue, First),
                ("illuminate", Queue, First),
                ("ambient", Queue, First),
                ("gather", Queue, First),
            ],
            Mode::Path(..) => &[("scatter", Pixels, First), ("scatter", Queue, First), ("occlude", Queue, First)],
        };
        let later: &[PassName] = &[("extend", Pixels, Later), ("extend", Queue, Later)];
        let common = [
            ("start", Pixels, First),
            ("extend", Pixels, First),
            ("extend", Queue, First),
            ("accumulate", Pixels, First),
        ];
        [&common[..], steps, if self.several_bricks { later } else { &[] }].concat()
    }

    /// Whether a pass searches the spheres that cast shadows.
    pub(super) fn finds_occluders((entry_point, ..): PassName) -> bool {
        matches!(entry_point, "occlude" | "shadow" | "ambient")
    }

    /// The kernel of a pass.
    pub(super) fn kernel(&self, name @ (entry_point, schedule, brick_pass): PassName) -> Kernel {
        let [of_all, of_occluders] = self.exclude_by;
        let (structure, exclude_by) = match Self::finds_occluders(name) {
            true => (self.occluders, of_occluders),
            false => (self.structure, of_all),
        };
        let sky = match self.mode {
            Mode::Path(.., SkyKind::Image) => "sky-image",
            _ => "plain-sky",
        };
        let is_pass = |pass| u32::from(self.one_pass == Some(pass));
        Kernel::new(
            entry_point,
            &[structure_choice(BrickKind { structure, primitive: Primitive::Sphere }), ("$sky", sky)],
        )
        .with(self.mode.constants())
        .with([camera_constant(self.camera), exclude_by.constant()])
        .with([("HAS_GROUND", is_pass(OnePass::Ground))])
        .with([brick_pass.constant(), schedule.constant()])
    }
}

/// The pass that computes the numbers of workgroups of the next indirect dispatches, and the pass that sums variances
/// and luminances of pixels.
pub(super) const OF_ALL: [PassName; 2] = [("advance", Schedule::Pixels, First), ("noise", Schedule::Pixels, First)];

/// The kernels for every camera, structure, kind of lighting and schedule.
pub(super) fn kernels() -> Vec<Kernel> {
    let mut known = HashSet::new();
    // If there are several passes, none depends on both a camera and a structure.
    let keys = LitKey::all(Structure::WITH_KERNELS).filter(|key| {
        let is_first = key.camera == CameraKind::Pinhole || key.structure == Structure::List;
        key.one_pass.is_some() || is_first
    });
    let kernels = keys.flat_map(|key| key.passes().into_iter().chain(OF_ALL).map(move |name| key.kernel(name)));
    kernels.filter(|kernel| known.insert((kernel.name(), kernel.constants.clone()))).collect()
}
