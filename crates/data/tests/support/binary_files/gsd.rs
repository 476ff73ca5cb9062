//! Writes GSD files of both versions.

/// The numbers of a chunk, in one of the format's types.
pub(crate) enum Data {
    U8(Vec<u8>),
    U32(Vec<u32>),
    I32(Vec<i32>),
    F32(Vec<f32>),
    F64(Vec<f64>),
}

impl Data {
    fn bytes(&self) -> (u8, u64, Vec<u8>) {
        match self {
            Self::U8(all) => (1, 1, all.clone()),
            Self::U32(all) => (3, 4, all.iter().flat_map(|value| value.to_le_bytes()).collect()),
            Self::I32(all) => (7, 4, all.iter().flat_map(|value| value.to_le_bytes()).collect()),
            Self::F32(all) => (9, 4, all.iter().flat_map(|value| value.to_le_bytes()).collect()),
            Self::F64(all) => (10, 8, all.iter().flat_map(|value| value.to_le_bytes()).collect()),
        }
    }
}

pub(crate) struct Chunk {
    pub(crate) frame: u64,
    pub(crate) name: &'static str,
    pub(crate) columns: u32,
    pub(crate) data: Data,
}

pub(crate) fn chunk(frame: u64, name: &'static str, columns: u32, data: Data) -> Chunk {
    Chunk { frame, name, columns, data }
}

/// Writes a file of the given version.
pub(crate) fn file(version: u32, chunks: &[Chunk]) -> Vec<u8> {
    let mut names: Vec<&str> = Vec::new();
    for chunk in chunks {
        if !names.contains(&chunk.name) {
            names.push(chunk.name);
        }
    }
    let mut list: Vec<u8> = Vec::new();
    for name in &names {
        list.extend(name.as_bytes());
        list.resize(if version == 1 { list.len().next_multiple_of(64) } else { list.len() + 1 }, 0);
    }
    list.resize(list.len().next_multiple_of(64), 0);
    let index_at = 256 + list.len() as u64;
    // The index has one more entry, because an empty one marks its end.
    let entries = chunks.len() as u64 + 1;
    let (mut index, mut data) = (Vec::new(), Vec::new());
    for Chunk { frame, name, columns, data: numbers } in chunks {
        let (kind, width, bytes) = numbers.bytes();
        let rows = bytes.len() as u64 / width / u64::from(*columns);
        let location = index_at + 32 * entries + data.len() as u64;
        let id = names.iter().position(|known| known == name).unwrap() as u16;
        [*frame, rows, location].iter().for_each(|value| index.extend(value.to_le_bytes()));
        index.extend(columns.to_le_bytes());
        index.extend(id.to_le_bytes());
        index.extend([kind, 0]);
        data.extend(bytes);
    }
    index.extend([0; 32]);
    let mut head = Vec::new();
    for value in [0x65DF_65DF_65DF_65DF_u64, index_at, entries, 256, list.len() as u64 / 64] {
        head.extend(value.to_le_bytes());
    }
    head.extend(0x1_0004_u32.to_le_bytes());
    head.extend((version << 16).to_le_bytes());
    head.resize(112, 0);
    head.extend(b"hoomd");
    head.resize(256, 0);
    [head, list, index, data].concat()
}

/// Three frames: the particles move in the second, and the third has one particle less.
pub(crate) fn chunks() -> Vec<Chunk> {
    let positions =
        |frame: u16, count: u16| Data::F32((0..3 * count).map(|index| f32::from(100 * frame + index)).collect());
    vec![
        chunk(0, "configuration/box", 1, Data::F32(vec![10.0, 20.0, 30.0, 0.5, 0.25, 0.125])),
        chunk(0, "particles/N", 1, Data::U32(vec![3])),
        chunk(0, "particles/position", 3, positions(0, 3)),
        chunk(0, "particles/types", 4, Data::U8(b"A\0\0\0poly".to_vec())),
        chunk(0, "particles/typeid", 1, Data::U32(vec![1, 0, 1])),
        chunk(0, "particles/diameter", 1, Data::F32(vec![2.0, 3.0, 4.0])),
        chunk(0, "particles/image", 3, Data::I32((-4..5).collect())),
        chunk(0, "particles/orientation", 4, Data::F32(vec![0.5; 12])),
        chunk(0, "bonds/group", 2, Data::U32(vec![0, 1])),
        chunk(0, "log/particles/md/energy", 1, Data::F64(vec![1.5, 2.5, 3.5])),
        chunk(0, "log/temperature", 1, Data::F64(vec![300.0])),
        chunk(1, "particles/position", 3, positions(1, 3)),
        chunk(2, "particles/N", 1, Data::U32(vec![2])),
        chunk(2, "particles/position", 3, positions(2, 2)),
    ]
}
