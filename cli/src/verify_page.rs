//! Makes the page of `pinhole verify --report`: one file that needs no other files. Its script shows the JSON document and
//! the pictures, which are in it.

use std::collections::BTreeMap;
use std::fmt::Display;

use anyhow::{Context, Result};
use serde::Serialize;

use super::verify_lit::drawn;
use super::verify_pictures::{Pictures, Window, css, verdict_color};
use super::verify_report::Report;
use pinhole::verify::run_file::{Run, ShownPicture};
use pinhole::verify::{Certificate, Verdict};

const TEMPLATE: &str = include_str!("verify_page.html");

/// What the script of the page reads.
#[derive(Serialize)]
struct Page<'a> {
    report: &'a Report,
    verdict: String,
    /// Version of the program that checks.
    checked_by: &'static str,
    /// The run file that holds the checked recording, if there is one.
    run_file: Option<String>,
    pictures: Drawn,
    /// The colours of the verdicts in their picture.
    colors: BTreeMap<&'static str, String>,
    /// The nearest and the farthest depth, if a sphere is hit.
    depths: Option<[f32; 2]>,
    /// The number of samples of the lit picture.
    shown_samples: Option<u32>,
    /// One pixel of the pictures stands for `step` × `step` pixels.
    step: u32,
}

/// The pictures as data URIs.
#[derive(Serialize)]
struct Drawn {
    color: String,
    depth: String,
    /// `None` if no pixel was judged.
    verdicts: Option<String>,
    light: Option<String>,
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
    let whole = Window::whole(certificate.size);
    let is_judged = !certificate.verdicts.is_empty();
    let color = |verdict: &Verdict| (verdict.name(), css(verdict_color(*verdict)));
    let page = Page {
        report,
        verdict: report.verdict(),
        checked_by: env!("CARGO_PKG_VERSION"),
        run_file: run_file.map(|path| path.to_string()),
        pictures: Drawn {
            color: pictures.color(whole)?,
            depth: pictures.depth_colors(whole)?,
            verdicts: is_judged.then(|| pictures.mask(whole)).transpose()?,
            light: lit.map(|lit| drawn(lit, whole)).transpose()?,
        },
        colors: Verdict::ALL.iter().map(color).collect(),
        depths: pictures.depths,
        shown_samples: lit.map(|lit| lit.samples),
        step: whole.step,
    };
    let json = serde_json::to_string(&page).context("the page of the report cannot be made")?;
    Ok(TEMPLATE.replacen("{{data}}", &in_a_script(&json), 1))
}

/// The same JSON without any `<`, so that no text in it can end the element `script`.
fn in_a_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_leaves_its_script() {
        let text = "</script><!--<script>&\u{2028}{{data}}";
        let found = in_a_script(&serde_json::to_string(text).unwrap());
        assert!(!found.contains('<'), "{found}");
        assert_eq!(serde_json::from_str::<String>(&found).unwrap(), text);
        assert_eq!(TEMPLATE.matches("{{data}}").count(), 1);
    }
}
