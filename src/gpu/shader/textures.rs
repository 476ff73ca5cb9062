//! Kernels for software devices, which read what they search from textures.
//!
//! Lavapipe (Mesa 22.3) reads a vector for eight invocations in 9 ns from a storage texture and in 23 ns from a storage
//! buffer, because it reads buffers in a loop with branches. So the ids of a brick and the words of its structure are in
//! textures there, with the same values. Spheres stay in a buffer: few invocations of eight read them at a time, which buffers
//! serve as quickly, and shading reads them, too. GPUs were not measured, and keep buffers.

use wgpu::{Device, DeviceType, TextureFormat};

/// Data of a brick that kernels search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Searched {
    /// The ids of the spheres, and what follows them in the same buffer.
    Ids,
    /// The balls of a grid, or the nodes of a tree.
    Words,
}

/// The greatest width of the textures, whose texels follow each other row by row.
pub(crate) const TEXELS_PER_ROW: usize = 1 << 12;

/// The names in WGSL. Only kernels with `ids` search.
const NAMES: [(&str, Searched); 3] = [("ids", Searched::Ids), ("balls", Searched::Words), ("nodes", Searched::Words)];

/// True if kernels of a device search textures.
pub(crate) fn reads_textures(device: &Device) -> bool {
    device.adapter_info().device_type == DeviceType::Cpu
}

impl Searched {
    pub(crate) fn format(self) -> TextureFormat {
        match self {
            Self::Ids => TextureFormat::R32Uint,
            Self::Words => TextureFormat::Rgba32Uint,
        }
    }

    /// The type in WGSL, and the components of a texel.
    fn texel(self) -> [&'static str; 2] {
        match self {
            Self::Ids => ["r32uint", ".x"],
            Self::Words => ["rgba32uint", ""],
        }
    }
}

/// The WGSL of a kernel with textures in the place of the buffers that it searches. Lines stay where they are.
pub(super) fn with_textures(source: &str) -> String {
    let declares = |line: &str, name: &str| line.contains("var<storage") && line.contains(&format!("> {name}: array<"));
    if !source.lines().any(|line| declares(line, "ids")) {
        return source.to_owned();
    }
    let mut text = String::with_capacity(source.len() + 512);
    for line in source.lines() {
        let mut line = line.to_owned();
        for (name, searched) in NAMES {
            let [format, components] = searched.texel();
            line = match line.find("var<storage").filter(|_| declares(&line, name)) {
                Some(start) => format!("{}var {name}: texture_storage_2d<{format}, read>;", &line[..start]),
                None => with_reads(&line, name, components),
            };
        }
        text += &line;
        text.push('\n');
    }
    let (mask, shift) = (TEXELS_PER_ROW - 1, TEXELS_PER_ROW.trailing_zeros());
    text + &format!("fn texel_at(index: u32) -> vec2u {{\n    return vec2u(index & {mask}u, index >> {shift}u);\n}}\n")
}

/// A line in which every element `name[...]` is read from a texture.
fn with_reads(line: &str, name: &str, components: &str) -> String {
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '.';
    let element = format!("{name}[");
    let mut text = String::new();
    let mut rest = line;
    while let Some(start) = rest.find(&element) {
        let (before, index) = (&rest[..start], &rest[start + element.len()..]);
        let mut depth = 1;
        let end = index.find(|c: char| {
            depth += i32::from(c == '[') - i32::from(c == ']');
            depth == 0
        });
        let Some(end) = end.filter(|_| !before.ends_with(is_name)) else {
            text += &rest[..start + element.len()];
            rest = index;
            continue;
        };
        text += &format!("{before}textureLoad({name}, texel_at({})){components}", &index[..end]);
        rest = &index[end + 1..];
    }
    text + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::kernels::all_sources;

    #[test]
    fn elements_are_read_from_textures() {
        let read = |line| with_reads(line, "ids", ".x");
        assert_eq!(read("let a = ids[b + ids[c]];"), "let a = textureLoad(ids, texel_at(b + ids[c])).x;");
        assert_eq!(read("ids[a], my_ids[b], it.ids[c]"), "textureLoad(ids, texel_at(a)).x, my_ids[b], it.ids[c]");
        assert_eq!(read("no elements"), "no elements");
    }

    /// All kernels that search are valid with textures, and have no more of them than every device allows.
    #[test]
    fn every_kernel_that_searches_takes_textures() {
        let mut changed = 0;
        for kernel in all_sources() {
            let (source, name) = (kernel.source(), kernel.name());
            let other = with_textures(&source);
            if other == source {
                continue;
            }
            changed += 1;
            assert!(other.matches("texture_storage_2d").count() <= 4, "{name}");
            let module = naga::front::wgsl::parse_str(&other).unwrap_or_else(|error| panic!("{name}: {error}"));
            let all = naga::valid::Capabilities::all();
            naga::valid::Validator::new(naga::valid::ValidationFlags::all(), all).validate(&module).unwrap();
        }
        assert!(changed > 30, "{changed}");
    }
}
