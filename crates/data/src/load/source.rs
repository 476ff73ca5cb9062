//! The bytes and the lines of a file, which may be compressed.

use std::fs::{File, Metadata};
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use super::compressed::{Compression, Decompressor};
use super::error::LoadError;

/// Number of bytes of a file that are read at a time.
const PIECE: usize = 1 << 18;

/// The bytes, for readers that visit places far from each other. Longer data are read without a copy.
const SMALL_PIECE: usize = 1 << 12;

/// Number of first bytes that show the format of data.
const START: u64 = 1 << 12;

pub(super) trait Bytes: BufRead + Seek {}

impl<T: BufRead + Seek> Bytes for T {}

/// The bytes of a file. A compressed file is decompressed as it is read, so going back starts again from the
/// beginning.
#[derive(Debug)]
pub(super) enum Source {
    Plain(BufReader<File>),
    Compressed(Box<BufReader<Decompressor<Arc<File>>>>),
}

/// Opens a regular file. Others, such as pipes and devices, are refused, because reading them might never end.
///
/// # Errors
/// Returns an error if the file cannot be opened or is not a regular one.
pub fn open_regular(path: &Path) -> io::Result<File> {
    // Opening a pipe would wait, so its kind is asked before; afterwards the name might be that of another file.
    let refused = || io::Error::new(io::ErrorKind::InvalidInput, "this is not a regular file; copy it to a file");
    let regular = |metadata: Metadata| metadata.is_file().then_some(()).ok_or_else(refused);
    regular(path.metadata()?)?;
    let file = File::open(path)?;
    regular(file.metadata()?)?;
    Ok(file)
}

impl Source {
    /// Opens a regular file. The first bytes show whether it is compressed.
    pub(super) fn open(path: &Path) -> io::Result<Self> {
        let mut plain = BufReader::with_capacity(PIECE, open_regular(path)?);
        if let Some(compression) = Compression::of(plain.fill_buf()?) {
            let decompressor = Decompressor::new(Arc::new(plain.into_inner()), compression)?;
            return Ok(Self::Compressed(Box::new(BufReader::with_capacity(PIECE, decompressor))));
        }
        Ok(Self::Plain(plain))
    }

    /// Returns the first bytes of the data, and goes back to their start.
    pub(super) fn start(&mut self) -> io::Result<Vec<u8>> {
        let first = start_of_plain(&mut *self)?;
        self.rewind()?;
        Ok(first)
    }

    /// Returns this source, at the start of the file, for a reader that visits places far from each other.
    pub(super) fn in_small_pieces(self) -> io::Result<Self> {
        let mut source = match self {
            Self::Plain(plain) => Self::Plain(BufReader::with_capacity(SMALL_PIECE, plain.into_inner())),
            compressed => compressed,
        };
        source.rewind()?;
        Ok(source)
    }

    fn inner(&mut self) -> &mut dyn Bytes {
        match self {
            Self::Plain(plain) => plain,
            Self::Compressed(compressed) => compressed.as_mut(),
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

pub(super) fn bytes(source: &mut dyn Bytes, range: &Range<u64>) -> Result<Vec<u8>, LoadError> {
    /// Initial allocation in bytes. It grows as data arrive, because a file may lie about its frames.
    const AT_ONCE: u64 = 1 << 26;
    let length = range.end - range.start;
    let mut bytes = Vec::with_capacity(length.min(AT_ONCE) as usize);
    source.seek(SeekFrom::Start(range.start))?;
    if source.take(length).read_to_end(&mut bytes)? as u64 != length {
        return Err(io::Error::from(io::ErrorKind::UnexpectedEof).into());
    }
    Ok(bytes)
}

/// The first bytes of data that may be compressed.
pub(super) fn start_of(bytes: &[u8]) -> io::Result<Vec<u8>> {
    match Compression::of(bytes) {
        Some(compression) => start_of_plain(Decompressor::new(Cursor::new(bytes), compression)?),
        None => start_of_plain(bytes),
    }
}

fn start_of_plain(data: impl Read) -> io::Result<Vec<u8>> {
    let mut first = Vec::new();
    data.take(START).read_to_end(&mut first)?;
    Ok(first)
}

/// Reads lines one by one, and counts them and their bytes.
pub(super) struct LineReader<'a> {
    source: &'a mut dyn Bytes,
    pub(super) offset: u64,
    pub(super) line: usize,
    text: Vec<u8>,
}

impl<'a> LineReader<'a> {
    pub(super) fn new(source: &'a mut dyn Bytes) -> Self {
        Self { source, offset: 0, line: 0, text: Vec::new() }
    }

    /// Returns the next line without its line end; `None` at the end of the file. A line longer than 1 KiB is cut, and
    /// only its start is returned.
    pub(super) fn next(&mut self) -> io::Result<Option<&[u8]>> {
        const LONGEST: u64 = 1 << 10;
        self.text.clear();
        // Most lines are short and already in the buffer.
        let buffer = self.source.fill_buf()?;
        let near = &buffer[..buffer.len().min(LONGEST as usize)];
        if let Some(end) = memchr::memchr(b'\n', near) {
            self.text.extend_from_slice(&near[..end]);
            self.source.consume(end + 1);
            self.offset += end as u64 + 1;
            self.line += 1;
            return Ok(Some(&self.text));
        }
        let read = (&mut *self.source).take(LONGEST).read_until(b'\n', &mut self.text)?;
        if read == 0 {
            return Ok(None);
        }
        self.offset += read as u64;
        self.line += 1;
        if self.text.last() == Some(&b'\n') {
            self.text.pop();
        } else {
            self.offset += self.source.skip_until(b'\n')? as u64;
        }
        Ok(Some(&self.text))
    }

    /// Skips lines, and returns how many there were. The last may lack a line end.
    pub(super) fn skip(&mut self, lines: usize) -> io::Result<usize> {
        const BLOCK: usize = 1 << 13;
        let (mut found, mut is_within) = (0, false);
        while found < lines {
            let buffer = self.source.fill_buf()?;
            if buffer.is_empty() {
                found += usize::from(is_within);
                break;
            }
            // Counting line ends is faster than visiting lines. Blocks are small, as the frame's end is unknown.
            let block = &buffer[..buffer.len().min(BLOCK)];
            let wanted = lines - found;
            let count = memchr::memchr_iter(b'\n', block).count();
            let last = if count < wanted { None } else { memchr::memchr_iter(b'\n', block).nth(wanted - 1) };
            let end = last.map_or(block.len(), |last| last + 1);
            is_within = block[end - 1] != b'\n';
            found += count.min(wanted);
            self.offset += end as u64;
            self.source.consume(end);
        }
        self.line += found;
        Ok(found)
    }
}
