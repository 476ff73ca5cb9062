//! Small lit scenes. Most are files in `tests/gpu/scenes`. Scenes in `light` use every material, light, sky and
//! kernel. Each scene in `paths` and `studio` makes one kind of fault visible. A scene file cannot contain
//! random spheres or colours of each sphere.

use std::path::{Path, PathBuf};

use pinhole::light::LightKind;
use pinhole::render::{Integrator, Occlusion};
use pinhole::scene::material::Material;
use pinhole::{Appearance, Environment, LinearRgb, Scene, Sphere, SphereArray, SurfaceProperties};
use pinhole_figure::scene_file::SceneFile;

use crate::support::cones::mixed_shapes;
use crate::support::random_light::RandomView;
use crate::support::{View, spheres_of};

impl From<RandomView> for View {
    fn from(RandomView { scene, camera, film, settings, .. }: RandomView) -> Self {
        Self { scene, camera, film, settings }
    }
}

fn file(of: &str, name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/gpu/scenes").join(of).join(name)
}

/// The names of the scene files in a folder that start with `start`.
pub(crate) fn names_of_files(of: &str, start: &str) -> Vec<String> {
    let files = std::fs::read_dir(file(of, "")).unwrap().map(|file| file.unwrap().file_name());
    let names = files.map(|name| name.into_string().unwrap());
    let names = names.filter_map(|name| name.strip_suffix(".toml").map(str::to_owned));
    let mut names: Vec<String> = names.filter(|name| name.starts_with(start)).collect();
    names.sort_unstable();
    names
}

/// All scenes of the folder `light`, and some with cones. Paths among many rods of glass differ after a few of them.
pub(crate) fn all() -> impl Iterator<Item = (String, View)> {
    let with_cones = [("paths", "rods"), ("studio", "rods"), ("studio", "many_rods")].map(|(suite, name)| {
        let mut view = view(suite, name);
        view.settings.sampling.samples = 4;
        (format!("{suite}_{name}"), view)
    });
    names_of_files("light", "").into_iter().map(|name| (name.clone(), named(&name))).chain(with_cones)
}

/// A scene of the folder `light`.
pub(crate) fn named(name: &str) -> View {
    read("light", name).1
}

/// A scene of the folder `light`, with a number of samples.
pub(crate) fn sampled(name: &str, samples: u32) -> View {
    let mut view = named(name);
    view.settings.sampling.samples = samples;
    view
}

/// The names of the scenes in `paths` or `studio` of which every sample is judged.
pub(crate) fn judged(suite: &str) -> Vec<String> {
    let more = match suite {
        "paths" => vec!["many".to_owned(), "own_colors".to_owned()],
        _ => names_of_files("light", "studio_"),
    };
    let mut names = names_of_files(suite, "");
    // This scene is for faults. A little more than a twentieth of its stages is open.
    names.retain(|name| name != "image_over_ground");
    [names, more].concat()
}

/// A scene of [`judged`], or one that is built from such scenes.
pub(crate) fn view(suite: &str, name: &str) -> View {
    match (suite, name) {
        ("paths", "many") => many_for_paths(),
        ("paths", "own_colors") => own_colors(),
        ("paths", "thrice") => thrice(),
        ("studio", "many") => many_for_studio(),
        (_, "many_rods") => many_rods(suite),
        _ if name.starts_with("studio_") => named(name),
        _ => read(suite, name).1,
    }
}

/// The text of a scene file.
pub(crate) fn text(of: &str, name: &str) -> String {
    let path = file(of, name).with_extension("toml");
    let text = std::fs::read_to_string(&path);
    text.unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The spheres of a scene file, and its view.
pub(crate) fn read(of: &str, name: &str) -> (Vec<Sphere>, View) {
    let file = SceneFile::parse(&text(of, name)).unwrap();
    let scene = file.scene().unwrap();
    let camera = file.camera(&file.film, &scene).unwrap();
    let sky = file.sky_image().map(sky_image);
    let settings = file.settings(file.integrator().unwrap(), &scene, camera.as_ref(), sky);
    let mut settings = settings.unwrap();
    settings.is_transparent = file.encoding.transparent;
    (file.spheres().collect(), View { scene, camera, film: file.film, settings })
}

/// The images of skies that scene files name.
fn sky_image(name: &str) -> Environment {
    let texel = |index: usize| {
        let (i, j) = (index % 16, index / 16);
        let level = |k: usize| ((index * k) % 11) as f32 / 11.0;
        let bright = if index == 37 { 20.0 } else { 0.0 };
        match name {
            "a bright texel" => [level(3) + bright, level(5) + bright, level(7)],
            "a bright side" if (9..11).contains(&i) && j == 2 => [12.0, 10.0, 8.0],
            "a bright side" => [0.1, 0.15, 0.1 + 0.02 * j as f32],
            _ => panic!("{name}"),
        }
    };
    Environment::new(16, 8, (0..128).map(texel).collect()).unwrap()
}

/// Spheres with individual colours and alphas, and one of several surfaces each.
fn own_colors() -> View {
    let (spheres, view) = read("paths", "everything");
    let colors: Vec<[u8; 4]> = (0..spheres.len() as u8)
        .map(|i| [60 + 20 * i, 200 - 15 * i, 30 + 9 * i, if i % 4 == 2 { 100 + i } else { 255 }])
        .collect();
    let tinted = Material::Dielectric { ior: 1.5, roughness: 0.0, attenuation_distance: Some(0.8) };
    let surfaces = spheres.iter().map(|sphere| match sphere.surface.material {
        Material::Dielectric { .. } => SurfaceProperties { material: tinted, ..sphere.surface },
        _ => sphere.surface,
    });
    let indices = (0..spheres.len() as u32).collect();
    let appearance = Appearance::from(colors).with_surfaces(surfaces.collect(), indices);
    let points = spheres.iter().map(|s| [s.center[0], s.center[1], s.center[2], s.radius]);
    let scene = Scene::from_parts(SphereArray::F64(points.collect()), appearance).unwrap();
    View { scene, ..view }
}

/// Enough spheres that a structure is built.
fn many_for_paths() -> View {
    let mut random = fastrand::Rng::with_seed(5);
    let spheres: Vec<_> = (0..300)
        .map(|i| {
            let center = [0; 3].map(|_| random.f64() * 4.0 - 2.0);
            let color = LinearRgb::new([0; 3].map(|_| random.f32() * 0.9)).unwrap();
            let material = match i % 6 {
                0 => Material::Conductor { roughness: 0.3 },
                1 => Material::Lambert { specular: 0.4, roughness: 0.2 },
                2 => {
                    let attenuation_distance = Some(0.5);
                    Material::Dielectric { ior: 1.5, roughness: 0.0, attenuation_distance }
                }
                3 => Material::Emissive { strength: 2.0 },
                _ => Material::default(),
            };
            Sphere::new(center, 0.08 + 0.12 * random.f64(), color).with_material(material)
        })
        .collect();
    let mut view = view("paths", "metals");
    for light in &mut view.settings.lights {
        if let LightKind::Directional { angular_radius, .. } = &mut light.kind {
            *angular_radius = 0.1;
        }
    }
    View { scene: Scene::new(&spheres).unwrap(), ..view }
}

/// So many cones and cylinders that structures are built, some twice, beside some spheres, with the surfaces of `rods`, but
/// rougher: what narrow lobes scatter on thin rods has wide bounds, because it follows from where f32 puts a point on them.
fn many_rods(suite: &str) -> View {
    let view = view(suite, "rods");
    let (spheres, mut cones) = mixed_shapes(40, 250, 0.4, 9);
    cones.iter_mut().for_each(|cone| cone.radii = cone.radii.map(|radius| 2.5 * radius));
    cones.extend_from_within(..50);
    let rougher = |surface: &SurfaceProperties| {
        let material = match surface.material {
            Material::Emissive { .. } => return None,
            Material::Dielectric { ior, attenuation_distance, roughness } => {
                Material::Dielectric { ior, attenuation_distance, roughness: if roughness > 0.0 { 0.6 } else { 0.0 } }
            }
            Material::Conductor { .. } => Material::Conductor { roughness: 0.6 },
            Material::Lambert { specular, .. } => Material::Lambert { specular, roughness: 0.6 },
        };
        Some(SurfaceProperties { material, ..*surface })
    };
    let surfaces: Vec<_> = view.scene.appearance().surfaces().iter().filter_map(rougher).collect();
    let ids = 0..(spheres.len() + cones.len()) as u32;
    let colors: Vec<[u8; 4]> =
        ids.clone().map(|id| [60 + (id * 31 % 190) as u8, 120, (id * 57 % 250) as u8, 255]).collect();
    let indices = ids.map(|id| id * 7 % surfaces.len() as u32).collect();
    let appearance = Appearance::from(colors).with_surfaces(surfaces, indices);
    View { scene: Scene::from_shapes(SphereArray::F64(spheres), &cones, appearance).unwrap(), ..view }
}

/// Many spheres with three copies of each, which have different appearances.
fn thrice() -> View {
    let view = many_for_paths();
    let spheres = spheres_of(&view.scene);
    let copy = |(copy, id): (usize, usize)| {
        let mut sphere = spheres[(id + copy) % spheres.len()];
        (sphere.center, sphere.radius) = (spheres[id].center, spheres[id].radius);
        sphere
    };
    let copies = (0..3).flat_map(|copy| (0..spheres.len()).map(move |id| (copy, id)));
    let spheres: Vec<Sphere> = copies.map(copy).collect();
    View { scene: Scene::new(&spheres).unwrap(), ..view }
}

/// Enough spheres that a structure is built.
fn many_for_studio() -> View {
    let spheres: Vec<Sphere> = (0..300)
        .map(|i| {
            let place = |k: u32| f64::from(i * k % 97) / 97.0 * 4.0 - 2.0;
            let color = [0.2 + (i % 5) as f32 * 0.1, 0.5, 0.3 + (i % 7) as f32 * 0.1];
            let center = [place(31), place(57), place(73)];
            Sphere::new(center, 0.12 + f64::from(i % 4) * 0.03, LinearRgb::new(color).unwrap())
        })
        .collect();
    let mut view = view("studio", "sharp_shadows");
    view.settings.lights.truncate(2);
    if let Integrator::Studio(studio) = &mut view.settings.integrator {
        studio.occlusion = Some(Occlusion { radius: Some(0.6), samples: 2 });
    }
    View { scene: Scene::new(&spheres).unwrap(), ..view }
}
