//! Compressed files: gzip, xz, bzip2 and Zstandard. The first bytes show which, and a file is decompressed as it is read.

use std::ffi::OsStr;
use std::fmt;
use std::io::{self, BufRead as _, BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use bzip2::read::MultiBzDecoder;
use flate2::read::MultiGzDecoder;
use lzma_rust2::XzReader;
use ruzstd::decoding::errors::{FrameDecoderError, ReadFrameHeaderError};
use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};

/// A compressed file expands to at most this many times its size, or to [`SMALL`] bytes if that is more. What expands
/// further was made to fill the memory.
const EXPANSION: u64 = 100;
const SMALL: u64 = 1 << 28;

/// The most memory for the text that xz refers to, in KiB. Zstandard has the same limit. `xz -9` needs half of it.
const XZ_MEMORY: u32 = 1 << 17;

/// A way to compress files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compression {
    Gzip,
    Xz,
    Bzip2,
    Zstd,
}

impl Compression {
    /// The way in which a file with these first bytes is compressed, if it is.
    pub(super) fn of(bytes: &[u8]) -> Option<Self> {
        match bytes {
            [0x1f, 0x8b, ..] => Some(Self::Gzip),
            [0xfd, b'7', b'z', b'X', b'Z', 0, ..] => Some(Self::Xz),
            [b'B', b'Z', b'h', b'1'..=b'9', b'1', b'A', b'Y', b'&', b'S', b'Y', ..] => Some(Self::Bzip2),
            [0x28, 0xb5, 0x2f, 0xfd, ..] => Some(Self::Zstd),
            _ => None,
        }
    }
}

/// Returns true if the first bytes of a file are those of one that is compressed and can be read: 10 bytes suffice.
#[must_use]
pub fn is_compressed(bytes: &[u8]) -> bool {
    Compression::of(bytes).is_some()
}

/// The path without an ending such as `.gz`, which says nothing about the compressed data.
#[must_use]
pub fn without_ending(path: &Path) -> PathBuf {
    let ending = path.extension().and_then(OsStr::to_str).unwrap_or_default().to_ascii_lowercase();
    match ["gz", "xz", "bz2", "zst"].contains(&ending.as_str()) {
        true => path.with_extension(""),
        false => path.to_path_buf(),
    }
}

/// Decompresses data in memory.
pub(super) fn decompressed(bytes: &[u8], compression: Compression) -> io::Result<Vec<u8>> {
    let mut all = Vec::new();
    Decompressor::new(Cursor::new(bytes), compression)?.read_to_end(&mut all)?;
    Ok(all)
}

/// The decompressed size of a file of gzip, from its last four bytes; 0 for others. It is right for a file of one member
/// and less than 4 GiB. Only the check for enough memory depends on it.
pub(super) fn size_hint(bytes: &[u8], compression: Compression) -> u64 {
    match compression {
        Compression::Gzip => bytes.last_chunk().map_or(0, |last| u32::from_le_bytes(*last).into()),
        _ => 0,
    }
}

/// Decompresses a file as it is read. Seeking forward decompresses the bytes between, and seeking back starts again, with
/// a clone of the compressed file.
pub(super) struct Decompressor<R: Read> {
    compressed: R,
    compression: Compression,
    decoder: Decoder<R>,
    /// Number of decompressed bytes that were read.
    position: u64,
    /// Number of decompressed bytes after which the file is refused.
    most: u64,
}

enum Decoder<R: Read> {
    Gzip(MultiGzDecoder<R>),
    Xz(Box<XzReader<BufReader<R>>>),
    Bzip2(MultiBzDecoder<R>),
    Zstd(Box<Zstd<R>>),
    /// After an error nothing more is read.
    Failed,
}

impl<R: Read + Seek + Clone> Decompressor<R> {
    /// Decompresses `compressed` from its start.
    pub(super) fn new(mut compressed: R, compression: Compression) -> io::Result<Self> {
        let most = compressed.seek(SeekFrom::End(0))?.saturating_mul(EXPANSION).max(SMALL);
        compressed.rewind()?;
        let file = compressed.clone();
        let decoder = match compression {
            Compression::Gzip => Decoder::Gzip(MultiGzDecoder::new(file)),
            Compression::Bzip2 => Decoder::Bzip2(MultiBzDecoder::new(file)),
            Compression::Xz => Decoder::Xz(Box::new(XzReader::new_mem_limit(BufReader::new(file), true, XZ_MEMORY))),
            Compression::Zstd => Decoder::Zstd(Box::new(Zstd::new(file))),
        };
        Ok(Self { compressed, compression, decoder, position: 0, most })
    }

    /// Reads on until `position`, or until the end, whichever comes first.
    fn read_up_to(&mut self, position: u64) -> io::Result<()> {
        let between = position.saturating_sub(self.position);
        io::copy(&mut self.by_ref().take(between), &mut io::sink())?;
        Ok(())
    }
}

impl<R: Read> fmt::Debug for Decompressor<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { compression, position, .. } = self;
        f.debug_struct("Decompressor").field("compression", compression).field("position", position).finish()
    }
}

impl<R: Read> Read for Decompressor<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = match &mut self.decoder {
            Decoder::Gzip(decoder) => decoder.read(buffer),
            Decoder::Xz(decoder) => decoder.read(buffer),
            Decoder::Bzip2(decoder) => decoder.read(buffer),
            Decoder::Zstd(decoder) => decoder.read(buffer),
            Decoder::Failed => Err(invalid("the compressed data is damaged")),
        };
        let read = match read {
            Err(error) if error.kind() != io::ErrorKind::Interrupted => {
                self.decoder = Decoder::Failed;
                return Err(error);
            }
            read => read?,
        };
        self.position += read as u64;
        if self.position > self.most {
            return Err(invalid(format!(
                "it expands to more than {EXPANSION} times its size; decompress it first, if you trust it"
            )));
        }
        Ok(read)
    }
}

fn invalid(problem: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, problem.into())
}

impl<R: Read + Seek + Clone> Seek for Decompressor<R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let outside = || io::Error::new(io::ErrorKind::InvalidInput, "a place before the start");
        let wanted = match to {
            SeekFrom::Start(position) => position,
            SeekFrom::Current(by) => self.position.checked_add_signed(by).ok_or_else(outside)?,
            SeekFrom::End(by) => {
                self.read_up_to(u64::MAX)?;
                self.position.checked_add_signed(by).ok_or_else(outside)?
            }
        };
        if wanted < self.position {
            let most = self.most;
            *self = Self { most, ..Self::new(self.compressed.clone(), self.compression)? };
        }
        self.read_up_to(wanted)?;
        // Nothing can be read at a place after the end, as in a plain file.
        Ok(wanted)
    }
}

/// Decompresses all frames of Zstandard.
struct Zstd<R> {
    source: BufReader<R>,
    decoder: FrameDecoder,
    is_in_frame: bool,
}

impl<R: Read> Zstd<R> {
    fn new(source: R) -> Self {
        Self { source: BufReader::new(source), decoder: FrameDecoder::new(), is_in_frame: false }
    }

    /// Starts the next frame that has data, if there is one.
    fn next_frame(&mut self) -> io::Result<()> {
        while !self.is_in_frame && !self.source.fill_buf()?.is_empty() {
            match self.decoder.reset(&mut self.source) {
                Err(FrameDecoderError::ReadFrameHeaderError(ReadFrameHeaderError::SkipFrame { length, .. })) => {
                    io::copy(&mut self.source.by_ref().take(length.into()), &mut io::sink())?;
                }
                Err(error) => return Err(invalid(error.to_string())),
                Ok(()) => self.is_in_frame = true,
            }
        }
        Ok(())
    }
}

impl<R: Read> Read for Zstd<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            self.next_frame()?;
            if !self.is_in_frame || buffer.is_empty() {
                return Ok(0);
            }
            if self.decoder.can_collect() > 0 {
                return self.decoder.read(buffer);
            }
            if !self.decoder.is_finished() {
                let most = BlockDecodingStrategy::UptoBytes(buffer.len());
                self.decoder.decode_blocks(&mut self.source, most).map_err(|error| invalid(error.to_string()))?;
                continue;
            }
            let sum = self.decoder.get_checksum_from_data();
            if sum.is_some() && sum != self.decoder.get_calculated_checksum() {
                return Err(invalid("the checksum of the compressed data is wrong"));
            }
            self.is_in_frame = false;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write as _;

    use lzma_rust2::{XzOptions, XzWriter};

    const ALL: [Compression; 4] = [Compression::Gzip, Compression::Xz, Compression::Bzip2, Compression::Zstd];

    #[test]
    fn names_of_compressed_files() {
        for (name, inner) in [
            ("a.xyz.gz", "a.xyz"),
            ("a.xyz", "a.xyz"),
            ("b/a.GZ", "b/a"),
            ("gz", "gz"),
            ("a.b.zst", "a.b"),
            ("a.xz.bz2", "a.xz"),
        ] {
            assert_eq!(without_ending(Path::new(name)), Path::new(inner), "{name}");
        }
    }

    fn compressed(bytes: &[u8], compression: Compression) -> Vec<u8> {
        match compression {
            Compression::Gzip => {
                let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
                encoder.write_all(bytes).unwrap();
                encoder.finish().unwrap()
            }
            Compression::Bzip2 => {
                let mut encoder = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::fast());
                encoder.write_all(bytes).unwrap();
                encoder.finish().unwrap()
            }
            Compression::Xz => {
                let mut encoder = XzWriter::new(Vec::new(), XzOptions::with_preset(1)).unwrap();
                encoder.write_all(bytes).unwrap();
                encoder.finish().unwrap()
            }
            Compression::Zstd => {
                let skipped = [0x50, 0x2a, 0x4d, 0x18, 3, 0, 0, 0, 1, 2, 3];
                let frame = ruzstd::encoding::compress_to_vec(bytes, ruzstd::encoding::CompressionLevel::Fastest);
                [&frame[..], &skipped].concat()
            }
        }
    }

    #[test]
    fn seeks_forward_and_back() {
        let bytes: Vec<u8> = (0..100_000_u32).flat_map(u32::to_le_bytes).collect();
        for compression in ALL {
            // Two members, as `cat a.gz b.gz` makes them.
            let (first, second) = bytes.split_at(123_456);
            let file = [compressed(first, compression), compressed(second, compression)].concat();
            assert_eq!(Compression::of(&file), Some(compression));
            assert_eq!(decompressed(&file, compression).unwrap(), bytes);
            let mut plain = BufReader::new(Decompressor::new(Cursor::new(&*file), compression).unwrap());
            for at in [300_000_u64, 17, 399_996, 0, 123_456] {
                plain.seek(SeekFrom::Start(at)).unwrap();
                assert_eq!(plain.stream_position().unwrap(), at);
                let mut four = [0; 4];
                plain.read_exact(&mut four).unwrap();
                assert_eq!(four, bytes[at as usize..][..4]);
            }
            assert_eq!(plain.seek(SeekFrom::End(-4)).unwrap(), 399_996);
            assert_eq!(plain.fill_buf().unwrap(), &bytes[399_996..]);
        }
        assert_eq!(size_hint(&compressed(&bytes, Compression::Gzip), Compression::Gzip), 400_000);
    }

    #[test]
    fn what_expands_too_far_is_refused() {
        for compression in ALL {
            let file = compressed(&[b'\n'; 100_000], compression);
            let mut plain = Decompressor::new(Cursor::new(&*file), compression).unwrap();
            assert_eq!(plain.most, SMALL);
            plain.most = 10_000;
            let error = plain.read_to_end(&mut Vec::new()).unwrap_err().to_string();
            assert!(error.starts_with("it expands to more than 100 times its size; "), "{error}");
        }
    }

    #[test]
    fn a_damaged_file_is_an_error() {
        let text: Vec<u8> = (0..2000_u32).flat_map(|number| (number * number).to_le_bytes()).collect();
        let mut random = fastrand::Rng::with_seed(5);
        for compression in ALL {
            let file = compressed(&text, compression);
            for length in (6..file.len() - 11).step_by(97) {
                assert!(decompressed(&file[..length], compression).is_err(), "{compression:?} {length}");
            }
            for _ in 0..300 {
                let mut damaged = file.clone();
                for _ in 0..random.usize(1..4) {
                    damaged[random.usize(..file.len())] = random.u8(..);
                }
                let mut plain = Decompressor::new(Cursor::new(&*damaged), compression).unwrap();
                let mut all = Vec::new();
                if plain.read_to_end(&mut all).is_err() {
                    assert!(plain.read_to_end(&mut all).is_err());
                    assert!(plain.rewind().is_ok());
                }
            }
        }
    }

    /// The window of these files is larger than all memory.
    #[test]
    fn large_windows_are_refused() {
        let zstd = [0x28, 0xb5, 0x2f, 0xfd, 0, 0xff, 1, 0, 0];
        let error = decompressed(&zstd, Compression::Zstd).unwrap_err().to_string();
        assert!(error.to_lowercase().contains("window"), "{error}");
        let xz = "fd377a585a000000ff12d9410200210128000000e6a011b3";
        let bytes: Vec<u8> = (0..xz.len() / 2).map(|at| u8::from_str_radix(&xz[2 * at..][..2], 16).unwrap()).collect();
        let error = decompressed(&bytes, Compression::Xz).unwrap_err().to_string();
        assert!(error.contains("memory"), "{error}");
    }
}
