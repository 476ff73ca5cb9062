//! The lines of a file that need not fit into memory.

use std::io::{self, BufRead as _, Read as _};

use super::source::Bytes;

/// Reads lines one by one, and counts them and their bytes.
pub(super) struct LineReader<'a> {
    source: &'a mut dyn Bytes,
    /// Bytes so far.
    pub(super) offset: u64,
    /// Lines so far.
    pub(super) line: usize,
    text: Vec<u8>,
}

impl<'a> LineReader<'a> {
    pub(super) fn new(source: &'a mut dyn Bytes) -> Self {
        Self { source, offset: 0, line: 0, text: Vec::new() }
    }

    /// Returns the next line without its line end; `None` at the end of the file. Of a line longer than 1 KiB only the
    /// start.
    pub(super) fn next(&mut self) -> io::Result<Option<&[u8]>> {
        const LONGEST: u64 = 1 << 10;
        self.text.clear();
        // Most lines are short and lie in what has been read.
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
            // Counting is faster than looking at every line, but where a frame ends is not known.
            let block = &buffer[..buffer.len().min(BLOCK)];
            let wanted = lines - found;
            let count = memchr::memchr_iter(b'\n', block).count();
            let last = if count < wanted {
                None
            } else {
                memchr::memchr_iter(b'\n', block).nth(wanted - 1)
            };
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
