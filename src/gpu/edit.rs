//! Edits of the shader source.

use std::fmt;
use std::sync::Arc;

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

/// A function that gets the name and the WGSL of each composed kernel, and returns the WGSL that the device gets
/// instead. It is meant for tests that need a device with other roundings that WGSL also permits.
#[derive(Clone)]
pub struct KernelRewrite(Arc<RewriteKernel>);

type RewriteKernel = dyn Fn(&str, &str) -> String + Send + Sync;

impl KernelRewrite {
    /// A rewrite by a function of the name of a kernel and its WGSL.
    pub fn new(rewrite: impl Fn(&str, &str) -> String + Send + Sync + 'static) -> Self {
        Self(Arc::new(rewrite))
    }

    pub(crate) fn apply(&self, name: &str, source: &str) -> String {
        (self.0)(name, source)
    }
}

impl fmt::Debug for KernelRewrite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("KernelRewrite")
    }
}

impl PartialEq for KernelRewrite {
    /// Whether both are clones of the same rewrite.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// All edits of the kernels of a device: first replacements in their files, then the rewrite of the composed kernels.
#[derive(Clone, Debug, Default)]
pub(crate) struct Edits {
    pub(crate) replacements: Vec<ShaderEdit>,
    pub(crate) rewrite: Option<KernelRewrite>,
}
