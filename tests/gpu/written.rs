//! Tests that pictures in files are never accused if this device rendered them, and that faults of rendering are found.

use libtest_mimic::{Failed, Trial};
use pinhole::gpu::{Headless, Wait};
use pinhole::image::encoding::Bits;
use pinhole::verify::finished::{LEAST_EXACT, PixelVerdict};
use pinhole::verify::written::{Samples, WrittenCertificate, WrittenPicture};
use pinhole::verify::{Checker, Outcome};
use pinhole::{Encoding, Image, LayerSet, cpu};
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
    for (name, view) in share(lit_scenes::all()) {
        trials.push(Trial::test(format!("written::exact::{name}"), move || {
            let share = exact_share(headless()?, &view)?;
            if share >= LEAST_EXACT { Ok(()) } else { Err(format!("only {share} of the pixels are exact").into()) }
        }));
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

/// The share of pixels that are what the reference computes with the same random numbers.
fn exact_share(device: &Headless, view: &View) -> Result<f64, Failed> {
    let View { scene, settings, .. } = view;
    let found = device.render(scene, &view.seen(), settings, LayerSet::COLOR).wait()?;
    let exact = cpu::render(scene, &view.seen(), settings, LayerSet::COLOR)?;
    let (size, encoding) = ([found.width(), found.height()], &Encoding::default());
    let bytes = [png::samples(&found, encoding)?, png::samples(&exact, encoding)?];
    let pictures = bytes.each_ref().map(|bytes| WrittenPicture { size, samples: Samples::Encoded(bytes), encoding });
    let judged = Checker::new(scene)?.certify_finished(&view.seen(), settings, pictures.each_ref(), false)?;
    Ok(judged.count(PixelVerdict::Exact) as f64 / judged.verdicts.len() as f64)
}
