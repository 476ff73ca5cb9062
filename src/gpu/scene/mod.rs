//! A scene on a device: its buffers, and updates of them.

pub(in crate::gpu) mod appearance;
pub(in crate::gpu) mod query_structure;
pub(in crate::gpu) mod recolor;
pub(in crate::gpu) mod scene_buffers;
pub(in crate::gpu) mod scene_summary;
pub(in crate::gpu) mod scene_upload;
pub(in crate::gpu) mod shape_ids;
pub(in crate::gpu) mod structures;
