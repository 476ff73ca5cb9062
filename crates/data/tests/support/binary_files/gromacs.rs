//! Writes TRR and XTC files. XTC is written by the crate molly.

pub(crate) const ATOMS: usize = 12;

/// A coordinate in nm.
pub(crate) fn coordinate(frame: usize, index: usize) -> f64 {
    frame as f64 + (index * 7 % 31) as f64 * 0.125
}

pub(crate) fn numbers(frame: usize, atoms: usize, is_double: bool) -> Vec<u8> {
    reals((0..3 * atoms).map(|index| coordinate(frame, index)), is_double)
}

pub(crate) fn reals(values: impl IntoIterator<Item = f64>, is_double: bool) -> Vec<u8> {
    let encode = |value: f64| match is_double {
        true => value.to_be_bytes().to_vec(),
        false => (value as f32).to_be_bytes().to_vec(),
    };
    values.into_iter().flat_map(encode).collect()
}

/// Writes a frame of a TRR file; `parts` says whether it has box, positions, velocities and forces.
pub(crate) fn trr_frame(frame: usize, parts: [bool; 4], is_double: bool) -> Vec<u8> {
    let [cell, x, v, f] = parts;
    let edges = [2.0, 0.0, 0.0, 0.5, 3.0, 0.0, 0.0, 0.25, 4.0];
    let table = numbers(frame, ATOMS, is_double);
    let cell = if cell { reals(edges, is_double) } else { Vec::new() };
    let virial = reals([9.0; 9], is_double);
    let of = |is_there| if is_there { table.as_slice() } else { &[] };
    let sizes = [0, 0, cell.len(), virial.len(), 0, 0, 0, of(x).len(), of(v).len(), of(f).len()];
    let int = |value: usize| (value as u32).to_be_bytes();
    let mut all = [&int(1993)[..], &int(13), &int(12), b"GMX_trn_file"].concat();
    sizes.iter().for_each(|size| all.extend(int(*size)));
    [ATOMS, frame, 0].iter().for_each(|value| all.extend(int(*value)));
    all.extend(reals([0.5, 0.0], is_double));
    [cell, virial].iter().for_each(|part| all.extend(part));
    [x, v, f].iter().for_each(|is_there| all.extend(of(*is_there)));
    all
}

pub(crate) fn trr(is_double: bool) -> Vec<u8> {
    let parts = [[true; 4], [true, false, true, false], [false, true, false, false]];
    (0..3).flat_map(|frame| trr_frame(frame, parts[frame], is_double)).collect()
}

pub(crate) fn xtc(frames: usize, atoms: usize, magic: molly::Magic) -> Vec<u8> {
    let mut file = Vec::new();
    let mut writer = molly::XTCWriter::new_with_magic(&mut file, magic);
    for frame in 0..frames {
        let positions = (0..3 * atoms).map(|index| coordinate(frame, index) as f32).collect();
        let boxvec = [2.0, 0.0, 0.0, 0.5, 3.0, 0.0, 0.0, 0.25, 4.0];
        let all = molly::Frame { positions, boxvec, ..molly::Frame::default() };
        writer.write_frame(&all).unwrap();
    }
    file
}
