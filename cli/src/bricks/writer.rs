//! Writes bricks: each sphere goes to the end of its brick, through a buffer.

use std::io::{self, Seek, SeekFrom, Write};

use data_encoding::HEXLOWER;
use pinhole::glam::Vec3;
use sha2::{Digest, Sha256};

use super::file::{BEFORE, Brick, COLOR, Header, ID, PLACE, SPHERE, START, Section, bits};

/// Bytes of all buffers together.
const BUFFERS: usize = 64 << 20;

/// The parts of a brick: spheres, ids and colours.
const PARTS: usize = 3;

/// Bytes that wait to be written from a place on, and the digest of those before.
struct Buffer {
    place: u64,
    bytes: Vec<u8>,
    digest: Sha256,
}

/// A brick that is being written.
struct Open {
    count: u64,
    added: u64,
    offset: u64,
    min: Vec3,
    max: Vec3,
    parts: [Buffer; PARTS],
}

/// The bricks of a file that is being written.
pub(super) struct Writer<'a, F: Write + Seek> {
    file: &'a mut F,
    bricks: Vec<Open>,
    /// How many bytes a buffer has before it is written.
    capacity: usize,
    has_colors: bool,
    /// Where the bricks end.
    end: u64,
}

impl<'a, F: Write + Seek> Writer<'a, F> {
    /// Bricks with these numbers of spheres, none of which is zero, with or without colours.
    pub(super) fn new(file: &'a mut F, counts: &[u64], has_colors: bool) -> Self {
        let mut end = BEFORE;
        let color = if has_colors { COLOR } else { 0 };
        let open = |count: &u64| {
            let offset = end;
            let places = [offset, offset + SPHERE * count, offset + (SPHERE + ID) * count];
            end += (SPHERE + ID + color) * count;
            let parts =
                places.map(|place| Buffer { place, bytes: Vec::new(), digest: Sha256::new() });
            Open { count: *count, added: 0, offset, min: Vec3::MAX, max: Vec3::MIN, parts }
        };
        let bricks: Vec<Open> = counts.iter().map(open).collect();
        let capacity = (BUFFERS / (PARTS * bricks.len().max(1))).clamp(1 << 10, 1 << 18);
        Self { file, bricks, capacity, has_colors, end }
    }

    /// Adds a sphere to a brick. The ids of a brick must ascend.
    pub(super) fn add(
        &mut self,
        brick: usize,
        id: u32,
        sphere: [f32; 4],
        color: Option<[u8; 4]>,
    ) -> io::Result<()> {
        let Self { file, bricks, capacity, .. } = self;
        let brick = &mut bricks[brick];
        brick.added += 1;
        if brick.added > brick.count {
            return Err(changed());
        }
        let [x, y, z, radius] = sphere;
        let center = Vec3::new(x, y, z);
        brick.min = brick.min.min(center - radius);
        brick.max = brick.max.max(center + radius);
        let [spheres, ids, colors] = &mut brick.parts;
        sphere.iter().for_each(|x| spheres.bytes.extend(x.to_le_bytes()));
        ids.bytes.extend(id.to_le_bytes());
        colors.bytes.extend(color.into_iter().flatten());
        [spheres, ids, colors].into_iter().try_for_each(|part| part.write(*file, *capacity))
    }

    /// Writes what waits, and returns the bricks and where they end.
    pub(super) fn finish(mut self) -> io::Result<(Vec<Brick>, u64)> {
        if self.bricks.iter().any(|brick| brick.added < brick.count) {
            return Err(changed());
        }
        let file = &mut *self.file;
        for part in self.bricks.iter_mut().flat_map(|brick| &mut brick.parts) {
            part.write(file, 0)?;
        }
        let brick = |open: Open| {
            let Open { count, offset, min, max, parts, .. } = open;
            let parts = parts.map(|part| part.digest.finalize());
            let used = if self.has_colors { PARTS } else { PARTS - 1 };
            let digest = Sha256::digest(parts[..used].concat());
            let section = Section { count, offset, sha256: HEXLOWER.encode(&digest) };
            Brick { section, min: bits(min), max: bits(max) }
        };
        Ok((self.bricks.into_iter().map(brick).collect(), self.end))
    }
}

fn changed() -> io::Error {
    io::Error::other("the data changed while it was read; sort it again")
}

impl Buffer {
    /// Writes the bytes if there are at least so many.
    fn write(&mut self, file: &mut (impl Write + Seek), least: usize) -> io::Result<()> {
        if self.bytes.len() >= least.max(1) {
            file.seek(SeekFrom::Start(self.place))?;
            file.write_all(&self.bytes)?;
            self.digest.update(&self.bytes);
            self.place += self.bytes.len() as u64;
            self.bytes.clear();
        }
        Ok(())
    }
}

/// Writes the outer spheres where the bricks end.
pub(super) fn outer(
    file: &mut (impl Write + Seek),
    place: u64,
    spheres: &[[f32; 4]],
) -> io::Result<Section> {
    let bytes: Vec<u8> = spheres.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    file.seek(SeekFrom::Start(place))?;
    file.write_all(&bytes)?;
    Ok(Section {
        count: spheres.len() as u64,
        offset: place,
        sha256: HEXLOWER.encode(&Sha256::digest(Sha256::digest(&bytes))),
    })
}

/// Writes the header where everything else ends, and then the start of the file, which knows where that is.
pub(super) fn header(
    file: &mut (impl Write + Seek),
    place: u64,
    header: &Header,
) -> io::Result<()> {
    let text = serde_json::to_vec(header)?;
    let mut start = [0; BEFORE as usize];
    start[..START.len()].copy_from_slice(START);
    start[PLACE..PLACE + 8].copy_from_slice(&place.to_le_bytes());
    start[PLACE + 8..PLACE + 16].copy_from_slice(&(text.len() as u64).to_le_bytes());
    let digest = Sha256::new().chain_update(start).chain_update(&text).finalize();
    file.seek(SeekFrom::Start(place))?;
    file.write_all(&text)?;
    file.write_all(&digest)?;
    file.seek(SeekFrom::Start(0))?;
    file.write_all(&start)
}

/// A part of the file that has not been written yet.
pub(super) fn none() -> Section {
    Section { count: 0, offset: 0, sha256: String::new() }
}
