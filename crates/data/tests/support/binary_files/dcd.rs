//! Writes DCD files of every layout.

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Order {
    Little,
    Big,
}

/// The layout of a file.
#[derive(Clone, Copy)]
pub(crate) struct Layout {
    pub(crate) order: Order,
    pub(crate) marker_bytes: usize,
    pub(crate) cell: Option<[f64; 6]>,
    pub(crate) has_fourth: bool,
    /// Whether only the first and the last of four atoms move.
    pub(crate) has_fixed: bool,
}

pub(crate) const ATOMS: usize = 4;
pub(crate) const FRAMES_WRITTEN: usize = 3;
pub(crate) const PLAIN: Layout =
    Layout { order: Order::Little, marker_bytes: 4, cell: None, has_fourth: false, has_fixed: false };

pub(crate) fn ordered<const N: usize>(little: [u8; N], order: Order) -> Vec<u8> {
    let mut bytes = little.to_vec();
    if order == Order::Big {
        bytes.reverse();
    }
    bytes
}

pub(crate) fn record(layout: Layout, content: &[u8]) -> Vec<u8> {
    let length = match layout.marker_bytes {
        4 => ordered((content.len() as u32).to_le_bytes(), layout.order),
        _ => ordered((content.len() as u64).to_le_bytes(), layout.order),
    };
    [&length, content, &length].concat()
}

/// The coordinate of an atom that is not fixed.
pub(crate) fn coordinate(frame: usize, atom: usize, axis: usize) -> f32 {
    frame as f32 * 100.0 + atom as f32 * 10.0 + axis as f32 + 0.25
}

pub(crate) fn file(layout: Layout) -> Vec<u8> {
    let int = |value: u32| ordered(value.to_le_bytes(), layout.order);
    let mut control = [0_u32; 20];
    (control[0], control[19]) = (FRAMES_WRITTEN as u32, 24);
    control[8] = if layout.has_fixed { 2 } else { 0 };
    control[10] = layout.cell.is_some().into();
    control[11] = layout.has_fourth.into();
    let mut head = b"CORD".to_vec();
    control.iter().for_each(|value| head.extend(int(*value)));
    let title = [int(2), vec![b' '; 160]].concat();
    let mut all = [record(layout, &head), record(layout, &title)].concat();
    all.extend(record(layout, &int(ATOMS as u32)));
    if layout.has_fixed {
        all.extend(record(layout, &[int(1), int(4)].concat()));
    }
    for frame in 0..FRAMES_WRITTEN {
        if let Some(cell) = layout.cell {
            let cell: Vec<u8> = cell.iter().flat_map(|value| ordered(value.to_le_bytes(), layout.order)).collect();
            all.extend(record(layout, &cell));
        }
        let atoms: &[usize] = if layout.has_fixed && frame > 0 { &[0, 3] } else { &[0, 1, 2, 3] };
        for axis in 0..if layout.has_fourth { 4 } else { 3 } {
            let values: Vec<u8> = atoms
                .iter()
                .flat_map(|atom| ordered(coordinate(frame, *atom, axis).to_le_bytes(), layout.order))
                .collect();
            all.extend(record(layout, &values));
        }
    }
    all
}
