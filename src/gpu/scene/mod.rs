//! A scene on a device: its buffers, and updates of them.

pub(crate) mod appearance;
pub(crate) mod query_structure;
pub(crate) mod recolor;
pub(crate) mod scene_buffers;
pub(crate) mod scene_summary;
pub(crate) mod scene_upload;
pub(crate) mod structures;
