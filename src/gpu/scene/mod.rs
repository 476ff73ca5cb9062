//! A scene on a device: its buffers, and updates of them. A brick is a part of a scene that fits into one binding.

pub(crate) mod appearance;
pub(crate) mod query_structure;
pub(crate) mod recolor;
pub(crate) mod scene_buffers;
pub(crate) mod scene_summary;
pub(crate) mod scene_upload;
pub(crate) mod structures;
