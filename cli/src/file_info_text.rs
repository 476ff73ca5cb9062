//! The report of `pinhole info FILE` as text.

use super::file_report::{ColumnReport, DataReport, Kind, Report, SceneReport, ValuesReport};
use pinhole::internals::text::one_line;

/// Formats the report. Text from the file has its control characters escaped.
pub(super) fn readable(report: &Report) -> String {
    let mut text = format!("{}\n", one_line(&report.file));
    let mut line = |name: &str, value: String| text += &format!("  {name:<11}{value}\n");
    match &report.kind {
        Kind::Data(data) => {
            let compressed =
                if data.compressed == Some(true) { ", compressed with gzip" } else { "" };
            line("format", format!("{} ({}){compressed}", data.format, data.about));
        }
        Kind::Scene(_) => line("format", "scene file".to_owned()),
    }
    if let Some(bytes) = report.bytes {
        line("size", format!("{bytes} bytes"));
    }
    match &report.kind {
        Kind::Data(DataReport { frames, frame, .. }) => {
            if let Some(frames) = frames {
                line("frames", frames.to_string());
            }
            if let Some(frame) = frame {
                line("frame", format!("{frame}, which the following describes"));
            }
        }
        Kind::Scene(scene) => {
            let SceneReport { width, height, camera, stereo, integrator, samples, lights, files } =
                scene;
            line("picture", format!("{width}x{height}"));
            line("camera", format!("{camera}{}", if *stereo { ", stereo" } else { "" }));
            line("integrator", (*integrator).to_owned());
            line("samples", samples.to_string());
            line("lights", lights.to_string());
            for file in files {
                line("file", one_line(file));
            }
        }
    }
    line("spheres", report.spheres.to_string());
    if let (Some(min), Some(max)) = (report.min, report.max) {
        let corner = |corner: [f64; 3]| corner.map(short).join(" ");
        line("box", format!("{} to {}", corner(min), corner(max)));
    }
    if let (Some(min), Some(max)) = (report.radius_min, report.radius_max) {
        let radii =
            if min < max { format!("{} to {}", short(min), short(max)) } else { short(min) };
        line("radii", radii);
    }
    if let Kind::Data(data) = &report.kind {
        let yes_or_no = |is: bool| if is { "yes" } else { "no" }.to_owned();
        line("colors", yes_or_no(data.colors));
        line("opacities", yes_or_no(data.opacities));
        if let Some(cell) = data.cell {
            let edges = cell.map(|edge| format!("({})", edge.map(short).join(" ")));
            let origin = data.cell_origin.filter(|origin| origin.iter().any(|x| *x != 0.0));
            let origin = origin.map(|origin| format!(" from ({})", origin.map(short).join(" ")));
            line("cell", edges.join(" ") + &origin.unwrap_or_default());
        }
        if !data.columns.is_empty() {
            let rows: Vec<_> = data.columns.iter().map(row).collect();
            let width = rows.iter().map(|[name, ..]| name.chars().count()).max().unwrap_or(0);
            text += "columns\n";
            for [name, kind, values] in rows {
                text += &format!("  {name:<width$}  {kind:<7}  {values}\n");
            }
        }
        if let Some(problem) = &data.problem {
            text += &format!("problem: {}\n", one_line(problem));
        }
    }
    for note in &report.notes {
        text += &format!("note: {}\n", one_line(note));
    }
    text
}

fn row(ColumnReport { name, values }: &ColumnReport) -> [String; 3] {
    let name = one_line(name);
    match values {
        ValuesReport::Numbers { min, max, nan } => {
            let range = min.zip(*max).map_or_else(
                || "none".to_owned(),
                |(min, max)| format!("{} to {}", short(min), short(max)),
            );
            let nan = if *nan > 0 { format!(", {nan} NaN") } else { String::new() };
            [name, "numbers".to_owned(), range + &nan]
        }
        ValuesReport::Text { different, first } => {
            let shown = first.iter().map(|name| one_line(name)).collect::<Vec<_>>().join(", ");
            let more = if first.len() < *different { ", …" } else { "" };
            [name, "text".to_owned(), format!("{different} different: {shown}{more}")]
        }
    }
}

/// A number with six digits, which are as many as anyone reads.
fn short(number: f64) -> String {
    let rounded: f64 = format!("{number:.5e}").parse().unwrap_or(number);
    let size = rounded.abs();
    if rounded == 0.0 || !size.is_finite() || (1e-4..1e9).contains(&size) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_six_digits() {
        for (number, expected) in [
            (0.1 + 0.2, "0.3"),
            (123_456_789.0, "123457000"),
            (1e300, "1e300"),
            (-2.5e-7, "-2.5e-7"),
            (0.0, "0"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(short(number), expected);
        }
    }
}
