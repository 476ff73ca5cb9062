//! What a report does not cover, in words for who runs it in CI.

use super::verify_light::LightReport;
use super::verify_page::grouped;
use super::verify_report::Report;

/// The sentences of the section. `wanted` is the number of samples that the scene asks for, if that is known.
pub(super) fn not_covered(report: &Report, wanted: Option<u32>) -> Vec<String> {
    let mut all = vec![
        "Other scenes, other views, other adapters and other versions of the driver. What is true of this run need not \
         be true of the next driver: run the check again after each update."
            .to_owned(),
    ];
    if let Some(light) = report.light() {
        all.extend(of_light(light, [report.picture.width, report.picture.height], wanted));
    }
    if report.denoiser.is_some() {
        all.push(
            "The denoiser on the whole picture. It was checked on a small noisy picture of the same scene.".to_owned(),
        );
    }
    all.extend([
        "What happens after the device is done: outlines, exposure, tone curve, legends, and the file. pinhole render --certify \
         judges the very samples of the file that it writes."
            .to_owned(),
        "Errors that are smaller than the bounds. A device that conforms to WGSL may make the same, so they cannot be \
         called faults; a mean that lies to one side is noted as biased."
            .to_owned(),
        "How long rendering takes, how much memory it needs, and whether a driver hangs or crashes on another day."
            .to_owned(),
        "Whether the scene is the one that you meant. Compare the SHA-256 below with that of a run that you trust."
            .to_owned(),
    ]);
    all
}

fn of_light(light: &LightReport, [width, height]: [u32; 2], wanted: Option<u32>) -> Vec<String> {
    let mut all = Vec::new();
    let area = |[_, _, width, height]: &[u32; 4]| u64::from(*width) * u64::from(*height);
    let pixels: u64 = light.rectangles.iter().map(area).sum();
    let whole = u64::from(width) * u64::from(height);
    if light.rectangles.iter().all(|of| area(of) < whole) {
        let places: Vec<String> = light
            .rectangles
            .iter()
            .map(|[x, y, width, height]| {
                format!("{width} × {height} pixels from column {x}, row {y} on")
            })
            .collect();
        all.push(format!(
            "Light outside of {}, which are outlined in the lit picture: {} of {} pixels. Each run takes another second \
             part, unless --tile-seed says which.",
            places.join(" and "),
            grouped(covered(&light.rectangles)),
            grouped(whole)
        ));
    }
    let samples = light.paths.or(light.samples).unwrap_or_default() / pixels.max(1);
    match wanted {
        Some(wanted) if u64::from(wanted) > samples => all.push(format!(
            "The other samples of those pixels: {samples} of {wanted} {} checked. More are with --paths {}.",
            if samples == 1 { "was" } else { "were" },
            wanted.min(samples.saturating_mul(4).max(4).min(u64::from(u32::MAX)) as u32)
        )),
        _ => {}
    }
    all.push(
        "The lit picture as a whole. Its samples were checked one by one, each with what it adds to the sums of its \
         pixel; the picture above was rendered for people, and its pixels were not checked."
            .to_owned(),
    );
    all.push(
        "The kernels that take a whole sample at once. pinhole render uses them on software devices and for studios of \
         opaque spheres. They are made of the same parts as those that were checked, but store nothing in between that \
         could be."
            .to_owned(),
    );
    all
}

/// The number of pixels in rectangles that may overlap.
fn covered(rectangles: &[[u32; 4]]) -> u64 {
    let rows = rectangles.iter().flat_map(|[_, y, _, height]| *y..y.saturating_add(*height));
    let rows: std::collections::BTreeSet<u32> = rows.collect();
    let in_row = |row: u32| {
        let here = rectangles.iter().filter(|[_, y, _, height]| row >= *y && row - y < *height);
        let mut spans: Vec<_> =
            here.map(|[x, _, width, _]| (*x, x.saturating_add(*width))).collect();
        spans.sort_unstable();
        let mut end = 0;
        spans.into_iter().fold(0_u64, |sum, (first, last)| {
            let new = last.saturating_sub(first.max(end));
            end = end.max(last);
            sum + u64::from(new)
        })
    };
    rows.into_iter().map(in_row).sum()
}

#[cfg(test)]
mod tests {
    use super::covered;

    #[test]
    fn pixels_in_two_rectangles_count_once() {
        assert_eq!(covered(&[[2, 1, 4, 3]]), 12);
        assert_eq!(covered(&[[2, 1, 4, 3], [4, 2, 4, 3]]), 20);
        assert_eq!(covered(&[[2, 1, 4, 3], [3, 1, 1, 1], [9, 9, 1, 1]]), 13);
    }
}
