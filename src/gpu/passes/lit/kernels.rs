//! The kernels of lit pictures. `shaders/README.md` lists them, and `shaders/kernels.txt` their parts.

use std::collections::HashSet;

use crate::accel::{BrickKind, Primitive, Structure};
use crate::camera::CameraKind;
use crate::gpu::scene::scene_summary::ExcludeBy;
use crate::gpu::shader::BrickPass::{First, Later};
use crate::gpu::shader::{BrickPass, Constant, Kernel, camera_constant, lit_choices};

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
    pub(crate) structures: ShapeStructures,
    /// The structures of the shapes that cast shadows.
    pub(crate) occluders: ShapeStructures,
    /// How rays exclude the shape on which they start, among all shapes and among the shapes that cast shadows.
    pub(crate) exclude_by: [ExcludeBy; 2],
    /// Whether the scene has several bricks.
    pub(crate) several_bricks: bool,
    /// The kind of picture, if one pass takes whole samples, which needs one brick.
    pub(crate) one_pass: Option<OnePass>,
}

/// The structures of a scene's bricks, for each primitive. `None` without such bricks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct ShapeStructures {
    pub(crate) spheres: Option<Structure>,
    pub(crate) cones: Option<Structure>,
}

impl ShapeStructures {
    /// The structures of these bricks.
    pub(crate) fn of(kinds: &[BrickKind]) -> Self {
        let of = |primitive| kinds.iter().find(|kind| kind.primitive == primitive).map(|kind| kind.structure);
        Self { spheres: of(Primitive::Sphere), cones: of(Primitive::Cone) }
    }

    /// The bricks, those of spheres first. Without bricks, a list of spheres.
    pub(super) fn kinds(self) -> impl Iterator<Item = BrickKind> {
        let Self { spheres, cones } = self;
        let spheres = spheres.or(cones.is_none().then_some(Structure::List));
        let kind = |primitive| move |structure| BrickKind { structure, primitive };
        spheres.map(kind(Primitive::Sphere)).into_iter().chain(cones.map(kind(Primitive::Cone)))
    }
}

/// A pass: the entry point of its kernel, the paths that it processes, whether it searches the first brick, and the shapes
/// of its brick.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct PassName {
    pub(super) entry_point: &'static str,
    pub(super) schedule: Schedule,
    pub(super) brick_pass: BrickPass,
    pub(super) primitive: Primitive,
}

impl LitKey {
    /// The keys of all pictures of scenes of spheres with these structures, and those of spheres and cones.
    pub(super) fn all(structures: &[Structure]) -> impl Iterator<Item = Self> {
        let spheres = structures.iter().map(|&structure| ShapeStructures { spheres: Some(structure), cones: None });
        let kinds: Vec<BrickKind> = BrickKind::of(structures, &[Primitive::Cone]).collect();
        let both = kinds
            .into_iter()
            .map(|kind| ShapeStructures { spheres: Some(kind.structure), cones: Some(kind.structure) });
        let structures: Vec<ShapeStructures> = spheres.chain(both).collect();
        let one_pass = OnePass::ALL.into_iter().map(|pass| (pass.mode(), Some(pass)));
        let modes = Mode::all().map(|mode| (mode, None)).chain(one_pass);
        modes.flat_map(move |(mode, one_pass)| {
            let structures = structures.clone().into_iter().filter(move |of| one_pass.is_none() || of.cones.is_none());
            structures.flat_map(move |structures| {
                ExcludeBy::ALL.into_iter().flat_map(move |exclude_by| {
                    CameraKind::ALL.iter().map(move |&camera| Self {
                        camera,
                        mode,
                        structures,
                        occluders: structures,
                        exclude_by: [exclude_by; 2],
                        several_bricks: true,
                        one_pass,
                    })
                })
            })
        })
    }

    /// The shapes of the first brick.
    pub(super) fn first(&self) -> Primitive {
        self.structures.kinds().next().map(|kind| kind.primitive).unwrap_or_default()
    }

    /// The passes that take samples of the pictures.
    pub(super) fn passes(&self) -> Vec<PassName> {
        use Schedule::{Pixels, Queue};
        let first = self.first();
        let pass =
            |(entry_point, schedule, brick_pass), primitive| PassName { entry_point, schedule, brick_pass, primitive };
        if let Some(kind) = self.one_pass {
            return vec![pass((kind.entry_point(), Pixels, First), first)];
        }
        let mut passes = vec![
            pass(("start", Pixels, First), first),
            pass(("extend", Pixels, First), first),
            pass(("extend", Queue, First), first),
            pass(("accumulate", Pixels, First), first),
        ];
        let (shade, search): (_, &[&str]) = match self.mode {
            Mode::Studio => ("surface", &["shadow", "ambient"]),
            Mode::Path(..) => ("scatter", &["occlude"]),
        };
        if self.mode.is_studio() {
            passes.extend(["illuminate", "gather"].map(|entry_point| pass((entry_point, Queue, First), first)));
        }
        for BrickKind { primitive, .. } in self.structures.kinds() {
            passes.extend([Pixels, Queue].map(|schedule| pass((shade, schedule, First), primitive)));
            if self.several_bricks {
                passes.extend([Pixels, Queue].map(|schedule| pass(("extend", schedule, Later), primitive)));
            }
        }
        for BrickKind { primitive, .. } in self.occluders.kinds() {
            passes.extend(search.iter().map(|entry_point| pass((entry_point, Queue, First), primitive)));
        }
        passes
    }

    /// True if a pass searches the shapes that cast shadows.
    pub(super) fn finds_occluders(entry_point: &str) -> bool {
        matches!(entry_point, "occlude" | "shadow" | "ambient")
    }

    /// The kind of brick that a pass has.
    pub(super) fn kind_of(&self, name: PassName) -> BrickKind {
        let of = if Self::finds_occluders(name.entry_point) { self.occluders } else { self.structures };
        let none = BrickKind { structure: Structure::List, primitive: name.primitive };
        of.kinds().find(|kind| kind.primitive == name.primitive).unwrap_or(none)
    }

    /// The kernel of a pass.
    pub(super) fn kernel(&self, name: PassName) -> Kernel {
        let [of_all, of_occluders] = self.exclude_by;
        let exclude_by = if Self::finds_occluders(name.entry_point) { of_occluders } else { of_all };
        let sky = match self.mode {
            Mode::Path(.., SkyKind::Image) => "sky-image",
            _ => "plain-sky",
        };
        let is_pass = |pass| u32::from(self.one_pass == Some(pass));
        let [shape, place, excluded, structure] = lit_choices(self.kind_of(name));
        Kernel::new(name.entry_point, &[shape, place, excluded, structure, ("$sky", sky)])
            .with(self.mode.constants())
            .with([camera_constant(self.camera), exclude_by.constant()])
            .with([("HAS_GROUND", is_pass(OnePass::Ground))])
            .with([name.brick_pass.constant(), name.schedule.constant()])
    }
}

/// The pass that computes the numbers of workgroups of the next indirect dispatches, and the pass that sums variances
/// and luminances of pixels.
pub(super) const OF_ALL: [PassName; 2] = [of_all("advance"), of_all("noise")];

const fn of_all(entry_point: &'static str) -> PassName {
    PassName { entry_point, schedule: Schedule::Pixels, brick_pass: First, primitive: Primitive::Sphere }
}

/// The kernels for every camera, structure, kind of lighting and schedule.
pub(super) fn kernels() -> Vec<Kernel> {
    let mut known = HashSet::new();
    // If there are several passes, none depends on both a camera and a structure.
    let keys = LitKey::all(Structure::WITH_KERNELS).filter(|key| {
        let is_first = key.camera == CameraKind::Pinhole || key.structures.spheres == Some(Structure::List);
        key.one_pass.is_some() || is_first
    });
    let kernels = keys.flat_map(|key| key.passes().into_iter().chain(OF_ALL).map(move |name| key.kernel(name)));
    kernels.filter(|kernel| known.insert((kernel.name(), kernel.constants.clone()))).collect()
}
