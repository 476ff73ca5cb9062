//! Settings: contradictions are refused, unusual settings are noted, and primary rays are one of the integrators.

use glam::DVec3;
use pinhole::camera::{PinholeCamera, Pose};
use pinhole::image::NO_ID;
use pinhole::light::{Ground, Light, Sky, SkyLight};
use pinhole::render::{PathTracing, Sampling, SettingsError, Studio};
use pinhole::{
    Film, Integrator, LayerSet, LinearRgb, Material, RenderSettings, Scene, Shading, Sphere, View, cpu, glam,
};

fn grey() -> LinearRgb {
    LinearRgb::from_srgb8([128; 3])
}

fn one(sphere: Sphere) -> Scene {
    Scene::new(&[sphere]).unwrap()
}

fn sphere() -> Sphere {
    Sphere::new([0.0; 3], 1.0, grey())
}

fn camera() -> PinholeCamera {
    let pose = Pose::looking_at([0.0, 0.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0]).unwrap();
    PinholeCamera::with_vertical_fov(pose, 0.6, 1.0).unwrap()
}

fn visible_sky() -> Sky {
    Sky { light: SkyLight::Constant(LinearRgb::WHITE), is_visible: true }
}

fn ground(is_shadow_catcher: bool) -> Option<Ground> {
    Some(Ground { point: DVec3::ZERO, normal: DVec3::Y, color: grey(), is_shadow_catcher })
}

#[test]
fn what_an_integrator_ignores_is_named() {
    let scene = one(sphere());
    let refused = |settings: RenderSettings| settings.check(&scene).unwrap_err().to_string();
    let primary = RenderSettings::default;
    for (settings, what) in [
        (RenderSettings { lights: Light::key_and_fill().to_vec(), ..primary() }, "the lights"),
        (RenderSettings { ground: ground(false), ..primary() }, "the ground"),
        (primary().with_denoise(true), "denoising"),
    ] {
        assert_eq!(
            refused(settings),
            format!(
                "the integrator `primary` does not use {what}; leave out {what}, or choose the integrator \
                 `studio` or `path`"
            )
        );
    }
    for (settings, integrator) in [(primary(), "primary"), (RenderSettings::studio(), "studio")] {
        assert_eq!(
            refused(RenderSettings { sky: visible_sky(), ..settings }),
            format!(
                "the integrator `{integrator}` does not use the sky; leave out the sky, or choose the integrator \
                 `path`"
            )
        );
    }
    let sampling = Sampling { samples: 4, ..Sampling::default() };
    assert_eq!(
        refused(RenderSettings { sampling, ..primary() }),
        "the integrator `primary` traces one ray through the center of each pixel, but 4 samples are asked for; \
         ask for 1, or choose the integrator `studio` or `path`"
    );
    let caught = RenderSettings { ground: ground(true), ..RenderSettings::path() };
    assert_eq!(caught.check(&scene), Err(SettingsError::Catcher));
    assert!(refused(caught).contains("`studio`"));
}

#[test]
fn what_belongs_together_is_accepted() {
    let scene = one(sphere());
    let accepted = [
        RenderSettings::default(),
        RenderSettings { is_transparent: true, ..RenderSettings::default() },
        RenderSettings::studio(),
        RenderSettings { ground: ground(true), ..RenderSettings::studio().with_denoise(true) },
        RenderSettings::path(),
        RenderSettings { sky: visible_sky(), ground: ground(false), ..RenderSettings::path() },
    ];
    for settings in accepted {
        assert_eq!(settings.check(&scene), Ok(()), "{settings:?}");
    }
    // Surfaces that create light matter only for lit pictures.
    let bright = one(Sphere::new([0.0; 3], 1.0, LinearRgb::new([2.0; 3]).unwrap()));
    assert_eq!(RenderSettings::default().check(&bright), Ok(()));
    for settings in [RenderSettings::studio(), RenderSettings::path()] {
        let refused = settings.check(&bright);
        assert!(matches!(refused, Err(SettingsError::Albedo { .. })), "{refused:?}");
    }
}

#[test]
fn every_renderer_checks_first() {
    let (scene, camera) = (one(sphere()), camera());
    let view = View::new(&camera, Film::new(4, 4).unwrap());
    let wrong = RenderSettings::default().with_denoise(true);
    let error = cpu::render(&scene, &view, &wrong, LayerSet::COLOR).unwrap_err();
    assert!(matches!(error, cpu::RenderError::Settings(_)), "{error}");
    assert!(error.to_string().contains("does not use denoising"), "{error}");
    assert!(cpu::SampledPicture::new(&scene, &view, &wrong).is_err());
}

#[test]
fn what_is_odd_is_noted() {
    let matt = one(sphere());
    let clear = one(sphere().with_opacity(0.5));
    let metal = one(sphere().with_material(Material::Conductor { roughness: 0.3 }));
    let dark = RenderSettings {
        integrator: Integrator::Studio(Studio { ambient: LinearRgb::BLACK, ..Studio::default() }),
        lights: Vec::new(),
        ..RenderSettings::studio()
    };
    let (primary, studio, path) = (RenderSettings::default(), RenderSettings::studio(), RenderSettings::path());
    for (settings, scene, notes) in [
        (&primary, &matt, vec![]),
        (&primary, &metal, vec![]),
        (&primary, &clear, vec!["primary rays ignore opacity"]),
        (&studio, &clear, vec![]),
        (&studio, &metal, vec!["metal and glass are matt"]),
        (&path, &metal, vec![]),
        (&dark, &matt, vec!["no light:"]),
        (&dark, &metal, vec!["no light:", "metal and glass are matt"]),
    ] {
        let found = settings.notes(scene);
        let are_wanted = found.iter().zip(&notes).all(|(found, note)| found.starts_with(note));
        assert!(are_wanted && found.len() == notes.len(), "{found:?} is not {notes:?}");
    }
}

/// A round heap of a thousand spheres is deep. Spheres behind many others are visible if these are clear enough.
#[test]
fn surfaces_that_are_left_out_are_noted() {
    let ball = |count: u32, opacity: f32| {
        let mut random = fastrand::Rng::with_seed(5);
        let inside = std::iter::repeat_with(|| [(); 3].map(|()| 2.0 * random.f64() - 1.0))
            .filter(|center| center.iter().map(|c| c * c).sum::<f64>() < 1.0);
        let spheres =
            inside.take(count as usize).map(|center| Sphere::new(center, 0.15, LinearRgb::WHITE).with_opacity(opacity));
        Scene::new(&spheres.collect::<Vec<_>>()).unwrap()
    };
    let studio = RenderSettings::studio();
    for (count, opacity, is_deep) in [(1000, 0.1, true), (1000, 0.5, false), (100, 0.1, false), (1000, 1.0, false)] {
        let notes = studio.notes(&ball(count, opacity));
        assert_eq!(notes.len(), usize::from(is_deep), "{count} {opacity}: {notes:?}");
        assert!(notes.iter().all(|note| note.contains("the 16 nearest surfaces")), "{notes:?}");
    }
    let more = Studio { max_surfaces: 64, ..Studio::default() };
    let more = RenderSettings { integrator: Integrator::Studio(more), ..studio };
    assert_eq!(more.notes(&ball(1000, 0.1)), [""; 0]);
}

/// If nothing is hit, a transparent picture has neither colour nor alpha. Elsewhere it does not change.
#[test]
fn primary_rays_may_have_no_background() {
    let (scene, camera) = (one(sphere()), camera());
    let view = View::new(&camera, Film::new(9, 9).unwrap());
    let opaque = RenderSettings { background: grey(), ..RenderSettings::default() };
    let clear = RenderSettings { is_transparent: true, ..opaque.clone() };
    let [opaque, clear] = [opaque, clear].map(|s| cpu::render(&scene, &view, &s, LayerSet::ALL).unwrap());
    for (pixel, id) in opaque.id().unwrap().iter().enumerate() {
        let (color, alpha) = (clear.color()[pixel], clear.alpha().unwrap()[pixel]);
        if *id == NO_ID {
            assert_eq!((opaque.color()[pixel], color, alpha), (grey().to_array(), [0.0; 3], 0.0));
        } else {
            assert_eq!((color, alpha), (opaque.color()[pixel], 1.0));
        }
    }
    assert!(opaque.id().unwrap().contains(&NO_ID) && opaque.id().unwrap().contains(&0));
}

#[test]
fn samples_of_primary_rays_are_the_picture() {
    let (scene, camera) = (one(sphere()), camera());
    let view = View::new(&camera, Film::new(5, 5).unwrap());
    let settings = RenderSettings { integrator: Integrator::Primary(Shading::Flat), ..RenderSettings::default() };
    let picture = cpu::SampledPicture::new(&scene, &view, &settings).unwrap();
    let image = cpu::render(&scene, &view, &settings, LayerSet::ALL).unwrap();
    for (index, color) in image.color().iter().enumerate() {
        let pixel = [index as u32 % 5, index as u32 / 5];
        let sample = picture.sample(pixel, 0);
        assert_eq!(sample.color.as_vec3().to_array(), *color);
        assert_eq!(sample.alpha as f32, image.alpha().unwrap()[index]);
        assert_eq!(sample, picture.sample(pixel, 7));
    }
}

#[test]
fn what_is_left_by_primary_rays_is_accepted() {
    let scene = one(sphere());
    let mut lit = RenderSettings {
        integrator: Integrator::Path(PathTracing::default()),
        sky: visible_sky(),
        ground: ground(false),
        background: grey(),
        ..RenderSettings::path().with_denoise(true)
    };
    let left = lit.by_primary_rays();
    assert_eq!(left, RenderSettings { background: grey(), ..RenderSettings::default() });
    assert_eq!(left.check(&scene), Ok(()));
    lit.integrator = Integrator::Primary(Shading::Flat);
    assert_eq!(lit.by_primary_rays().integrator, lit.integrator);
}
