//! Files of NumPy, made by hand, so that they can be wrong.

use std::io::Write;

use rawzip::{CompressionMethod, ZipArchiveWriter};

/// An `.npy` file.
pub(crate) fn npy(dtype: &str, by_column: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let order = if by_column { "True" } else { "False" };
    let text = format!("{{'descr': '{dtype}', 'fortran_order': {order}, 'shape': {shape}, }}");
    // As NumPy pads it: the data starts at a multiple of 64 bytes.
    let length = (10 + text.len() + 1).next_multiple_of(64) - 10;
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend(u16::try_from(length).unwrap().to_le_bytes());
    file.extend(text.as_bytes());
    file.resize(10 + length - 1, b' ');
    file.push(b'\n');
    file.extend(data);
    file
}

/// Two structures with positions, colours, opacities, text and what is not used.
pub(crate) fn structured() -> Vec<u8> {
    let header = "{'descr': [('pos', '<f4', (3,)), ('', '|V2'), ('diameter', '>f8'), ('rgba', '|u1', (4,)), \
                  ('kind', '<U2'), ('phase', '<c8'), ('alive', '|b1')], 'fortran_order': False, 'shape': (2,)}";
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.as_bytes());
    for (x, kind) in [(1.0_f32, "Ab"), (2.0, "z")] {
        file.extend([x, 10.0 * x, 0.0].map(f32::to_le_bytes).as_flattened());
        file.extend([9, 9]);
        file.extend(f64::from(x).to_be_bytes());
        file.extend([255, 0, 51, 51 * x as u8]);
        let codes: Vec<u32> = kind.chars().map(u32::from).chain([0; 2]).take(2).collect();
        file.extend(codes.into_iter().flat_map(u32::to_le_bytes));
        file.extend([0; 8]);
        file.push(u8::from(x > 1.5));
    }
    file
}

/// A zip archive, stored as `savez` does or deflated as `savez_compressed` does.
pub(crate) fn zip(entries: &[(&str, &[u8])], deflated: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut archive = ZipArchiveWriter::new(&mut bytes);
    for (name, contents) in entries {
        let method = if deflated { CompressionMethod::DEFLATE } else { CompressionMethod::STORE };
        let file = archive.new_file(*name).compression_method(method);
        let (mut entry, config) = file.start().unwrap();
        if deflated {
            let level = flate2::Compression::default();
            let mut writer = config.wrap(flate2::write::DeflateEncoder::new(&mut entry, level));
            writer.write_all(contents).unwrap();
            let (encoder, descriptor) = writer.finish().unwrap();
            encoder.finish().unwrap();
            entry.finish(descriptor).unwrap();
        } else {
            let mut writer = config.wrap(&mut entry);
            writer.write_all(contents).unwrap();
            let (_, descriptor) = writer.finish().unwrap();
            entry.finish(descriptor).unwrap();
        }
    }
    archive.finish().unwrap();
    bytes
}
