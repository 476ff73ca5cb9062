//! Edits of the shader source.

/// Replacement of text in a shader. It is meant for experiments, and for tests that insert a fault that must be found.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct ShaderEdit {
    /// Path of the file relative to the folder `shaders`, such as `math/fence.wgsl`. For a file with variants, `#` and
    /// the name of the variant follow, such as `primary/entry.wgsl#made`.
    pub file: String,
    /// The text that is replaced. Every occurrence in the file is replaced.
    pub find: String,
    /// The text that replaces it.
    pub replace: String,
}
