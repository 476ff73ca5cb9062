//! Tests that pictures in files are never accused if this device rendered them, and that faults of rendering are found.

use libtest_mimic::{Failed, Trial};
use pinhole::gpu::{Headless, Wait};
use pinhole::image::encoding::Bits;
use pinhole::render::{Occlusion, Outline, RenderSettings, Sampling, Studio};
use pinhole::verify::finished::{FinishedCertificate, FinishedRequest, LEAST_EXACT, PixelVerdict};
use pinhole::verify::written::{Samples, WrittenCertificate, WrittenPicture};
use pinhole::verify::{Checker, Interval, Outcome};
use pinhole::{Encoding, Image, Integrator, LayerSet, cpu};
use pinhole_figure::write::png;

use crate::planted::{self, Fault, named, planted};
use crate::support::View;
use crate::support::effort::share;
use crate::{headless, lit_scenes, scenes, verify};

/// Faults of layers that are not in the picture.
const OF_LAYERS: [&str; 5] = [
    "id_in_the_picture_off_by_one",
    "depth_from_the_box",
    "depth_not_along_the_ray",
    "misses_have_a_depth",
    "distance_forgotten",
];

/// Faults below the bounds of all rays together that a device may compute. They are found if rays are recorded.
const TOO_SMALL: [&str; 3] =
    ["origin_off_by_a_hundred_thousandth", "normal_turned_by_a_thirty_thousandth", "colors_larger_by_a_part_in_300000"];

/// Whether a fault can be seen in a picture alone.
fn is_visible(name: &str) -> bool {
    !OF_LAYERS.contains(&name) && !TOO_SMALL.contains(&name)
}

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = Vec::new();
    for (name, view) in scenes::all() {
        trials.push(Trial::test(format!("written::legal::{name}"), move || legal(&view)));
    }
    for (name, view) in share(scenes::all().into_iter()) {
        trials.push(Trial::test(format!("written::smooth::{name}"), move || smooth(view)));
    }
    for (name, view) in share(lit_scenes::all()) {
        trials.push(Trial::test(format!("written::exact::{name}"), move || exact(headless()?, &view)));
    }
    let is_seen = |fault: &Fault| is_visible(fault.name);
    let is_of_color = |fault: &Fault| {
        let file = &fault.edit.file;
        file.starts_with("primary/shad") && !file.contains('#') && is_visible(fault.name)
    };
    let found = |fault: &Fault| is_found(&fault.device()?, &named(verify::VIEWS, fault.setup[0])());
    let (render, primary) = (planted("render"), planted("primary"));
    trials.extend(planted::trials("written::faults::render_", render.filter(is_seen), found));
    trials.extend(planted::trials("written::faults::", primary.filter(is_of_color), found));
    trials.extend(planted::trials("written::faults::", planted("samples"), is_found_in_light));
    trials
}

/// Judges light without encoding, and samples of 16 bits.
fn certified(view: &View, image: &Image) -> Result<[WrittenCertificate; 2], Failed> {
    let View { scene, settings, .. } = view;
    let size = [image.width(), image.height()];
    let mut encoding = Encoding::default();
    encoding.bits = Bits::Sixteen;
    let encoding = &encoding;
    let bytes = png::samples(image, encoding)?;
    let light: Vec<[f32; 4]> = image.color().iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect();
    let primary = settings.primary().ok_or("not of primary rays")?;
    let checker = Checker::new(scene)?;
    let certify = |samples| {
        let picture = WrittenPicture { size, samples, encoding };
        checker.certify_written(&view.seen(), &primary, &picture)
    };
    Ok([certify(Samples::Linear(&light))?, certify(Samples::Encoded(&bytes))?])
}

fn legal(view: &View) -> Result<(), Failed> {
    let found = certified(view, &view.picture(headless()?, LayerSet::COLOR))?;
    match found.iter().flat_map(|found| &found.violations).next() {
        None => Ok(()),
        Some(first) => Err(first.to_string().into()),
    }
}

fn is_found(device: &Headless, view: &View) -> Result<(), Failed> {
    let [found, _] = certified(view, &view.picture(device, LayerSet::COLOR))?;
    match found.outcome() {
        Outcome::Violated => Ok(()),
        outcome => Err(format!("the fault was not found: {outcome}").into()),
    }
}

/// A picture of light by a device, and by the reference.
struct Pictures<'a> {
    view: &'a View,
    settings: RenderSettings,
    images: [Image; 2],
}

impl<'a> Pictures<'a> {
    /// If `is_finished`, noise is removed and lines are drawn.
    fn new(device: &Headless, view: &'a View, is_finished: bool) -> Result<Self, Failed> {
        let View { scene, settings, .. } = view;
        let mut settings = settings.clone();
        settings.sampling.denoise |= is_finished;
        if let (true, Integrator::Studio(studio)) = (is_finished, &mut settings.integrator) {
            studio.outline = Some(Outline::default());
        }
        let found = device.render(scene, &view.seen(), &settings, LayerSet::COLOR).wait()?;
        let exact = cpu::render(scene, &view.seen(), &settings, LayerSet::COLOR)?;
        Ok(Self { view, settings, images: [found, exact] })
    }

    /// Judges samples with these bits, or linear light.
    fn judged(&self, bits: Option<Bits>) -> Result<FinishedCertificate, Failed> {
        let Self { view, settings, images } = self;
        let mut encoding = Encoding::default();
        encoding.bits = bits.unwrap_or(Bits::Eight);
        let bytes = [png::samples(&images[0], &encoding)?, png::samples(&images[1], &encoding)?];
        let light =
            images.each_ref().map(|image| image.color().iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect::<Vec<_>>());
        let samples = |which: usize| match bits {
            Some(_) => Samples::Encoded(&bytes[which]),
            None => Samples::Linear(&light[which]),
        };
        let size = [images[0].width(), images[0].height()];
        let pictures = [0, 1].map(|which| WrittenPicture { size, samples: samples(which), encoding: &encoding });
        let [picture, exact] = &pictures;
        let request = FinishedRequest { views: &[view.seen()], settings, picture, exact, annotate: None };
        Ok(Checker::new(&view.scene)?.certify_finished(request)?)
    }
}

/// Judges finished pictures of light in samples of 8 and of 16 bits, and in linear light, and asserts that all pixels of
/// the device and of the reference are legal. If `is_finished`, noise is removed and lines are drawn.
pub(crate) fn finished(device: &Headless, view: &View, is_finished: bool) -> Result<[FinishedCertificate; 3], Failed> {
    let pictures = Pictures::new(device, view, is_finished)?;
    let all: Vec<usize> = (0..pictures.images[0].color().len()).collect();
    let legal = Checker::new(&view.scene)?.legal_light(&view.seen(), &pictures.settings, &all);
    for (index, legal) in legal.into_iter().enumerate() {
        for (image, name) in pictures.images.iter().zip(["the device", "the reference"]) {
            let color = image.color()[index];
            let is_legal = |legal: &[Interval; 4]| legal.iter().zip(color).all(|(legal, c)| legal.contains(c.into()));
            if legal.is_some_and(|legal| !is_legal(&legal)) {
                return Err(format!("pixel {index} of {name}: {color:?}; legal is {legal:?}").into());
            }
        }
    }
    Ok([pictures.judged(Some(Bits::Eight))?, pictures.judged(Some(Bits::Sixteen))?, pictures.judged(None)?])
}

/// Asserts that a fault of kernels that take whole samples is found in a picture of light.
fn is_found_in_light(fault: &Fault) -> Result<(), Failed> {
    let [scene] = fault.setup();
    let view = lit_scenes::named(scene);
    let judged = Pictures::new(&fault.device()?, &view, false)?.judged(Some(Bits::Eight))?;
    println!("{:?}", PixelVerdict::ALL.iter().map(|verdict| judged.count(*verdict)).collect::<Vec<_>>());
    match judged.outcome_of_device() {
        Outcome::Violated => Ok(()),
        outcome => Err(format!("the fault was not found: {outcome}").into()),
    }
}

/// Asserts that no pixel of finished pictures is violated.
pub(crate) fn none_violated(judged: &[FinishedCertificate]) -> Result<(), Failed> {
    for certificate in judged {
        println!("{:?}", PixelVerdict::ALL.iter().map(|verdict| certificate.count(*verdict)).collect::<Vec<_>>());
    }
    match judged.iter().flat_map(|certificate| &certificate.violations).next() {
        None => Ok(()),
        Some(first) => Err(first.to_string().into()),
    }
}

/// Judges a picture in which nothing is random, of the spheres of a view.
fn smooth(mut view: View) -> Result<(), Failed> {
    let outline = Some(Outline { depth: 1e-3, ..Outline::default() });
    let occlusion = Some(Occlusion::default());
    let sampling = Sampling { samples: 8, ..Sampling::default() };
    for [is_dense, added_light] in [[false; 2], [true, false], [false, true]] {
        let studio = Studio { is_smooth: true, is_dense, added_light, occlusion, outline, ..Studio::default() };
        view.settings = RenderSettings { integrator: Integrator::Studio(studio), sampling, ..RenderSettings::studio() };
        if !view.settings.is_smooth(&view.scene, view.camera.as_ref()) {
            return Ok(());
        }
        none_violated(&finished(headless()?, &view, false)?)?;
    }
    Ok(())
}

/// Judges pictures of this device. Almost all pixels are exact.
fn exact(device: &Headless, view: &View) -> Result<(), Failed> {
    for is_finished in [false, true] {
        let judged = finished(device, view, is_finished)?;
        none_violated(&judged)?;
        let share = judged[0].count(PixelVerdict::Exact) as f64 / judged[0].verdicts.len() as f64;
        if share < LEAST_EXACT {
            return Err(format!("only {share} of the pixels are exact").into());
        }
    }
    Ok(())
}
