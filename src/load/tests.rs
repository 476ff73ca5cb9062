//! Helpers for the tests of readers.

use super::{ColumnValues, Loaded};
use crate::scene::sphere_array::SphereArray;

pub(super) fn spheres(loaded: &Loaded) -> &[[f64; 4]] {
    match &loaded.spheres {
        SphereArray::F64(spheres) => spheres,
        SphereArray::F32(_) => panic!("f32"),
    }
}

pub(super) fn centers(loaded: &Loaded) -> Vec<[f64; 3]> {
    spheres(loaded).iter().map(|[x, y, z, _]| [*x, *y, *z]).collect()
}

pub(super) fn numbers(loaded: &Loaded, column: &str) -> Vec<f64> {
    match loaded.column(column) {
        Some(ColumnValues::Numbers(numbers)) => numbers.clone(),
        other => panic!("{column}: {other:?}"),
    }
}

pub(super) fn labels(loaded: &Loaded, column: &str) -> Vec<String> {
    let labels = loaded.labels(column).unwrap();
    labels.indices.iter().map(|index| labels.names[*index as usize].clone()).collect()
}

/// Reads a text that is cut anywhere, and damaged versions of it, of which the first three frames: no panic, and one value
/// of every column for each sphere. `telling` are bytes that mean something in the format.
pub(super) fn damage(text: &str, telling: &[u8], read: impl Fn(&[u8], usize) -> Option<Loaded>) {
    let read_all = |bytes: &[u8]| {
        for loaded in (0..3).filter_map(|frame| read(bytes, frame)) {
            let spheres = loaded.spheres.len();
            for column in &loaded.columns {
                let values = match &column.values {
                    ColumnValues::Labels(labels) => {
                        let names = labels.names.len();
                        assert!(labels.indices.iter().all(|index| (*index as usize) < names));
                        labels.indices.len()
                    }
                    ColumnValues::Numbers(numbers) => numbers.len(),
                };
                assert_eq!(values, spheres, "{}", column.name);
            }
            assert!(loaded.colors.is_none_or(|colors| colors.len() == spheres));
        }
    };
    (0..text.len()).for_each(|end| read_all(&text.as_bytes()[..end]));
    let mut random = fastrand::Rng::with_seed(1);
    for _ in 0..5000 {
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..random.usize(1..6) {
            let at = random.usize(..bytes.len());
            let telling = *random.choice(telling).unwrap();
            match random.u8(..4) {
                0 => bytes[at] = random.u8(..),
                1 => bytes[at] = telling,
                2 => drop(bytes.remove(at)),
                _ => bytes.insert(at, telling),
            }
        }
        read_all(&bytes);
    }
}
