//! Tests of the light and the materials of scene files.

use pinhole::glam::DVec3;
use pinhole::image::color::LinearRgb;
use pinhole::light::environment::Environment;
use pinhole::light::{Light, LightFrame, LightKind, SkyLight};
use pinhole::load::{Column, ColumnValues, Labels, Loaded};
use pinhole::render::{Integrator, LightSampling, RenderSettings, Sampling, Studio};
use pinhole::scene_file::{AppliedData, DataSpheres, IntegratorKind, SceneFile};
use pinhole::{Material, PixelFilter, Scene, SphereArray, SurfaceProperties};

const SPHERE: &str = "[[spheres]]\ncenter = [1, 2, 3]\nradius = 1\n";

fn parse(text: &str) -> SceneFile {
    SceneFile::parse(text).unwrap_or_else(|error| panic!("{error}"))
}

fn scene(file: &SceneFile) -> Scene {
    file.scene(&[]).unwrap_or_else(|error| panic!("{error}"))
}

/// The message of the first error, whether it appears in parsing or in the settings.
fn message(text: &str) -> String {
    let file = match SceneFile::parse(text) {
        Err(error) => return error.to_string(),
        Ok(file) => file,
    };
    let scene = scene(&file);
    let camera = file.camera(&file.film, &scene).unwrap();
    let kind = file.integrator().unwrap_or(IntegratorKind::Studio);
    file.settings(kind, &scene, camera.as_ref(), None).unwrap_err().to_string()
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

/// The tables that concern light do not prevent a picture without light.
#[test]
fn primary_rays_use_only_their_own_settings() {
    let text = "integrator = 'primary'\nshading = 'flat'\nbackground = 'red'\n";
    let kind = IntegratorKind::Primary;
    assert_eq!(parse(text).integrator(), Some(kind));
    let background = LinearRgb::from_srgb8([255, 0, 0]);
    let expected = RenderSettings { background, ..RenderSettings::default() };
    let integrator = Integrator::Primary(pinhole::Shading::Flat);
    assert_eq!(lighting(text), RenderSettings { integrator, ..expected.clone() });
    let lit = "background = 'red'\n[studio]\n[sampling]\nsamples = 9\ndenoise = true\n[ground]\n[sun]\ntoward = [0, 1, 0]\n";
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
        first_surface(&format!(
            "[materials.'it is']\n{material}\n{SPHERE}material = 'it is'\n{keys}"
        ))
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

/// Four atoms O, H, C1, O in two chains, one of which is water.
fn molecule() -> Loaded {
    let mut loaded = Loaded::new(SphereArray::F64(vec![[0.0, 0.0, 0.0, 1.0]; 4]));
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
    let apply =
        |text: &str| parse(&format!("data = 'a.pdb'\n{text}")).data().unwrap().apply(molecule());
    let radii = |text: &str| {
        let AppliedData { spheres, notes, .. } = apply(text).unwrap();
        let DataSpheres::Spheres(atoms) = spheres else { panic!("atoms have colours") };
        (atoms.iter().map(|atom| atom.radius).collect::<Vec<_>>(), notes)
    };
    let tables = "[elements.A]\nradius = 2\n[elements.HOH]\nradius = 5\n";
    let (found, notes) = radii(&format!("elements_by = ['residue', 'chain']\n{tables}"));
    assert_eq!((found, notes), (vec![2.0, 1.0, 1.0, 5.0], Vec::new()));
    let (found, notes) = radii("leave_out = { residue = ['HOH', 'SOL'], chain = ['B'] }\n");
    assert_eq!(found, [1.0]);
    assert_eq!(
        notes,
        ["`leave_out`: no atom of a.pdb has the residue SOL; check its spelling or remove it"]
    );
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
        assert_eq!(apply(text).unwrap_err().to_string(), wanted);
    }
    let plain = parse("data = 'a.npy'\nleave_out = { chain = ['A'] }\n");
    let refused =
        plain.data().unwrap().apply(Loaded::new(SphereArray::F32(Vec::new()))).unwrap_err();
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
    let AppliedData { spheres: atoms, notes, .. } = data.apply(molecule()).unwrap();
    assert_eq!(
        notes,
        ["`[elements.X]`: no atom of a.xyz has this name; check its spelling or remove the table"]
    );
    let DataSpheres::Spheres(atoms) = atoms else { panic!("atoms have colours") };
    let metal =
        SurfaceProperties { material: Material::Conductor { roughness: 0.2 }, opacity: 0.5 };
    let radii: Vec<f64> = atoms.iter().map(|atom| atom.radius).collect();
    assert_eq!(radii, [3.0, 1.0, 1.0, 3.0]);
    assert_eq!(atoms[0].color, LinearRgb::from_srgb8([255, 0, 0]));
    assert_eq!((atoms[1].color, atoms[1].surface), (LinearRgb::WHITE, metal));
    assert_eq!(atoms[0].surface, metal);
    assert!(matches!(atoms[2].surface.material, Material::Dielectric { .. }));
    assert_eq!(atoms[2].surface.opacity, 0.75);
}

#[test]
fn arrays_get_the_common_surface_properties() {
    for own in ["", SPHERE] {
        let file = parse(&format!("data = 'a.npy'\nopacity = 0.5\n{own}"));
        let spheres = SphereArray::F32(vec![[0.0, 0.0, 0.0, 1.0]; 2]);
        let scene = file.scene_with_array(spheres, LinearRgb::WHITE).unwrap();
        let last = scene.len() as u32 - 1;
        assert_eq!(scene.surface(last).opacity, 0.5);
        assert_eq!(scene.surface(0).opacity, if own.is_empty() { 0.5 } else { 1.0 });
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
    assert!(!found.has_shadows);
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
    // Whichever of the keys is given, `far` is greater than `near`.
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
    assert_eq!(found.sampling, Sampling { samples: 100, seed: 7, filter: PixelFilter::Gaussian });
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
        "line 3, column 9: the settings need this image of the sky, which was not given"
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

#[test]
fn numbers_out_of_range_are_named_with_their_position() {
    for (text, expected) in [
        (
            "[sampling]\nsamples = 0\n",
            "line 2, column 11: `samples` is 0; it must be from 1 to 16777216",
        ),
        (
            "[path]\nmax_depth = 65\n",
            "line 2, column 13: `max_depth` is 65; it must be from 1 to 64",
        ),
        (
            "[studio]\nmax_surfaces = 0\n",
            "line 2, column 16: `max_surfaces` is 0; it must be from 1 to 64",
        ),
        (
            "[studio.occlusion]\nsamples = 2000\n",
            "line 2, column 11: `samples` is 2000; it must be from 1 to 1024",
        ),
        (
            "[studio.occlusion]\nradius = -1\n",
            "line 2, column 10: `radius` is -1; it must be a length greater than 0, from 2^-56 to 2^56",
        ),
        (
            "[studio.outline]\nwidth = 0.1\n",
            "line 2, column 9: `width` is 0.1; it must be from 0.5 to 64 pixels",
        ),
        (
            "[studio.outline]\nwidth = nan\n",
            "line 2, column 9: `width` is NaN; it must be a number",
        ),
        (
            "[studio.outline]\nangle = 200\n",
            "line 2, column 9: `angle` is 200; it must be from 0 to 180 degrees",
        ),
        ("[studio.outline]\ndepth = -1\n", "line 2, column 9: `depth` is -1; it must be 0 or more"),
        (
            "[studio.depth_cue]\nnear = 5\nfar = 5\n",
            "line 3, column 7: `far` is 5; it must be more than `near`",
        ),
        (
            "[studio.depth_cue]\nnear = inf\n",
            "line 2, column 8: `near` is inf; it must be 0 or more, and at most 2^56",
        ),
        (
            "[materials.a]\nkind = 'lambert'\nspecular = 1.1\n",
            "line 3, column 12: `specular` is 1.1; it must be from 0 to 1",
        ),
        (
            "[materials.a]\nkind = 'conductor'\nroughness = 0\n",
            "line 3, column 13: `roughness` is 0; it must be from 0.02 to 1",
        ),
        (
            "[materials.a]\nkind = 'dielectric'\nior = 0.9\n",
            "line 3, column 7: `ior` is 0.9; it must be from 1 to 4",
        ),
        (
            "[materials.a]\nkind = 'emissive'\nstrength = -1\n",
            "line 3, column 12: `strength` is -1; it must be from 0 to 1e6",
        ),
        (
            "[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\nopacity = 1.5\n",
            "line 4, column 11: `opacity` is 1.5; it must be from 0 to 1",
        ),
        (
            "data = 'a'\nopacity = -0.5\n",
            "line 2, column 11: `opacity` is -0.5; it must be from 0 to 1",
        ),
        (
            "data = 'a'\n[elements.Fe]\nradius = 0\n",
            "line 3, column 10: `radius` is 0; it must be finite and greater than 0",
        ),
        (
            "[[lights]]\nkind = 'head'\nstrength = -2\n",
            "line 3, column 12: `strength` is -2; it must be from 0 to 1e6",
        ),
        (
            "[[lights]]\nkind = 'directional'\ntoward = [0, 0, 0]\n",
            "line 3, column 10: `toward` is [0.0, 0.0, 0.0], which is not a valid direction; its length must not be 0",
        ),
        (
            "[sun]\ntoward = [0, 1, 0]\nangular_radius = 0.01\n",
            "line 3, column 18: `angular_radius` is 0.01; it must be 0, or from 0.06 to 90 degrees",
        ),
        (
            "[[lights]]\nkind = 'point'\nposition = [0, inf, 0]\n",
            "line 3, column 12: `position` is [0.0, inf, 0.0]; each number must lie between -2^56 and 2^56",
        ),
        (
            "[[lights]]\nkind = 'sphere'\nposition = [0, 0, 0]\nradius = 0\n",
            "line 4, column 10: `radius` is 0; it must be a length greater than 0, from 2^-56 to 2^56",
        ),
        (
            "[sky]\nkind = 'image'\nimage = 'a.hdr'\nrotation = nan\n",
            "line 4, column 12: `rotation` is NaN; it must be from -36000 to 36000 degrees",
        ),
        (
            "[sky]\nkind = 'constant'\nstrength = 1e7\n",
            "line 3, column 12: `strength` is 10000000; it must be from 0 to 1e6",
        ),
        (
            "[ground]\nheight = nan\n",
            "line 2, column 10: `height` is NaN; it must be between -2^56 and 2^56",
        ),
    ] {
        assert_eq!(message(text), expected, "{text}");
    }
}

#[test]
fn errors_name_a_remedy() {
    let ground = "integrator = 'path'\n[ground]\nshadow_catcher = true\n";
    for (text, expected) in [
        (
            "integrater = 'path'\n",
            "line 1, column 1: unknown key `integrater`; did you mean `integrator`?",
        ),
        ("integrator = 'pathe'\n", "line 1, column 14: unknown name `pathe`; did you mean `path`?"),
        (
            "[studio]\nambiant = 1\n",
            "line 2, column 1: unknown key `ambiant`; did you mean `ambient`?",
        ),
        (
            "[[lights]]\nkind = 'spot'\n",
            "line 2, column 8: unknown name `spot`; did you mean `point`?",
        ),
        ("[[lights]]\nstrength = 1\n", "line 1, column 1: missing key `kind`"),
        (
            "[materials.a]\nrough = 1\n",
            "line 2, column 1: unknown key `rough`; did you mean `roughness`?",
        ),
        (
            "[materials.glass]\nkind = 'dielectric'\n[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'glas'\n",
            "line 6, column 12: unknown material `glas`; did you mean `glass`?",
        ),
        (
            "[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'glass'\n",
            "line 4, column 12: there is no material `glass`; add a table `[materials.glass]`",
        ),
        (
            "[materials.a]\nkind = 'lambert'\nior = 1.5\n",
            "line 3, column 7: `ior` does not apply to the kind `lambert`; remove it",
        ),
        (
            "[[lights]]\nkind = 'head'\nat = 'camera'\n",
            "line 3, column 6: `at` does not apply to the kind `head`; remove it",
        ),
        (
            "[[lights]]\nkind = 'point'\nposition = [0, 0, 0]\nstrength = 1\n",
            "line 4, column 12: `strength` does not apply to the kind `point`; remove it",
        ),
        (
            "[sky]\nkind = 'image'\nimage = 'a.hdr'\ncolor = 'red'\n",
            "line 4, column 9: `color` does not apply to the kind `image`; remove it",
        ),
        (
            "[sky]\nkind = 'image'\n",
            "line 1, column 1: a sky of the kind `image` needs a file; add `image = \"FILE.hdr\"`, or .exr",
        ),
        (
            "[sun]\n",
            "line 1, column 1: the light has no direction; add `toward = [x, y, z]`, the direction to the light, or `direction = [x, y, z]`, the direction in which it shines",
        ),
        (
            "[sun]\ntoward = [0, 1, 0]\ndirection = [0, 1, 0]\n",
            "line 3, column 13: `toward` and `direction` both set the direction of the light; remove one of them",
        ),
        (
            "[[lights]]\nkind = 'sphere'\nposition = [0, 0, 0]\n",
            "line 1, column 1: a sphere light needs a radius; add `radius`, a length greater than 0",
        ),
        (
            "[[lights]]\nkind = 'point'\n",
            "line 1, column 1: a point light needs a position; add `position = [x, y, z]`",
        ),
        (
            "[ground]\nheight = 1\npoint = [0, 0, 0]\n",
            "line 2, column 10: `height` cannot be combined with `point` or `normal`; remove one of them",
        ),
        (
            "[ground]\nnormal = [0, 1, 0]\n",
            "line 2, column 10: `normal` needs a point on the ground; add `point = [x, y, z]`",
        ),
        (
            "[ground]\ncolor = [2, 0, 0]\n",
            "line 1, column 1: the ground has the color [2.0, 0.0, 0.0], which creates light; each component of a color that scatters must be at most 1",
        ),
        (
            "[studio]\n[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = [1, 1, 1.5]\n",
            "line 2, column 1: sphere 0 has the color [1.0, 1.0, 1.5], which creates light; each component of a color that scatters must be at most 1",
        ),
        (
            ground,
            "line 2, column 1: a shadow catcher needs the integrator `studio`; the integrator `path` does not support it",
        ),
        (
            "[studio]\n[path]\n",
            "line 2, column 1: `[path]` applies to the integrator `path` and `[studio]` to the integrator `studio`; choose one with `integrator = \"path\"` or `integrator = \"studio\"`",
        ),
        (
            "shading = 'flat'\n[studio]\n",
            "line 1, column 11: `shading` applies only to pictures without light, but this file asks for light; remove `shading`",
        ),
        (
            "integrator = 'primary'\n[sampling]\nsamples = 4\n",
            "line 2, column 1: `[sampling]` applies only to pictures with light, but `integrator = \"primary\"` makes a picture without light; remove one of them",
        ),
        (
            "integrator = 'primary'\n[ground]\n[path]\n",
            "line 3, column 1: `[path]` applies only to pictures with light, but `integrator = \"primary\"` makes a picture without light; remove one of them",
        ),
        (
            "integrator = 'primary'\n[[lights]]\nkind = 'head'\n",
            "line 2, column 1: `[[lights]]` applies only to pictures with light, but `integrator = \"primary\"` makes a picture without light; remove one of them",
        ),
        (
            "material = 'a'\n",
            "line 1, column 12: `material` applies to `data`, which is missing; add `data` or remove `material`",
        ),
        (
            "[elements.Fe]\n",
            "line 1, column 1: `elements` applies to `data`, which is missing; add `data` or remove `elements`",
        ),
    ] {
        assert_eq!(message(text), expected, "{text}");
    }
    for (bright, what) in [
        (
            "[[lights]]\nkind = 'head'\ncolor = [1e30, 0, 0]\n",
            "line 1, column 1: the light shines with [1e30, 0.0, 0.0]",
        ),
        (
            "[path]\n[sky]\nkind = 'constant'\ncolor = [0, 1e19, 0]\n",
            "line 2, column 1: the sky shines with",
        ),
        ("[studio]\nambient = [1e20, 0, 0]\n", "the ambient light, or the background, shines with"),
        (
            "[materials.a]\nkind = 'emissive'\nstrength = 1e6\n[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\n\
             color = [1e13, 0, 0]\nmaterial = 'a'\n",
            "line 4, column 1: sphere 0 shines with",
        ),
    ] {
        let found = message(bright);
        assert!(found.contains(what) && found.ends_with("at most 1e18"), "{found}");
    }
    // Emitters may be brighter than white, and so may the colours of a picture without light.
    let lamp = "[materials.a]\nkind = 'emissive'\n[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\n\
                color = [5, 5, 5]\nmaterial = 'a'\n";
    lighting(lamp);
    assert_eq!(
        parse("[[spheres]]\ncenter = [0, 0, 0]\nradius = 1\ncolor = [5, 5, 5]\n").integrator(),
        None
    );
}

#[test]
fn every_example_is_right() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut lit = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let place = path.display();
        let text = std::fs::read_to_string(&path).unwrap();
        let file = SceneFile::parse(&text).unwrap_or_else(|error| panic!("{place}: {error}"));
        let scene = file.scene(&[]).unwrap_or_else(|error| panic!("{place}: {error}"));
        // A file without spheres must refer to data, which is not loaded here.
        assert!(!scene.is_empty() || file.data().is_some(), "{place}");
        let camera = file.camera(&file.film, &scene);
        let camera = camera.unwrap_or_else(|error| panic!("{place}: {error}"));
        let image = file.sky_image().map(|name| {
            let bytes = std::fs::read(folder.join(name)).unwrap();
            pinhole::load::environment::read(&bytes).unwrap()
        });
        let Some(kind) = file.integrator() else { continue };
        let lighting = file.settings(kind, &scene, camera.as_ref(), image);
        lighting.unwrap_or_else(|error| panic!("{place}: {error}"));
        lit += 1;
    }
    assert!(lit >= 9, "{lit}");
}
