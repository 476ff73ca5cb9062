//! Tests of the light and the materials of scene files.

use pinhole::glam::DVec3;
use pinhole::image::color::LinearRgb;
use pinhole::light::environment::Environment;
use pinhole::light::{Light, LightFrame, LightKind, SkyLight};
use pinhole::render::{Integrator, LightSampling, RenderSettings, Sampling, Studio};
use pinhole::{Material, PixelFilter, Scene, SphereArray, SurfaceProperties};
use pinhole_data::load::{Column, ColumnValues, Dataset, Labels};
use pinhole_figure::scene_file::{DataScene, IntegratorKind, OwnShapes, SceneFile};

use crate::scene_file::parse;

const SPHERE: &str = "[[spheres]]\ncenter = [1, 2, 3]\nradius = 1\n";

fn scene(file: &SceneFile) -> Scene {
    file.scene().unwrap_or_else(|error| panic!("{error}"))
}

fn lighting(text: &str) -> RenderSettings {
    let file = parse(text);
    let kind = file.integrator().unwrap();
    lighting_by(text, kind)
}

fn lighting_by(text: &str, kind: IntegratorKind) -> RenderSettings {
    let file = parse(text);
    let scene = scene(&file);
    let camera = file.camera(&file.film, &scene).unwrap();
    file.settings(kind, &scene, camera.as_ref(), None).unwrap_or_else(|error| panic!("{error}"))
}

fn studio(text: &str) -> Studio {
    lighting(text).studio_parameters().unwrap().clone()
}

fn first_surface(text: &str) -> SurfaceProperties {
    scene(&parse(text)).surface(0)
}

#[test]
fn without_light_nothing_is_lit() {
    assert_eq!(parse("").integrator(), None);
    assert_eq!(parse(SPHERE).integrator(), None);
    assert_eq!(parse("background = 'red'\nshading = 'flat'\n").integrator(), None);
}

/// Tables about light do not prevent a picture without light.
#[test]
fn primary_rays_use_only_their_own_settings() {
    let text = "integrator = 'primary'\nshading = 'flat'\nbackground = 'red'\n";
    let kind = IntegratorKind::Primary;
    assert_eq!(parse(text).integrator(), Some(kind));
    let background = LinearRgb::from_srgb8([255, 0, 0]);
    let expected = RenderSettings { background, ..RenderSettings::default() };
    let integrator = Integrator::Primary(pinhole::Shading::Flat);
    assert_eq!(lighting(text), RenderSettings { integrator, ..expected.clone() });
    let lit =
        "background = 'red'\n[studio]\n[sampling]\nsamples = 9\ndenoise = true\n[ground]\n[sun]\ntoward = [0, 1, 0]\n";
    assert_eq!(lighting_by(lit, kind), expected);
    // Materials and opacity belong to the scene, not to the settings.
    let clear = format!("integrator = 'primary'\n{SPHERE}opacity = 0.5\n");
    assert_eq!(lighting(&clear), RenderSettings::default());
}

/// A studio is not lit by a sky, so it ignores the sky of a file.
#[test]
fn a_studio_leaves_the_sky_out() {
    let both = "integrator = 'studio'\n[sky]\nkind = 'constant'\n[path]\nmax_depth = 3\n";
    assert_eq!(lighting(both), RenderSettings { lights: Vec::new(), ..RenderSettings::studio() });
}

#[test]
fn tables_about_light_ask_for_a_lit_picture() {
    let (studio, path) = (Some(IntegratorKind::Studio), Some(IntegratorKind::Path));
    for (text, expected) in [
        ("integrator = 'studio'\n", studio),
        ("integrator = 'path'\n", path),
        ("[studio]\n", studio),
        ("[studio.outline]\n", studio),
        ("[path]\n", path),
        ("[sky]\nkind = 'constant'\n", path),
        ("[sun]\ntoward = [0, 1, 0]\n", studio),
        ("[sun]\ntoward = [0, 1, 0]\n[path]\n", path),
        ("[sampling]\n", studio),
        ("[ground]\n", studio),
        ("lights = []\n", studio),
        ("data = 'a.npy'\nopacity = 0.5\n", studio),
        ("[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\nopacity = 0.5\n", studio),
        ("integrator = 'studio'\n[path]\n[sky]\nkind = 'constant'\n", studio),
        ("integrator = 'path'\n[studio]\n", path),
    ] {
        assert_eq!(parse(text).integrator(), expected, "{text}");
    }
}

#[test]
fn missing_values_are_the_defaults() {
    assert_eq!(lighting("integrator = 'studio'\n"), RenderSettings::studio());
    let path = lighting("integrator = 'path'\n");
    let integrator = Integrator::Path(pinhole::render::PathTracing::default());
    assert_eq!(path, RenderSettings { integrator, ..RenderSettings::studio() });
}

#[test]
fn materials_by_name_and_opacity_over_them() {
    let sphere = |material: &str, keys: &str| {
        first_surface(&format!("[materials.'it is']\n{material}\n{SPHERE}material = 'it is'\n{keys}"))
    };
    let of = |material| SurfaceProperties { material, opacity: 1.0 };
    assert_eq!(sphere("kind = 'lambert'", ""), SurfaceProperties::default());
    assert_eq!(
        sphere("kind = 'lambert'\nspecular = 0.5\nroughness = 0.1", ""),
        of(Material::Lambert { specular: 0.5, roughness: 0.1 })
    );
    assert_eq!(sphere("kind = 'conductor'", ""), of(Material::Conductor { roughness: 0.2 }));
    assert_eq!(
        sphere("kind = 'dielectric'", ""),
        of(Material::Dielectric { ior: 1.5, roughness: 0.0, attenuation_distance: None })
    );
    assert_eq!(
        sphere("kind = 'dielectric'\nior = 2\nroughness = 1\nattenuation_distance = 3", ""),
        of(Material::Dielectric { ior: 2.0, roughness: 1.0, attenuation_distance: Some(3.0) })
    );
    assert_eq!(sphere("kind = 'emissive'", ""), of(Material::Emissive { strength: 1.0 }));
    assert_eq!(sphere("kind = 'lambert'\nopacity = 0.25", "").opacity, 0.25);
    assert_eq!(sphere("kind = 'lambert'\nopacity = 0.25", "opacity = 0.75\n").opacity, 0.75);
}

/// Four atoms O, H, C1, O in two chains. One chain is water.
fn molecule() -> Dataset {
    let mut loaded = Dataset::new(SphereArray::F64(vec![[0.0, 0.0, 0.0, 1.0]; 4]));
    loaded.colors = Some(vec![LinearRgb::WHITE; 4]);
    let column = |name: &str, names: &[&str], indices: [u32; 4]| {
        let names = names.iter().map(|name| (*name).to_owned()).collect();
        let values = ColumnValues::Labels(Labels { names, indices: indices.to_vec() });
        Column { name: name.to_owned(), values }
    };
    loaded.columns = vec![
        column("species", &["H", "O", "C1"], [1, 0, 2, 1]),
        column("residue", &["HEM", "HOH"], [0, 0, 0, 1]),
        column("chain", &["A", "B"], [0, 1, 1, 0]),
    ];
    loaded
}

#[test]
fn elements_are_named_by_columns_and_some_are_left_out() {
    let made = |text: &str| {
        let file = parse(&format!("data = 'a.pdb'\n{text}"));
        file.data().unwrap().scene(molecule(), &OwnShapes::default())
    };
    let radii = |text: &str| {
        let DataScene { scene, notes, .. } = made(text).unwrap();
        (scene.spheres().iter().map(|atom| atom[3]).collect::<Vec<_>>(), notes)
    };
    let tables = "[elements.A]\nradius = 2\n[elements.HOH]\nradius = 5\n";
    let (found, notes) = radii(&format!("elements_by = ['residue', 'chain']\n{tables}"));
    assert_eq!((found, notes), (vec![2.0, 1.0, 1.0, 5.0], Vec::new()));
    let (found, notes) = radii("leave_out = { residue = ['HOH', 'SOL'], chain = ['B'] }\n");
    assert_eq!(found, [1.0]);
    assert_eq!(notes, ["`leave_out`: no atom of a.pdb has the residue SOL; check its spelling or remove it"]);
    let (found, notes) = radii("leave_out = { chain = ['A', 'B'] }\n");
    assert!(found.is_empty());
    assert_eq!(notes, ["`leave_out` removes all atoms of a.pdb; remove some of its values"]);
    for (text, wanted) in [
        (
            "elements_by = ['colour']\n",
            "`elements_by`: a.pdb has no text column `colour`; its text columns are species, residue, chain",
        ),
        (
            "leave_out = { charge = ['1'] }\n",
            "`leave_out`: a.pdb has no text column `charge`; its text columns are species, residue, chain",
        ),
    ] {
        assert_eq!(made(text).unwrap_err().to_string(), wanted);
    }
    let plain = parse("data = 'a.npy'\nleave_out = { chain = ['A'] }\n");
    let empty = Dataset::new(SphereArray::F32(Vec::new()));
    let refused = plain.data().unwrap().scene(empty, &OwnShapes::default()).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "`leave_out` applies only to data with text, such as the names of atoms, and a.npy has none; remove it"
    );
}

#[test]
fn data_gets_common_properties_or_those_of_its_species() {
    let file = parse(
        "data = 'a.xyz'\nmaterial = 'metal'\nopacity = 0.5\n[materials.metal]\nkind = 'conductor'\n\
         [materials.glass]\nkind = 'dielectric'\nopacity = 0.75\n\
         [elements.O]\nradius = 3\ncolor = 'red'\n[elements.C1]\nmaterial = 'glass'\n[elements.X]\n",
    );
    let data = file.data().unwrap();
    let DataScene { scene, notes, .. } = data.scene(molecule(), &OwnShapes::default()).unwrap();
    assert_eq!(notes, ["`[elements.X]`: no atom of a.xyz has this name; check its spelling or remove the table"]);
    let metal = SurfaceProperties { material: Material::Conductor { roughness: 0.2 }, opacity: 0.5 };
    let radii: Vec<f32> = scene.spheres().iter().map(|atom| atom[3]).collect();
    assert_eq!(radii, [3.0, 1.0, 1.0, 3.0]);
    assert_eq!(scene.color(0), LinearRgb::from_srgb8([255, 0, 0]));
    assert_eq!((scene.color(1), scene.surface(1)), (LinearRgb::WHITE, metal));
    assert_eq!(scene.surface(0), metal);
    assert!(matches!(scene.surface(2).material, Material::Dielectric { .. }));
    assert_eq!(scene.surface(2).opacity, 0.75);
}

#[test]
fn arrays_get_the_common_surface_properties() {
    for own in ["", SPHERE] {
        let file = parse(&format!("data = 'a.npy'\nopacity = 0.5\n{own}"));
        let loaded = Dataset::new(SphereArray::F32(vec![[0.0, 0.0, 0.0, 1.0]; 2]));
        let own = file.shapes();
        let scene = file.data().unwrap().scene(loaded, own).unwrap().scene;
        let last = scene.len() as u32 - 1;
        assert_eq!(scene.surface(last).opacity, 0.5);
        assert_eq!(scene.surface(0).opacity, if own.spheres.is_empty() { 0.5 } else { 1.0 });
    }
}

#[test]
fn a_studio_in_every_detail() {
    let found = studio(
        "[studio]\nambient = [0, 0.5, 1]\nshadows = false\nmax_surfaces = 3\n\
         [studio.occlusion]\nradius = 2.5\nsamples = 7\n\
         [studio.depth_cue]\nnear = 1\nfar = 4\ncolor = 'black'\n\
         [studio.outline]\nwidth = 3\ncolor = 'white'\ndepth = 0.5\nangle = 90\n",
    );
    assert_eq!(found.ambient.to_array(), [0.0, 0.5, 1.0]);
    assert!(!found.shadows);
    assert_eq!(found.max_surfaces, 3);
    let occlusion = found.occlusion.unwrap();
    assert_eq!((occlusion.radius, occlusion.samples), (Some(2.5), 7));
    let cue = found.depth_cue.unwrap();
    assert_eq!((cue.near, cue.far, cue.color), (1.0, 4.0, LinearRgb::BLACK));
    let outline = found.outline.unwrap();
    assert_eq!((outline.width, outline.depth, outline.color), (3.0, 0.5, LinearRgb::WHITE));
    assert_eq!(outline.angle, std::f32::consts::FRAC_PI_2);
}

#[test]
fn a_depth_cue_reaches_over_the_scene() {
    let text = "background = 'red'\n[studio.depth_cue]\n[camera.pinhole]\neye = [0, 0, 10]\n\
                look_at = [0, 0, 0]\n[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\n";
    let cue = studio(text).depth_cue.unwrap();
    let root = 3.0_f64.sqrt();
    assert!((cue.near - (10.0 - root)).abs() < 1e-12, "{}", cue.near);
    assert!((cue.far - (10.0 + root)).abs() < 1e-12, "{}", cue.far);
    assert_eq!(cue.color, LinearRgb::from_srgb8([255, 0, 0]));
    // `far` exceeds `near`, whichever key is given.
    for keys in ["near = 100", "far = 1", "far = 1e-16"] {
        let text = text.replace("depth_cue]", &format!("depth_cue]\n{keys}"));
        let cue = studio(&text).depth_cue;
        assert!(cue.is_none_or(|cue| cue.near < cue.far), "{keys}: {cue:?}");
    }
}

#[test]
fn paths_and_samples() {
    let found = lighting(
        "[path]\nmax_depth = 20\nroulette_from = 5\nlight_sampling = 'direct'\n\
         [sampling]\nsamples = 100\nseed = 7\nfilter = 'gaussian'\n",
    );
    let Integrator::Path(path) = found.integrator else { panic!("{found:?}") };
    assert_eq!((path.max_depth, path.roulette_from), (20, 5));
    assert_eq!(path.light_sampling, LightSampling::Direct);
    assert_eq!(found.sampling, Sampling { samples: 100, seed: 7, filter: PixelFilter::Gaussian, denoise: false });
}

#[test]
fn lights_of_every_kind() {
    let found = lighting(
        "[[lights]]\nkind = 'head'\nstrength = 0.5\n\
         [[lights]]\nkind = 'directional'\nat = 'camera'\ndirection = [0, -2, 0]\ncolor = [1, 0.5, 0]\n\
         strength = 2\nangular_diameter = 60\n\
         [[lights]]\nkind = 'point'\nposition = [1, 2, 3]\nintensity = 9\n\
         [[lights]]\nkind = 'sphere'\nposition = [1, 2, 3]\nradius = 0.5\nradiance = 4\n\
         [sun]\ntoward = [1, 1, 0]\n",
    );
    let [head, far, point, lamp, sun] = found.lights[..] else { panic!("{:?}", found.lights) };
    assert_eq!(head.kind, LightKind::Head { strength: LinearRgb::new([0.5; 3]).unwrap() });
    let LightKind::Directional { toward, strength, angular_radius } = far.kind else { panic!() };
    assert_eq!((toward, far.frame), (DVec3::new(0.0, 2.0, 0.0), LightFrame::Camera));
    assert_eq!(strength.to_array(), [2.0, 1.0, 0.0]);
    assert!((angular_radius - std::f64::consts::FRAC_PI_6).abs() < 1e-15);
    let nine = LinearRgb::new([9.0; 3]).unwrap();
    let position = DVec3::new(1.0, 2.0, 3.0);
    assert_eq!(point.kind, LightKind::Point { position, intensity: nine });
    let radiance = LinearRgb::new([4.0; 3]).unwrap();
    assert_eq!(lamp.kind, LightKind::Sphere { center: position, radius: 0.5, radiance });
    let LightKind::Directional { angular_radius, strength, .. } = sun.kind else { panic!() };
    assert!((angular_radius.to_degrees() - 0.27).abs() < 1e-12);
    assert_eq!((strength, sun.frame), (LinearRgb::WHITE, LightFrame::World));
}

#[test]
fn a_file_that_names_lights_gets_no_others() {
    let default = Light::key_and_fill().to_vec();
    let black = SkyLight::Constant(LinearRgb::BLACK);
    let by_path = |text: &str| {
        let found = lighting_by(text, IntegratorKind::Path);
        (found.lights, found.sky.light)
    };
    assert_eq!(by_path("").0, default);
    assert_ne!(by_path("").1, black);
    assert_eq!(by_path("lights = []\n"), (Vec::new(), black.clone()));
    assert_eq!(by_path("[sun]\ntoward = [0, 1, 0]\n").1, black);
    let (lights, sky) = by_path("[sky]\nkind = 'constant'\ncolor = [0.5, 1, 2]\nstrength = 2\n");
    assert_eq!(lights, []);
    assert_eq!(sky, SkyLight::Constant(LinearRgb::new([1.0, 2.0, 4.0]).unwrap()));
}

#[test]
fn skies() {
    let gradient = lighting("[sky]\nkind = 'gradient'\nzenith = [0, 0, 1]\nvisible = false\n").sky;
    assert!(!gradient.is_visible);
    let SkyLight::Gradient { zenith, horizon, nadir } = gradient.light else { panic!() };
    assert_eq!(zenith.to_array(), [0.0, 0.0, 1.0]);
    assert_eq!([horizon, nadir].map(|c| c.to_array()[0]), [0.8, 0.4]);

    let file = parse("[sky]\nkind = 'image'\nimage = 'a.hdr'\nrotation = 90\nstrength = 3\n");
    assert_eq!(file.sky_image(), Some("a.hdr"));
    let scene = scene(&file);
    let camera = file.camera(&file.film, &scene).unwrap();
    let image = Environment::new(2, 1, vec![[1.0; 3]; 2]).unwrap();
    let kind = IntegratorKind::Path;
    let found = file.settings(kind, &scene, camera.as_ref(), Some(image)).unwrap();
    assert!(found.sky.is_visible);
    let SkyLight::Image { strength, rotation, .. } = found.sky.light else { panic!() };
    assert_eq!((strength, rotation), (3.0, std::f64::consts::FRAC_PI_2));
    // A studio does not need the image.
    assert!(file.settings(IntegratorKind::Studio, &scene, camera.as_ref(), None).is_ok());
    assert_eq!(
        file.settings(kind, &scene, camera.as_ref(), None).unwrap_err().to_string(),
        "line 3, column 9: `image`: the settings need this image of the sky, which was not given"
    );
}

#[test]
fn a_ground_touches_the_lowest_sphere() {
    let ground = |text: &str| lighting(&format!("[ground]\n{text}{SPHERE}")).ground.unwrap();
    let found = ground("");
    assert_eq!((found.point.y, found.normal), (1.0, DVec3::Y));
    assert!(!found.is_shadow_catcher);
    assert_eq!(ground("height = -5\n").point, DVec3::new(0.0, -5.0, 0.0));
    let found = ground("point = [1, 1, 1]\nnormal = [0, 0, 2]\nshadow_catcher = true\n");
    assert_eq!((found.point, found.normal), (DVec3::ONE, DVec3::new(0.0, 0.0, 2.0)));
    assert!(found.is_shadow_catcher);
    assert_eq!(lighting("[ground]\n").ground.unwrap().point.y, -0.5);
}

/// Refused files are in `tests/files/refused/scene_files_light.txt`.
#[test]
fn what_emits_may_be_bright() {
    // Emitters may be brighter than white, and so may the colours of a picture without light.
    let lamp = "[materials.a]\nkind = 'emissive'\n[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\n\
                color = [5, 5, 5]\nmaterial = 'a'\n";
    lighting(lamp);
    assert_eq!(parse("[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = [5, 5, 5]\n").integrator(), None);
}

#[test]
fn every_example_is_right() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut lit = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let place = path.display();
        let text = std::fs::read_to_string(&path).unwrap();
        let file = SceneFile::parse(&text).unwrap_or_else(|error| panic!("{place}: {error}"));
        let scene = file.scene().unwrap_or_else(|error| panic!("{place}: {error}"));
        // A file without spheres must refer to data, which is not loaded here.
        assert!(!scene.is_empty() || file.data().is_some(), "{place}");
        let camera = file.camera(&file.film, &scene);
        let camera = camera.unwrap_or_else(|error| panic!("{place}: {error}"));
        let image = file.sky_image().map(|name| {
            let bytes = std::fs::read(folder.join(name)).unwrap();
            pinhole_figure::read::environment::read(&bytes).unwrap()
        });
        let Some(kind) = file.integrator() else { continue };
        let lighting = file.settings(kind, &scene, camera.as_ref(), image);
        lighting.unwrap_or_else(|error| panic!("{place}: {error}"));
        lit += 1;
    }
    assert!(lit >= 9, "{lit}");
}
