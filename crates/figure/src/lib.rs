//! Makes figures with [`pinhole`]: scene files and styles, colours by data, annotations, and pictures as files.
//!
//! | I want to … | start here |
//! |---|---|
//! | read a scene file | [`scene_file::SceneFile`] |
//! | colour spheres by numbers or names | [`color_by::ColorBy`] |
//! | draw a legend, a scale bar or a label | [`annotate::Annotations`] |
//! | write a picture or its layers | [`mod@write`] |
//! | frame several pictures at once | [`framing`] |
//! | read a picture or an environment map | [`mod@read`] |
//!
//! Nothing here needs a GPU or accesses the file system.

pub mod annotate;
pub mod color_by;
pub mod framing;
pub mod kind;
pub mod read;
pub mod scene_file;
pub mod settings;
pub mod style;
pub mod write;
