//! The outputs of `render` and `demo`: a picture, and data layers in addition.

use std::path::{Path, PathBuf};

use anyhow::Result;
use tempfile::NamedTempFile;

use crate::input::extension;
use crate::output::files::{check_distinct, check_not_inputs, check_writable, name_all, unnamed, unnamed_with};
use crate::terminal::failure::Failure;
use crate::terminal::progress::{self, answer};
use crate::terminal::{interrupt, profile};
use pinhole::image::encoding::Encoding;
use pinhole::image::{Image, Layer, LayerSet};
use pinhole_figure::annotate::Annotations;
use pinhole_figure::write::{exr, npy, png};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PictureFormat {
    Png,
    Exr,
}

/// The outputs of a render, checked before any work is done.
#[derive(Clone, Debug)]
pub(crate) struct Outputs {
    pub(crate) format: PictureFormat,
    /// Path of the picture; `None` is standard output.
    pub(crate) picture: Option<PathBuf>,
    /// The layers in the file of the picture.
    pub(crate) inside: LayerSet,
    pub(crate) layers: Vec<(Layer, PathBuf)>,
    /// Annotations to draw over a PNG.
    pub(crate) annotations: Annotations,
    /// The certificate of the picture.
    pub(crate) certificate: Option<String>,
}

impl Outputs {
    /// Checks the outputs that the user named: extensions, folders, layers, and that no file is named twice.
    pub(crate) fn new(picture: &Path, layers: &[String]) -> Result<Self, Failure> {
        let is_file = picture != Path::new("-");
        let format = if is_file { format_of(picture)? } else { PictureFormat::Png };
        let mut outputs = Self::unwritten(format);
        outputs.picture = is_file.then(|| picture.to_path_buf());
        for text in layers {
            match parse_layer(text)? {
                (layer, Some(path)) => outputs.layers.push((layer, path)),
                (layer, None) if format == PictureFormat::Exr => {
                    outputs.inside = outputs.inside.with(layer);
                }
                (layer, None) => {
                    return Err(Failure::usage(format!(
                        "--layer {text}: a PNG cannot hold layers; write LAYER=FILE.npy, such as \
                         {layer}={layer}.npy, or give -o a name that ends with .exr"
                    )));
                }
            }
        }
        check_distinct(outputs.paths())?;
        Ok(outputs)
    }

    /// Outputs of a picture in this format that is not written.
    pub(crate) fn unwritten(format: PictureFormat) -> Self {
        Self {
            format,
            picture: None,
            inside: LayerSet::COLOR,
            layers: Vec::new(),
            annotations: Annotations::default(),
            certificate: None,
        }
    }

    /// Encodes the picture as PNG, with its annotations and its certificate.
    fn png(&self, image: &Image, encoding: &Encoding) -> Result<Vec<u8>, png::PngError> {
        let _phase = profile::phase("encode");
        if let Some(certificate) = &self.certificate {
            let size = [image.width(), image.height()];
            let samples = png::samples_annotated(image, encoding, &self.annotations)?;
            return png::encode_certified(size, encoding, &samples, certificate);
        }
        png::encode_annotated(image, encoding, &self.annotations)
    }

    pub(crate) fn renamed(&self, name: impl Fn(&Path) -> PathBuf) -> Self {
        Self {
            picture: self.picture.as_deref().map(&name),
            layers: self.layers.iter().map(|(layer, path)| (*layer, name(path))).collect(),
            ..self.clone()
        }
    }

    pub(crate) fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.picture.iter().chain(self.layers.iter().map(|(_, path)| path))
    }

    /// Refuses to overwrite an input.
    pub(crate) fn check_not_inputs(&self, inputs: &[PathBuf]) -> Result<(), Failure> {
        check_not_inputs(self.paths(), inputs)
    }

    pub(crate) fn layers(&self, encoding: &Encoding) -> LayerSet {
        // The exposure and the tone curve of a PNG need the layers that separate the background from the rest.
        let encoded =
            if self.format == PictureFormat::Png || encoding.transparent { encoding.layers() } else { LayerSet::COLOR };
        let asked = self.layers.iter().map(|(layer, _)| *layer);
        asked.chain(self.inside.iter()).chain(encoded.iter()).collect()
    }

    /// Encodes and writes all outputs, and `text` to a file if it is given. The files get their names after all of
    /// them are complete. `adapter` is the name of the adapter that rendered.
    pub(crate) fn write(
        &self,
        image: &Image,
        encoding: &Encoding,
        adapter: Option<&str>,
        text: Option<&(PathBuf, String)>,
    ) -> Result<()> {
        progress::stage("writing");
        let mut files = Vec::new();
        if let Some((path, text)) = text {
            files.push((path, unnamed(path, text.as_bytes())?));
        }
        files.extend(self.files(image, encoding, adapter)?);
        let for_standard_output = match &self.picture {
            None => Some(self.png(image, encoding)?),
            Some(_) => None,
        };
        name_all(files)?;
        if let Some(picture) = for_standard_output {
            interrupt::set_message("stopped; the picture on standard output is not complete");
            answer(&picture)?;
        }
        Ok(())
    }

    /// Writes the files under temporary names.
    fn files(
        &self,
        image: &Image,
        encoding: &Encoding,
        adapter: Option<&str>,
    ) -> Result<Vec<(&PathBuf, NamedTempFile)>> {
        let mut files = Vec::new();
        match (&self.picture, self.format) {
            (None, _) => {}
            (Some(path), PictureFormat::Png) => {
                files.push((path, unnamed(path, &self.png(image, encoding)?)?));
            }
            (Some(path), PictureFormat::Exr) => {
                let file = unnamed_with(path, |file| {
                    let sink = std::io::BufWriter::new(file);
                    let certificate = self.certificate.as_deref();
                    let remarks = exr::Remarks { adapter, certificate };
                    match exr::write(image, self.inside, encoding, remarks, sink) {
                        Err(exr::ExrError::Sink(error)) => Err(error),
                        written => written.map_err(std::io::Error::other),
                    }
                })?;
                files.push((path, file));
            }
        }
        for (layer, path) in &self.layers {
            let phase = profile::phase("encode");
            let array = npy::encode(image, *layer)?;
            drop(phase);
            files.push((path, unnamed(path, &array)?));
        }
        Ok(files)
    }

    /// Returns the outputs for the left and the right eye. Their names are made from the user's names.
    pub(crate) fn of_eyes(&self) -> Result<[Self; 2], Failure> {
        if self.picture.is_none() {
            return Err(Failure::usage("--stereo two-files: standard output can take only one picture; name a file"));
        }
        let outputs = ["left", "right"].map(|eye| self.renamed(|path| with_eye(path, eye)));
        let paths = || outputs.iter().flat_map(Self::paths);
        paths().try_for_each(|path| check_writable(path))?;
        check_distinct(paths())?;
        Ok(outputs)
    }

    /// Writes all outputs of both eyes, as [`Outputs::write`] does for one picture.
    pub(crate) fn write_both(
        outputs: &[Self; 2],
        images: &[Image],
        encoding: &Encoding,
        adapter: Option<&str>,
        text: Option<&(PathBuf, String)>,
    ) -> Result<()> {
        progress::stage("writing");
        let mut files = Vec::new();
        if let Some((path, text)) = text {
            files.push((path, unnamed(path, text.as_bytes())?));
        }
        for (outputs, image) in outputs.iter().zip(images) {
            files.extend(outputs.files(image, encoding, adapter)?);
        }
        name_all(files)
    }
}

/// Adds the eye to a file name: NAME.png becomes NAME-left.png.
fn with_eye(path: &Path, eye: &str) -> PathBuf {
    let [stem, extension] = [path.file_stem(), path.extension()].map(Option::unwrap_or_default);
    let mut name = stem.to_os_string();
    name.push(format!("-{eye}."));
    name.push(extension);
    path.with_file_name(name)
}

/// Returns the format for the extension of a picture, and checks that the file can be written.
fn format_of(path: &Path) -> Result<PictureFormat, Failure> {
    let format = match extension(path).as_deref() {
        Some("png") => PictureFormat::Png,
        Some("exr") => PictureFormat::Exr,
        other => {
            let png = path.with_extension("png");
            let (name, png) = (path.display(), png.display());
            let remedy = match other {
                Some("jpg" | "jpeg" | "tif" | "tiff" | "bmp" | "webp") => {
                    format!("write {png}, and then: magick {png} {name}")
                }
                Some("pdf" | "svg" | "eps") => format!("write {png} with --dpi 300"),
                Some("avi" | "mpg" | "mpeg" | "wmv") => "for a movie, take .mp4, .webm, .apng or .gif".to_owned(),
                _ => "change the extension".to_owned(),
            };
            return Err(Failure::usage(format!("{name}: a picture is written as .png or .exr; {remedy}")));
        }
    };
    check_writable(path)?;
    Ok(format)
}

/// Parses `LAYER` or `LAYER=FILE.npy`.
fn parse_layer(text: &str) -> Result<(Layer, Option<PathBuf>), Failure> {
    let (name, path) = match text.split_once('=') {
        Some((name, path)) => (name, Some(Path::new(path))),
        None => (text, None),
    };
    if path == Some(Path::new("")) {
        return Err(Failure::usage(format!("--layer {text}: name a file after the =")));
    }
    let layer = name.parse().map_err(|error| Failure::usage(format!("--layer {text}: {error}")))?;
    if let Some(path) = path {
        if extension(path).as_deref() != Some("npy") {
            return Err(Failure::usage(format!(
                "{}: a layer is written as .npy; change the extension",
                path.display()
            )));
        }
        check_writable(path)?;
    }
    Ok((layer, path.map(Path::to_path_buf)))
}
