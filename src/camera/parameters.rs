//! The parameters of whichever camera, as a scene file's table or flags give them.

use serde::Deserialize;

use super::{Camera, CameraError, camera_table};
use crate::bounds::Bounds;
use crate::exact::Table;

macro_rules! define_camera_parameters {
    ($($(#[$doc:meta])* $variant:ident, $camera:ident, $name:literal, $parameters:ident;)+) => {
        /// The table `[camera.NAME]`.
        #[derive(Clone, Copy, Debug, Deserialize)]
        pub(crate) enum CameraParameters {
            $(#[serde(rename = $name)] $variant(Table<super::$parameters>),)+
        }

        impl CameraParameters {
            /// The camera, or of two eyes that in the middle, for a film of the given aspect ratio and, if it has to frame the scene, a
            /// box.
            pub(crate) fn camera(
                &self,
                aspect: f64,
                bounds: &Bounds,
            ) -> Result<Box<dyn Camera>, CameraError> {
                match self {
                    $(Self::$variant(parameters) => {
                        Ok(Box::new(parameters.0.camera(aspect, bounds)?))
                    })+
                }
            }
        }
    };
}
camera_table!(define_camera_parameters);

impl CameraParameters {
    /// Left and right eye, if there are two.
    pub(crate) fn stereo_pair(
        &self,
        aspect: f64,
        bounds: &Bounds,
    ) -> Result<Option<[Box<dyn Camera>; 2]>, CameraError> {
        Ok(match self {
            Self::Pinhole(table) => table.0.stereo_pair(aspect, bounds)?.map(boxed),
            Self::Panorama(table) => table.0.stereo_pair(aspect, bounds)?.map(boxed),
            _ => None,
        })
    }
}

fn boxed<C: Camera + 'static>(pair: [C; 2]) -> [Box<dyn Camera>; 2] {
    pair.map(|camera| Box::new(camera) as Box<dyn Camera>)
}

impl Default for CameraParameters {
    fn default() -> Self {
        Self::Pinhole(Table::default())
    }
}
