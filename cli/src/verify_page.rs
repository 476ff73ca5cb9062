//! Makes the page of `pinhole verify --report`: one file that needs no other files. All inserted text is escaped.

use std::fmt::Display;

use anyhow::{Context, Result};
use minijinja::value::Serde;
use minijinja::{Environment, Value};
use serde::Serialize;

use super::verify_lit::{LitFigure, drawn};
use super::verify_open::OpenPixel;
use super::verify_page_light::LightSection;
use super::verify_page_scope::not_covered;
use super::verify_page_spot::Spot;
use super::verify_pictures::{
    DECIDED_HIT, MISS, Pictures, Window, css, depth_color, verdict_color,
};
use super::verify_report::{Listed, Report};
use pinhole::verify::run_file::{Run, ShownPicture};
use pinhole::verify::{Certificate, Verdict, Violation};

/// The largest number of violations that are shown enlarged.
const ENLARGED: usize = 12;

/// Number of intervals of the colour scale.
const STOPS: u32 = 12;

/// A row of the table, which also is an entry of the legend.
#[derive(Serialize)]
struct Row {
    name: &'static str,
    meaning: &'static str,
    color: String,
    /// CSS background that shows all colours of this verdict in the pictures.
    swatch: String,
    count: String,
    percent: String,
    /// Width of this row's part of the bar, in percent.
    width: f64,
}

/// A violation that is shown enlarged.
#[derive(Serialize)]
struct Enlarged {
    number: usize,
    listed: Listed,
    color: String,
    mask: String,
    #[serde(flatten)]
    spot: Spot,
}

/// A pixel with several legal answers that is shown enlarged.
#[derive(Serialize)]
struct OpenFigure<'a> {
    pixel: [u32; 2],
    verdict: &'static str,
    message: &'a str,
    color: String,
    mask: String,
    #[serde(flatten)]
    spot: Spot,
}

/// The size of the pictures on a screen.
#[derive(Debug, PartialEq, Serialize)]
struct PictureSize {
    /// Width in CSS pixels, if there is enough room. A picture with a row for itself has the width `wide`.
    width: f64,
    wide: f64,
    /// Aspect ratio: width over height.
    aspect: f64,
    stretched: bool,
    /// Whether pixels are shown as sharp squares.
    sharp: bool,
}

impl PictureSize {
    fn new([width, height]: [u32; 2]) -> Self {
        /// Largest ratio of the sides of a frame.
        const LONGEST: f64 = 8.0;
        /// Largest height in CSS pixels.
        const HEIGHT: f64 = 860.0;
        const LARGEST_PIXEL: f64 = 32.0;
        let film = f64::from(width) / f64::from(height);
        let aspect = film.clamp(1.0 / LONGEST, LONGEST);
        let least = (HEIGHT * aspect).min(128.0);
        let most = LARGEST_PIXEL * f64::from(width.max(height)) * aspect.min(1.0);
        let wide = most.min(HEIGHT * aspect).max(least);
        Self {
            width: wide.min(576.0),
            wide,
            aspect,
            stretched: (film - aspect).abs() > 0.0,
            sharp: width.max(height) <= 300,
        }
    }
}

/// The values that the template inserts.
#[derive(Serialize)]
struct Page<'a> {
    report: &'a Report,
    /// The check of light, if there was one.
    light: Option<LightSection<'a>>,
    /// The lit picture, which is not checked, if the scene asks for light.
    lit: Option<LitFigure>,
    /// Version of the program that checks.
    program: &'static str,
    /// The run file that holds the checked recording, if there is one.
    run_file: Option<String>,
    pixels: String,
    spheres: String,
    violation_count: String,
    rows: Vec<Row>,
    worst_depth: String,
    worst_normal: String,
    /// Number of pixels in which `render` gives other values than the recording, if that is known.
    rendered_otherwise: Option<String>,
    /// Width and height of the pictures in the page. One of their pixels stands for `step` × `step` pixels.
    shown: [u32; 2],
    step: u32,
    frame: PictureSize,
    color: String,
    depth: String,
    /// Picture of the verdicts; `None` if no pixel was judged.
    mask: Option<String>,
    miss: String,
    scale: String,
    /// Labels of the depth scale; `None` if no sphere is hit.
    ticks: Option<Vec<String>>,
    violations: Vec<Enlarged>,
    /// The first ties and silhouettes.
    open: Vec<OpenFigure<'a>>,
    /// What the report does not cover, in words.
    not_covered: Vec<String>,
}

/// Makes the page. `lit` is the picture with light, if there is one. `run_file` is the file that holds the checked recording, if there is one.
pub(super) fn page(
    run: &Run,
    certificate: &Certificate,
    report: &Report,
    lit: Option<&ShownPicture>,
    run_file: Option<impl Display>,
) -> Result<String> {
    let pictures = Pictures::new(run, certificate);
    let size = certificate.size;
    let whole = Window::whole(size);
    let first = (1..=ENLARGED).zip(&certificate.violations);
    let page = Page {
        report,
        light: report
            .light()
            .map(|light| {
                LightSection::new(light, size, |window| match lit {
                    Some(lit) => drawn(lit, window),
                    None => pictures.color(window),
                })
            })
            .transpose()?,
        lit: lit.map(|lit| LitFigure::new(lit, whole)).transpose()?,
        program: env!("CARGO_PKG_VERSION"),
        run_file: run_file.map(|path| path.to_string()),
        pixels: grouped(u64::from(size[0]) * u64::from(size[1])),
        spheres: grouped(report.scene.spheres as u64),
        violation_count: grouped(report.count(Verdict::Violation) as u64),
        rows: rows(certificate),
        worst_depth: format!("{:.4}", certificate.worst_depth),
        worst_normal: format!("{:.4}", certificate.worst_normal),
        rendered_otherwise: report.rendered_otherwise.map(|count| grouped(count as u64)),
        shown: whole.shown(),
        step: whole.step,
        frame: PictureSize::new(size),
        color: pictures.color(whole)?,
        depth: pictures.depth_colors(whole)?,
        mask: match certificate.verdicts.is_empty() {
            true => None,
            false => Some(pictures.mask(whole)?),
        },
        miss: css(MISS),
        scale: scale(),
        ticks: pictures.depths.map(ticks),
        violations: first
            .map(|(number, violation)| enlarged(&pictures, number, violation, size))
            .collect::<Result<_>>()?,
        open: report
            .open_pixels
            .iter()
            .map(|open| open_figure(&pictures, open, size))
            .collect::<Result<_>>()?,
        not_covered: not_covered(report, lit.map(|lit| lit.wanted)),
    };
    let mut environment = Environment::new();
    let template = include_str!("verify_page.html");
    // The extension .html makes the template engine escape all inserted text.
    environment
        .add_template("page.html", template)
        .context("the page of the report cannot be made")?;
    let template =
        environment.get_template("page.html").context("the page of the report cannot be made")?;
    template.render(Value::from(Serde(page))).context("the page of the report cannot be made")
}

fn rows(certificate: &Certificate) -> Vec<Row> {
    let pixels = certificate.verdicts.len().max(1) as f64;
    let row = |verdict: &Verdict| {
        let count = certificate.count(*verdict);
        let percent = 100.0 * count as f64 / pixels;
        Row {
            name: verdict.name(),
            meaning: match verdict {
                Verdict::Decided => "one answer is legal, and the device gave it",
                Verdict::Silhouette => "a sphere and a miss are legal; the device gave one of them",
                Verdict::Tie => "several spheres are legal; the device gave one of them",
                Verdict::Violation => "the device gave an answer that is not legal",
            },
            color: css(verdict_color(*verdict)),
            swatch: match (css(verdict_color(*verdict)), verdict) {
                (miss, Verdict::Decided) => {
                    format!("linear-gradient(135deg, {miss} 50%, {} 50%)", css(DECIDED_HIT))
                }
                (color, _) => color,
            },
            count: grouped(count as u64),
            percent: format!("{percent:.4}"),
            width: percent,
        }
    };
    Verdict::ALL.iter().map(row).collect()
}

fn enlarged(
    pictures: &Pictures<'_>,
    number: usize,
    violation: &Violation,
    size: [u32; 2],
) -> Result<Enlarged> {
    let (window, spot) = Spot::around(violation.pixel, size);
    Ok(Enlarged {
        number,
        listed: violation.into(),
        color: pictures.color(window)?,
        mask: pictures.mask(window)?,
        spot,
    })
}

fn open_figure<'a>(
    pictures: &Pictures<'_>,
    OpenPixel { pixel, verdict, message }: &'a OpenPixel,
    size: [u32; 2],
) -> Result<OpenFigure<'a>> {
    let (window, spot) = Spot::around(*pixel, size);
    let (color, mask) = (pictures.color(window)?, pictures.mask(window)?);
    Ok(OpenFigure { pixel: *pixel, verdict: verdict.name(), message, color, mask, spot })
}

/// Returns the stops of a CSS gradient, from near to far.
fn scale() -> String {
    let stops = (0..=STOPS).map(|stop| css(depth_color(f64::from(stop) / f64::from(STOPS))));
    stops.collect::<Vec<_>>().join(", ")
}

/// Returns the labels of the scale: five depths, or one if all depths are equal.
fn ticks([least, greatest]: [f32; 2]) -> Vec<String> {
    if least >= greatest {
        return vec![significant(least.into())];
    }
    let (least, greatest) = (f64::from(least), f64::from(greatest));
    (0..5).map(|i| significant(least + (greatest - least) * f64::from(i) / 4.0)).collect()
}

/// Formats a number with five significant digits.
fn significant(value: f64) -> String {
    let exponent = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    if (-4.0..6.0).contains(&exponent) {
        // The result is between 0 and 8.
        let decimals = (4.0 - exponent).max(0.0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.4e}")
    }
}

/// Formats a number with its digits in groups of three.
pub(super) fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            // A narrow no-break space.
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_of_any_shape_fit() {
        let frame = |size| {
            let PictureSize { width, aspect, stretched, sharp, .. } = PictureSize::new(size);
            (width, width / aspect, stretched, sharp)
        };
        assert_eq!(frame([1, 1]), (128.0, 128.0, false, true));
        assert_eq!(frame([800, 600]), (576.0, 432.0, false, false));
        assert_eq!(frame([1, 4096]), (107.5, 860.0, true, false));
        assert_eq!(frame([4096, 1]), (576.0, 72.0, true, false));
    }

    #[test]
    fn numbers_as_people_read_them() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(480_000), "480\u{202f}000");
        assert_eq!(grouped(1_234_567), "1\u{202f}234\u{202f}567");
        for (value, text) in
            [(0.0, "0.0000"), (4.25, "4.2500"), (123_456.0, "123456"), (1e-9, "1.0000e-9")]
        {
            assert_eq!(significant(value), text);
        }
    }
}
