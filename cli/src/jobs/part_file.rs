//! The file of a part: a line that names the format, the length of a header in eight bytes, the header as JSON, the layers
//! of the pictures of all eyes, and the digest of all bytes before it.

use std::io::{self, BufReader, Read, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::files;
use crate::jobs::manifest::{Manifest, VERSION};
use pinhole::image::Image;
use pinhole::render::NearestPicture;

const START: &[u8] = b"pinhole part 1\n";

const DIGEST: usize = 32;

/// Maximum header length in bytes.
const LONGEST_HEADER: u64 = 1 << 16;

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Header {
    pub(super) version: String,
    pub(super) job: String,
    pub(super) unit: usize,
    /// The renderer: an adapter with its driver, or the CPU.
    pub(super) device: String,
    /// The name of the adapter for files of pictures.
    pub(super) adapter: Option<String>,
    pub(super) milliseconds: u64,
    /// Number of bytes of the layers after the header.
    pub(super) bytes: u64,
}

/// The reason why a file is not the wanted part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Problem {
    Missing,
    /// The file is not a part, or it was changed or cut off.
    Damaged,
    /// The part belongs to another job, another unit or another version.
    Foreign,
    /// The part cannot be read, but may be whole.
    Unreadable(io::ErrorKind),
}

impl Problem {
    /// Completes the sentence "a part is …".
    pub(super) fn words(self) -> String {
        match self {
            Self::Missing => "missing".to_owned(),
            Self::Damaged => "damaged".to_owned(),
            Self::Foreign => "of another job".to_owned(),
            Self::Unreadable(kind) => format!("not readable ({kind}), but may be whole"),
        }
    }

    /// The reason why reading failed. A file that ends too early is damaged.
    fn of(error: &io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound => Self::Missing,
            io::ErrorKind::UnexpectedEof => Self::Damaged,
            kind => Self::Unreadable(kind),
        }
    }
}

/// Number of bytes of the layers of a unit.
pub(super) fn payload(manifest: &Manifest, unit: usize) -> u64 {
    let (_, (_, [width, height])) = manifest.unit(unit);
    let pixels = u64::from(width) * u64::from(height) * u64::from(manifest.eyes);
    let more = if manifest.is_by_depth() { NearestPicture::BYTES_PER_PIXEL } else { 0 };
    pixels * (manifest.layer_set().bytes_per_pixel() + more)
}

/// The pictures of a part, one for each eye.
pub(super) enum Pictures {
    Tile(Vec<Image>),
    /// The whole film, with the nearest hits in some bricks.
    Depth(Vec<NearestPicture>),
}

pub(super) fn write(header: &Header, pictures: &Pictures, out: &mut impl Write) -> io::Result<()> {
    let mut digest = Sha256::new();
    let text = serde_json::to_vec(header)?;
    let length = (text.len() as u64).to_le_bytes();
    let mut put = |bytes: &[u8]| {
        digest.update(bytes);
        out.write_all(bytes)
    };
    put(START)?;
    put(&length)?;
    put(&text)?;
    match pictures {
        Pictures::Tile(images) => images.iter().try_for_each(|i| put(&i.to_le_bytes()))?,
        Pictures::Depth(images) => images.iter().try_for_each(|i| put(&i.to_le_bytes()))?,
    }
    out.write_all(&digest.finalize())
}

/// Reads the header of a part, and checks unit, job and length of the file, but not its bytes.
pub(super) fn glance(path: &Path, manifest: &Manifest, unit: usize) -> Result<Header, Problem> {
    let mut file = open(path)?;
    let (header, before) = read_header(&mut file)?;
    check_header(&header, manifest, unit)?;
    let expected = before + header.bytes + DIGEST as u64;
    let length = file.metadata().map_err(|error| Problem::of(&error))?.len();
    if length == expected { Ok(header) } else { Err(Problem::Damaged) }
}

/// A reader of a file that computes the digest of the bytes read.
struct DigestReader {
    file: files::File,
    digest: Sha256,
}

impl Read for DigestReader {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.file.read(buffer)?;
        self.digest.update(&buffer[..count]);
        Ok(count)
    }
}

/// Reads a part, and checks every byte. `contents` reads the data after the header, and gets their number of bytes.
fn checked(
    path: &Path,
    manifest: &Manifest,
    unit: usize,
    contents: impl FnOnce(&mut dyn Read) -> io::Result<()>,
) -> Result<Header, Problem> {
    let problem = |error| Problem::of(&error);
    let mut part = DigestReader { file: open(path)?, digest: Sha256::new() };
    let (header, _) = read_header(&mut part)?;
    contents(&mut Read::by_ref(&mut part).take(header.bytes)).map_err(problem)?;
    let DigestReader { file, digest } = part;
    let mut end = Vec::new();
    // One more byte than allowed is read, to notice a longer file.
    file.take(DIGEST as u64 + 1).read_to_end(&mut end).map_err(problem)?;
    if end != digest.finalize().as_slice() {
        return Err(Problem::Damaged);
    }
    check_header(&header, manifest, unit)?;
    Ok(header)
}

/// Checks every byte of a part. The memory for this does not depend on the size of the part.
pub(super) fn check(path: &Path, manifest: &Manifest, unit: usize) -> Result<Header, Problem> {
    let skip = |contents: &mut dyn Read| {
        let mut contents = BufReader::with_capacity(1 << 18, contents);
        io::copy(&mut contents, &mut io::sink()).map(drop)
    };
    checked(path, manifest, unit, skip)
}

pub(super) fn read(path: &Path, manifest: &Manifest, unit: usize) -> Result<(Header, Pictures), Problem> {
    let (mut rest, payload) = (Vec::new(), payload(manifest, unit));
    // A file that is too long is not read to its end.
    let keep = |contents: &mut dyn Read| contents.take(payload).read_to_end(&mut rest).map(drop);
    let header = checked(path, manifest, unit, keep)?;
    let (_, (_, size)) = manifest.unit(unit);
    let layers = manifest.layer_set();
    let of_eye = rest.len() / manifest.eyes.max(1) as usize;
    let eyes = rest.chunks_exact(of_eye.max(1));
    // A file with the right length and digest was written in this way, so only memory can be missing.
    let no_memory = Problem::Unreadable(io::ErrorKind::OutOfMemory);
    let pictures = if manifest.is_by_depth() {
        let nearest = |bytes: &[u8]| NearestPicture::from_le_bytes(size, layers, bytes).ok_or(no_memory);
        Pictures::Depth(eyes.map(nearest).collect::<Result<_, _>>()?)
    } else {
        let image = |bytes: &[u8]| Image::from_le_bytes(size, layers, bytes).ok_or(no_memory);
        Pictures::Tile(eyes.map(image).collect::<Result<_, _>>()?)
    };
    Ok((header, pictures))
}

fn open(path: &Path) -> Result<files::File, Problem> {
    files::open(path).map_err(|error| Problem::of(&error))
}

/// Reads the header, and returns the number of bytes up to its end.
fn read_header(file: &mut impl Read) -> Result<(Header, u64), Problem> {
    let mut start = [0; START.len()];
    let mut length = [0; 8];
    let problem = |error| Problem::of(&error);
    file.read_exact(&mut start).map_err(problem)?;
    file.read_exact(&mut length).map_err(problem)?;
    let length = u64::from_le_bytes(length);
    if start != START || length > LONGEST_HEADER {
        return Err(Problem::Damaged);
    }
    let mut text = vec![0; length as usize];
    file.read_exact(&mut text).map_err(problem)?;
    let header = serde_json::from_slice(&text).map_err(|_| Problem::Damaged)?;
    Ok((header, (START.len() + size_of::<u64>()) as u64 + length))
}

fn check_header(header: &Header, manifest: &Manifest, unit: usize) -> Result<(), Problem> {
    if header.job != manifest.sha256 || header.unit != unit || header.version != VERSION {
        return Err(Problem::Foreign);
    }
    if header.bytes == payload(manifest, unit) { Ok(()) } else { Err(Problem::Damaged) }
}
