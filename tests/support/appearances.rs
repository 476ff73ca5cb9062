//! Scenes with every kind of appearance, and the same spheres one by one.

use pinhole::camera::{PinholeCamera, Pose};
use pinhole::render::Sampling;
use pinhole::scene::NewColors;
use pinhole::scene::material::Material;
use pinhole::{Appearance, ColorMap, Colors, LinearRgb, RenderSettings, Scene, Sphere, SphereArray, SurfaceProperties};

/// The number of spheres of each scene.
const COUNT: u32 = 60;

/// A scene with a kind of appearance, and the same scene made by `Scene::new`.
#[derive(Debug)]
pub(crate) struct Kind {
    pub(crate) name: String,
    pub(crate) scene: Scene,
    pub(crate) expected: Scene,
}

/// Settings with primary rays, of a studio, and with paths.
pub(crate) fn settings() -> [RenderSettings; 3] {
    let sampling = Sampling { samples: 4, ..Sampling::default() };
    [
        RenderSettings::default(),
        RenderSettings { sampling, ..RenderSettings::studio() },
        RenderSettings { sampling, ..RenderSettings::path() },
    ]
}

/// Every kind of colours, with one set of surface properties and with several.
pub(crate) fn kinds() -> Vec<Kind> {
    let mut kinds = Vec::new();
    for (name, colors) in colors() {
        let appearance = || Appearance::new(colors.clone());
        let indices = (0..COUNT).map(|id| id * 7 % 5).collect();
        for (surface, appearance) in [
            ("of_the_usual_surface", appearance()),
            ("of_one_surface", appearance().with_surface(surfaces()[1])),
            ("of_tinted_glass", appearance().with_surface(surfaces()[3])),
            ("of_several_surfaces", appearance().with_surfaces(surfaces(), indices)),
        ] {
            kinds.push(kind(format!("{name}_{surface}"), appearance));
        }
    }
    kinds
}

fn kind(name: String, appearance: Appearance) -> Kind {
    let spheres = spheres();
    let one_by_one: Vec<Sphere> = (0..)
        .zip(&spheres)
        .map(|(id, [x, y, z, radius])| {
            let mut sphere =
                Sphere::new([x, y, z].map(|c| f64::from(*c)), f64::from(*radius), appearance.color(id).unwrap());
            let place = appearance.surface_indices().map_or(0, |indices| indices[id as usize]);
            sphere.surface = appearance.surfaces()[place as usize];
            if let Colors::Rgba8(colors) = appearance.colors() {
                sphere.surface.opacity *= f32::from(colors[id as usize][3]) / 255.0;
            }
            sphere
        })
        .collect();
    let expected = Scene::new(&one_by_one).unwrap();
    Kind { name, scene: Scene::from_parts(SphereArray::F32(spheres), appearance).unwrap(), expected }
}

fn spheres() -> Vec<[f32; 4]> {
    let mut random = fastrand::Rng::with_seed(23);
    let coordinate = |random: &mut fastrand::Rng| random.f32() * 4.0 - 2.0;
    (0..COUNT)
        .map(|_| [0; 3].map(|_| coordinate(&mut random)))
        .map(|[x, y, z]| [x, y, z, 0.2 + 0.2 * (x * x + y).fract().abs()])
        .collect()
}

fn colors() -> Vec<(&'static str, Colors)> {
    let mut random = fastrand::Rng::with_seed(24);
    let table: Vec<LinearRgb> = (0..40).map(|_| LinearRgb::new([0; 3].map(|_| random.f32())).unwrap()).collect();
    let indices = (0..COUNT).map(|_| random.u32(..40)).collect();
    let values = (0..COUNT).map(|_| random.f32() * 14.0 - 2.0).collect();
    let rgba = (0..COUNT).map(|_| [0; 4].map(|_| random.u8(..)));
    // Some of these colours are opaque.
    let rgba = rgba.map(|[r, g, b, a]| [r, g, b, if a > 99 { 255 } else { a }]).collect();
    vec![
        ("one_color", Colors::One(table[3])),
        ("palette", Colors::Palette { palette: table.clone(), indices }),
        ("rgba8", Colors::Rgba8(rgba)),
        ("scalars", Colors::Scalars { values, map: ColorMap::new(table, [-1.0, 11.0]).unwrap() }),
    ]
}

fn surfaces() -> Vec<SurfaceProperties> {
    let opaque = |material| SurfaceProperties { material, opacity: 1.0 };
    vec![
        opaque(Material::Lambert { specular: 0.3, roughness: 0.2 }),
        SurfaceProperties { material: Material::default(), opacity: 0.6 },
        opaque(Material::Conductor { roughness: 0.3 }),
        opaque(Material::Dielectric { ior: 1.4, roughness: 0.0, attenuation_distance: Some(0.7) }),
        opaque(Material::Emissive { strength: 2.0 }),
    ]
}

/// A camera in front of the spheres.
pub(crate) fn camera() -> PinholeCamera {
    let pose = Pose::looking_at([1.0, 2.0, 8.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    PinholeCamera::with_vertical_fov(pose, 0.6, 1.0).unwrap()
}

/// New values of every kind, for updates of any spheres.
pub(crate) struct Numbers {
    pub(crate) centers: Vec<[f32; 3]>,
    pub(crate) radii: Vec<f32>,
    places: Vec<u32>,
    pub(crate) rgba: Vec<[u8; 4]>,
}

impl Numbers {
    pub(crate) fn of(random: &mut fastrand::Rng, count: usize) -> Self {
        let all = 0..count;
        Self {
            centers: all.clone().map(|_| [0; 3].map(|_| random.f32() * 4.0 - 2.0)).collect(),
            radii: all.clone().map(|_| 0.1 + random.f32() * 0.3).collect(),
            places: all.clone().map(|_| random.u32(..40)).collect(),
            rgba: all.map(|_| [random.u8(..), random.u8(..), 99, random.u8(..) | 0xf0]).collect(),
        }
    }

    /// New colours of the same kind as the scene's.
    pub(crate) fn colors(&self, scene: &Scene) -> Option<NewColors<'_>> {
        match scene.appearance().colors() {
            Colors::One(_) => None,
            Colors::Palette { .. } => Some(NewColors::Palette(&self.places)),
            Colors::Rgba8(_) => Some(NewColors::Rgba8(&self.rgba)),
            _ => Some(NewColors::Scalars(&self.radii)),
        }
    }
}
