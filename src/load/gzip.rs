//! Reads files that are compressed with gzip.

use std::io::{self, Read, Seek, SeekFrom};

use flate2::read::MultiGzDecoder;

/// Whether the first bytes are those of a file that is compressed with gzip.
pub(super) fn starts(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}

/// Decompresses a file that is in memory.
pub(super) fn decompressed(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut all = Vec::new();
    MultiGzDecoder::new(bytes).read_to_end(&mut all)?;
    Ok(all)
}

/// How many bytes a file decompresses to, as its last four bytes say: right for a file of one member and less than
/// 4 GiB. Nothing depends on it but the check whether there is enough memory.
pub(super) fn size_hint(bytes: &[u8]) -> u64 {
    bytes.last_chunk().map_or(0, |last| u32::from_le_bytes(*last).into())
}

/// Decompresses a file as it is read. Seeking forward decompresses what lies between, and seeking back begins again.
#[derive(Debug)]
pub(super) struct Gunzip<R> {
    /// `None` only while the decoder is being replaced.
    decoder: Option<MultiGzDecoder<R>>,
    /// How many decompressed bytes were read.
    position: u64,
}

impl<R: Read + Seek> Gunzip<R> {
    /// Decompresses `compressed`, which stands at its start.
    pub(super) fn new(compressed: R) -> Self {
        Self { decoder: Some(MultiGzDecoder::new(compressed)), position: 0 }
    }

    fn restart(&mut self) -> io::Result<()> {
        if let Some(decoder) = self.decoder.take() {
            let mut compressed = decoder.into_inner();
            compressed.rewind()?;
            *self = Self::new(compressed);
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
        // A place after the end is one where nothing can be read, as in a plain file.
        Ok(wanted)
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufRead as _, BufReader, Cursor, Write as _};

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

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
        assert!(starts(&file));
        assert_eq!(decompressed(&file).unwrap(), bytes);
        assert_eq!(size_hint(&compressed(&bytes)), 400_000);
        let mut gunzip = BufReader::new(Gunzip::new(Cursor::new(file)));
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
    fn a_damaged_file_is_an_error() {
        let mut file = compressed(&[7; 1000]);
        file.truncate(file.len() - 6);
        let mut all = Vec::new();
        assert!(decompressed(&file).is_err());
        assert!(Gunzip::new(Cursor::new(file)).read_to_end(&mut all).is_err());
    }
}
