//! The bytes of a file, whether it is compressed with gzip or not.

use std::ffi::OsStr;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::error::LoadError;
use super::gzip::{self, Gunzip};

/// How much of a file is read at a time.
const PIECE: usize = 1 << 18;

/// The same, where a reader looks at places that are far from each other. What is longer is read without a copy.
const SMALL_PIECE: usize = 1 << 12;

/// Bytes that can be read from any place.
pub(super) trait Bytes: BufRead + Seek {}

impl<T: BufRead + Seek> Bytes for T {}

/// The bytes of a file. Those of a compressed file are decompressed as they are read: going back starts again from the
/// beginning.
#[derive(Debug)]
pub(super) enum Source {
    Plain(BufReader<File>),
    Gzip(BufReader<Gunzip<File>>),
}

impl Source {
    /// Opens a file. It is taken as compressed if its first bytes say so.
    pub(super) fn open(path: &Path) -> io::Result<Self> {
        let mut plain = BufReader::with_capacity(PIECE, File::open(path)?);
        if gzip::starts(plain.fill_buf()?) {
            plain.rewind()?;
            let gunzip = Gunzip::new(plain.into_inner());
            return Ok(Self::Gzip(BufReader::with_capacity(PIECE, gunzip)));
        }
        Ok(Self::Plain(plain))
    }

    /// Returns this source for a reader that goes from place to place, at the start of the file.
    pub(super) fn in_small_pieces(self) -> io::Result<Self> {
        let mut source = match self {
            Self::Plain(plain) => {
                Self::Plain(BufReader::with_capacity(SMALL_PIECE, plain.into_inner()))
            }
            gzip => gzip,
        };
        source.rewind()?;
        Ok(source)
    }

    fn inner(&mut self) -> &mut dyn Bytes {
        match self {
            Self::Plain(plain) => plain,
            Self::Gzip(gzip) => gzip,
        }
    }
}

impl Read for Source {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.inner().read(buffer)
    }
}

impl BufRead for Source {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        self.inner().fill_buf()
    }

    fn consume(&mut self, count: usize) {
        self.inner().consume(count);
    }
}

impl Seek for Source {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.inner().seek(to)
    }
}

/// Reads a range of the bytes of a file.
pub(super) fn bytes(source: &mut dyn Bytes, range: &Range<u64>) -> Result<Vec<u8>, LoadError> {
    /// More is allocated as it arrives, because a file may lie about its frames.
    const AT_ONCE: u64 = 1 << 26;
    let length = range.end - range.start;
    let mut bytes = Vec::with_capacity(length.min(AT_ONCE) as usize);
    source.seek(SeekFrom::Start(range.start))?;
    if source.take(length).read_to_end(&mut bytes)? as u64 != length {
        return Err(io::Error::from(io::ErrorKind::UnexpectedEof).into());
    }
    Ok(bytes)
}

/// The path without the ending `.gz`, which says nothing about what is compressed.
pub(super) fn without_gz(path: &Path) -> PathBuf {
    let is_gz =
        path.extension().and_then(OsStr::to_str).is_some_and(|e| e.eq_ignore_ascii_case("gz"));
    if is_gz { path.with_extension("") } else { path.to_path_buf() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_compressed_files() {
        for (name, inner) in
            [("a.xyz.gz", "a.xyz"), ("a.xyz", "a.xyz"), ("b/a.GZ", "b/a"), ("gz", "gz")]
        {
            assert_eq!(without_gz(Path::new(name)), Path::new(inner), "{name}");
        }
    }
}
