//! Changes of shaders.

/// A change of a shader: for experiments, and for tests that a fault is found.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct ShaderEdit {
    /// A file of the folder `shaders`, as `math/fence.wgsl`; of a file with variants also `#` and the variant's name, as
    /// `primary/entry.wgsl#made`.
    pub file: String,
    /// What is replaced, wherever it stands in the file.
    pub find: String,
    /// What it is replaced by.
    pub replace: String,
}
