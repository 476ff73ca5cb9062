//! The bytes and the lines of a file, which may be compressed with gzip.

use std::ffi::OsStr;
use std::fs::{File, Metadata};
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;

use super::error::LoadError;

/// Number of bytes of a file that are read at a time.
const PIECE: usize = 1 << 18;

/// The bytes, for readers that visit places far from each other. Longer data are read without a copy.
const SMALL_PIECE: usize = 1 << 12;

/// Number of first bytes that show the format of data.
const START: u64 = 1 << 12;

/// A compressed file expands to at most this many times its size, or to [`SMALL`] bytes if that is more. What expands
/// further was made to fill the memory.
const EXPANSION: u64 = 100;
const SMALL: u64 = 1 << 28;

pub(super) trait Bytes: BufRead + Seek {}

impl<T: BufRead + Seek> Bytes for T {}

/// The bytes of a file. A compressed file is decompressed as it is read, so going back starts again from the
/// beginning.
#[derive(Debug)]
pub(super) enum Source {
    Plain(BufReader<File>),
    Gzip(Box<BufReader<Gunzip<File>>>),
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
        if is_gzip(plain.fill_buf()?) {
            let gunzip = Gunzip::new(plain.into_inner())?;
            return Ok(Self::Gzip(Box::new(BufReader::with_capacity(PIECE, gunzip))));
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
            gzip => gzip,
        };
        source.rewind()?;
        Ok(source)
    }

    fn inner(&mut self) -> &mut dyn Bytes {
        match self {
            Self::Plain(plain) => plain,
            Self::Gzip(gzip) => gzip.as_mut(),
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

/// The path without the ending `.gz`, which says nothing about the compressed data.
pub(super) fn without_gz(path: &Path) -> PathBuf {
    let is_gz = path.extension().and_then(OsStr::to_str).is_some_and(|e| e.eq_ignore_ascii_case("gz"));
    if is_gz { path.with_extension("") } else { path.to_path_buf() }
}

/// Whether the first bytes are those of a file that is compressed with gzip.
pub(super) fn is_gzip(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}

pub(super) fn decompressed(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut all = Vec::new();
    Gunzip::new(Cursor::new(bytes))?.read_to_end(&mut all)?;
    Ok(all)
}

/// The first bytes of data that may be compressed.
pub(super) fn start_of(bytes: &[u8]) -> io::Result<Vec<u8>> {
    if is_gzip(bytes) { start_of_plain(MultiGzDecoder::new(bytes)) } else { start_of_plain(bytes) }
}

fn start_of_plain(data: impl Read) -> io::Result<Vec<u8>> {
    let mut first = Vec::new();
    data.take(START).read_to_end(&mut first)?;
    Ok(first)
}

/// The decompressed size of a file, from its last four bytes. It is right for a file of one member and less than 4
/// GiB. Only the check for enough memory depends on it.
pub(super) fn gzip_size_hint(bytes: &[u8]) -> u64 {
    bytes.last_chunk().map_or(0, |last| u32::from_le_bytes(*last).into())
}

/// Decompresses a file as it is read. Seeking forward decompresses the bytes between, and seeking back starts again.
#[derive(Debug)]
pub(super) struct Gunzip<R> {
    /// `None` only while the decoder is being replaced.
    decoder: Option<MultiGzDecoder<R>>,
    /// Number of decompressed bytes that were read.
    position: u64,
    /// Number of decompressed bytes after which the file is refused.
    most: u64,
}

impl<R: Read + Seek> Gunzip<R> {
    /// Decompresses `compressed` from its start.
    pub(super) fn new(mut compressed: R) -> io::Result<Self> {
        let most = compressed.seek(SeekFrom::End(0))?.saturating_mul(EXPANSION).max(SMALL);
        compressed.rewind()?;
        Ok(Self { decoder: Some(MultiGzDecoder::new(compressed)), position: 0, most })
    }

    fn restart(&mut self) -> io::Result<()> {
        if let Some(decoder) = self.decoder.take() {
            *self = Self::new(decoder.into_inner())?;
        }
        Ok(())
    }

    /// Reads on until `position`, or until the end, whichever comes first.
    fn read_up_to(&mut self, position: u64) -> io::Result<()> {
        let between = position.saturating_sub(self.position);
        io::copy(&mut self.by_ref().take(between), &mut io::sink())?;
        Ok(())
    }
}

impl<R: Read> Read for Gunzip<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.decoder.as_mut().map_or(Ok(0), |decoder| decoder.read(buffer))?;
        self.position += read as u64;
        if self.position > self.most {
            let message = format!(
                "it expands to more than {EXPANSION} times its size; decompress it with gunzip first, if you trust it"
            );
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        Ok(read)
    }
}

impl<R: Read + Seek> Seek for Gunzip<R> {
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
            self.restart()?;
        }
        self.read_up_to(wanted)?;
        // Nothing can be read at a place after the end, as in a plain file.
        Ok(wanted)
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write as _;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    #[test]
    fn names_of_compressed_files() {
        for (name, inner) in [("a.xyz.gz", "a.xyz"), ("a.xyz", "a.xyz"), ("b/a.GZ", "b/a"), ("gz", "gz")] {
            assert_eq!(without_gz(Path::new(name)), Path::new(inner), "{name}");
        }
    }

    fn compressed(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn seeks_forward_and_back() {
        let bytes: Vec<u8> = (0..100_000_u32).flat_map(u32::to_le_bytes).collect();
        // Two members, as `cat a.gz b.gz` makes them.
        let (first, second) = bytes.split_at(123_456);
        let file = [compressed(first), compressed(second)].concat();
        assert!(is_gzip(&file));
        assert_eq!(decompressed(&file).unwrap(), bytes);
        assert_eq!(gzip_size_hint(&compressed(&bytes)), 400_000);
        let mut gunzip = BufReader::new(Gunzip::new(Cursor::new(file)).unwrap());
        for at in [300_000_u64, 17, 399_996, 0, 123_456] {
            gunzip.seek(SeekFrom::Start(at)).unwrap();
            assert_eq!(gunzip.stream_position().unwrap(), at);
            let mut four = [0; 4];
            gunzip.read_exact(&mut four).unwrap();
            assert_eq!(four, bytes[at as usize..][..4]);
        }
        assert_eq!(gunzip.seek(SeekFrom::End(-4)).unwrap(), 399_996);
        assert_eq!(gunzip.fill_buf().unwrap(), &bytes[399_996..]);
    }

    #[test]
    fn what_expands_too_far_is_refused() {
        let mut gunzip = Gunzip::new(Cursor::new(compressed(&[b'\n'; 100_000]))).unwrap();
        assert_eq!(gunzip.most, SMALL);
        gunzip.most = 10_000;
        let error = gunzip.read_to_end(&mut Vec::new()).unwrap_err().to_string();
        assert!(error.starts_with("it expands to more than 100 times its size; "), "{error}");
    }

    #[test]
    fn a_damaged_file_is_an_error() {
        let mut file = compressed(&[7; 1000]);
        file.truncate(file.len() - 6);
        let mut all = Vec::new();
        assert!(decompressed(&file).is_err());
        assert!(Gunzip::new(Cursor::new(file)).unwrap().read_to_end(&mut all).is_err());
    }
}
