//! Light that a device finds for pixels in which it differs from the reference, recorded and judged stage by stage. Where
//! every stage is legal, this light is.

use anyhow::Context;

use crate::input::Input;
use crate::render::device::OpenDevice;
use crate::render::views::views_of;
use crate::render::with_scene::{explained, upload, with_structures};
use crate::render::{self, render_part};
use crate::terminal::failure::Failure;
use crate::terminal::{interrupt, progress};
use pinhole::accel::AccelChoice;
use pinhole::gpu::{Headless, LitPart, SampleRequest, Wait};
use pinhole::image::Image;
use pinhole::verify::{Checker, LitRecording, Witness};

/// The side of the rectangles that are recorded, in pixels.
const SIDE: u32 = 128;

/// Light that differs by less needs no witness, because it is finished alike: a step of 16 bits.
const STEP: f32 = 1.0 / 65536.0;

/// The unfinished picture of the reference, with the light of the device where that differs and is known to be legal.
pub(crate) fn of(
    headless: &Headless,
    checker: &Checker<'_>,
    input: &mut Input,
    exact: &Image,
    choice: AccelChoice,
    opened: &OpenDevice,
) -> Result<Image, Failure> {
    let layers = exact.layers();
    let mut found = render_part(input, input.film, layers, opened)?;
    let found = found.pop().context("there is no picture")?;
    let width = input.film.width();
    let differs =
        |(a, b): (&[f32; 3], &[f32; 3])| a.iter().zip(b).any(|(a, b)| (a - b).abs() > STEP * (b.abs() + STEP));
    let pairs = found.color().iter().zip(exact.color()).map(differs);
    let different = pairs.zip(0..).filter(|(differs, _)| *differs);
    let mut rectangles = std::collections::BTreeMap::<[u32; 2], Vec<[u32; 2]>>::new();
    for pixel in different.map(|(_, index): (bool, u32)| [index % width, index / width]) {
        rectangles.entry(pixel.map(|at| at / SIDE * SIDE)).or_default().push(pixel);
    }
    let samples: Vec<u32> = (0..input.settings.sampling.samples).collect();
    let unfinished = input.settings.unfinished();
    let (view, views) = (input.view(), views_of(input, input.film));
    let plan = |choice| render::plan(headless, input, &views, layers, choice, false);
    let done = with_structures(headless, choice, plan, |plan| {
        let mut image = exact.clone();
        let recorded = interrupt::on_device(|| {
            let buffers = upload(headless, &input.scene, plan)?;
            for (number, (origin, pixels)) in rectangles.iter().enumerate() {
                progress::stage(format!("recording witnesses, part {} of {}", number + 1, rectangles.len()));
                let mut witness = Witness::new(pixels.clone());
                let each = &mut |recording: &LitRecording| {
                    interrupt::driver_rests(true);
                    witness.add(checker, recording);
                    interrupt::driver_rests(false);
                };
                let part = LitPart::Rectangle { origin: *origin, size: [SIDE; 2] };
                let request = SampleRequest { part, samples: &samples };
                headless
                    .record_lit(&buffers, &view, &unfinished, request, each, &mut |_| interrupt::decide())
                    .wait()?;
                witness.apply(&mut image);
            }
            Ok(())
        })?;
        Ok(recorded.map(|()| image))
    })?;
    let (image, _) = done.map_err(|error| explained(headless, &error))?;
    Ok(image)
}
