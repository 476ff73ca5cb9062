//! Parts of a film have the pixels of the whole, to the bit, and so do pictures that are put together from them.

use pinhole::cpu::{self, SearchStructure};
use pinhole::render::{Outline, Sampling};
use pinhole::{Film, Image, LayerSet, RenderSettings, View};

use crate::support::random_light::{self, RandomView};

/// Rectangles that cover a film of 24 by 18 pixels.
const PARTS: [([u32; 2], [u32; 2]); 5] = [
    ([0, 0], [11, 7]),
    ([11, 0], [13, 3]),
    ([11, 3], [13, 4]),
    ([0, 7], [23, 11]),
    ([23, 7], [1, 11]),
];

/// The settings of a view, of which a studio has outlines, without noise.
fn finished(view: &RandomView) -> RenderSettings {
    let mut settings = RenderSettings {
        sampling: Sampling { samples: 3, ..view.settings.sampling },
        is_denoised: true,
        ..view.settings.clone()
    };
    if let pinhole::render::Integrator::Studio(studio) = &mut settings.integrator {
        studio.outline = Some(Outline::thin());
    }
    settings
}

/// Whether what looks at neighbours changed the picture.
fn check(view: &RandomView, settings: &RenderSettings) -> bool {
    let search = SearchStructure::new(&view.scene).unwrap();
    let on = |film: Film, settings: &RenderSettings, layers: LayerSet| {
        cpu::render(&search, &View::new(view.camera.as_ref(), film), settings, layers).unwrap()
    };
    let wanted = LayerSet::ALL;
    let whole = on(view.film, settings, wanted);
    let (unfinished, layers) = (settings.unfinished(), settings.layers_for(wanted));
    let mut joined = Image::new(24, 18, layers).unwrap();
    for (origin, size) in PARTS {
        let part = on(view.film.part(origin, size).unwrap(), &unfinished, layers);
        joined.put(&part, origin).unwrap();
    }
    let joined = cpu::finish(joined, settings, wanted);
    assert!(joined.to_le_bytes() == whole.to_le_bytes(), "{}", view.name);
    on(view.film, &unfinished, wanted).color() != whole.color()
}

#[test]
fn random_pictures_are_put_together_from_parts() {
    let mut changed = 0;
    for seed in 0..12 {
        for view in [random_light::view(seed), random_light::studio(seed)] {
            changed += usize::from(check(&view, &finished(&view)));
            check(&view, &view.settings.by_primary_rays());
        }
    }
    // Some of the pictures are dark.
    assert!(changed > 18, "{changed}");
}

#[test]
fn a_part_of_a_part_is_a_part() {
    let film = Film::new(24, 18).unwrap();
    let part = film.part([3, 4], [20, 10]).unwrap().part([2, 1], [5, 6]).unwrap();
    assert_eq!(part, film.part([5, 5], [5, 6]).unwrap());
    assert_eq!((part.width(), part.height(), part.origin()), (5, 6, [5, 5]));
    assert_eq!((part.whole(), part.aspect()), (film, film.aspect()));
    assert!(film.is_whole() && !part.is_whole());
    assert_eq!(film.part([0, 0], [24, 18]).unwrap(), film);
    for (origin, size) in [
        ([0, 0], [25, 18]),
        ([1, 0], [24, 18]),
        ([0, 18], [1, 1]),
        ([u32::MAX, 0], [1, 1]),
        ([0, 0], [0, 1]),
        ([0, 0], [1, u32::MAX]),
    ] {
        assert!(film.part(origin, size).is_err(), "{origin:?} {size:?}");
    }
}
