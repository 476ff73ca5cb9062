//! The report of `pinhole info FILE`.

use serde::Serialize;

use pinhole::load::{Column, ColumnValues};

/// The report on a file.
#[derive(Serialize)]
pub(super) struct Report {
    pub(super) version: &'static str,
    pub(super) file: String,
    /// Size of the file; `None` on standard input.
    pub(super) bytes: Option<u64>,
    #[serde(flatten)]
    pub(super) kind: Kind,
    pub(super) spheres: usize,
    /// The corners of the box of all spheres.
    pub(super) min: Option<[f64; 3]>,
    pub(super) max: Option<[f64; 3]>,
    pub(super) radius_min: Option<f64>,
    pub(super) radius_max: Option<f64>,
    pub(super) notes: Vec<String>,
}

/// What only one of the two kinds of file has.
#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub(super) enum Kind {
    Data(DataReport),
    Scene(SceneReport),
}

#[derive(Serialize)]
pub(super) struct DataReport {
    pub(super) format: &'static str,
    #[serde(skip)]
    pub(super) about: &'static str,
    /// Whether the file is compressed with gzip; `None` on standard input.
    pub(super) compressed: Option<bool>,
    /// Number of frames; `None` if files of this format have none, or it is not known.
    pub(super) frames: Option<usize>,
    /// The frame that the rest describes.
    pub(super) frame: Option<usize>,
    /// What is wrong after the last complete frame.
    pub(super) problem: Option<String>,
    pub(super) colors: bool,
    pub(super) opacities: bool,
    pub(super) cell: Option<[[f64; 3]; 3]>,
    /// The corner from which the edges of the cell start.
    pub(super) cell_origin: Option<[f64; 3]>,
    pub(super) columns: Vec<ColumnReport>,
}

#[derive(Serialize)]
pub(super) struct ColumnReport {
    pub(super) name: String,
    #[serde(flatten)]
    pub(super) values: ValuesReport,
}

#[derive(Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub(super) enum ValuesReport {
    Numbers { min: Option<f64>, max: Option<f64>, nan: usize },
    Text { different: usize, first: Vec<String> },
}

#[derive(Serialize)]
pub(super) struct SceneReport {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) camera: &'static str,
    pub(super) stereo: bool,
    pub(super) integrator: &'static str,
    pub(super) samples: u32,
    pub(super) lights: usize,
    /// Other files that the scene names.
    pub(super) files: Vec<String>,
}

impl ColumnReport {
    pub(super) fn new(Column { name, values }: &Column) -> Self {
        /// How many texts are shown.
        const SHOWN: usize = 6;
        let values = match values {
            ColumnValues::Numbers(numbers) => {
                let known = || numbers.iter().copied().filter(|number| !number.is_nan());
                ValuesReport::Numbers {
                    min: known().reduce(f64::min),
                    max: known().reduce(f64::max),
                    nan: numbers.len() - known().count(),
                }
            }
            ColumnValues::Labels(labels) => ValuesReport::Text {
                different: labels.names.len(),
                first: labels.names.iter().take(SHOWN).cloned().collect(),
            },
            _ => ValuesReport::Text { different: 0, first: Vec::new() },
        };
        Self { name: name.clone(), values }
    }
}
