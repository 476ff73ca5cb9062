//! The parameters of a camera of any kind, as a scene file or command-line flags give them.

use serde::{Deserialize, Serialize};

use super::{Camera, CameraError, camera_table};
use crate::exact::Table;
use crate::geometry::subject::Subject;

/// The parameters of a camera of any kind: the table `[camera.NAME]` of a scene file, from which it is deserialized. The
/// default is a pinhole camera that frames the scene.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[serde(transparent)]
pub struct CameraParameters(ByKind);

macro_rules! define_camera_parameters {
    ($($(#[$doc:meta])* $variant:ident, $camera:ident, $name:literal, $parameters:ident;)+) => {
        /// The parameters of each kind of camera.
        #[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
        enum ByKind {
            $(#[serde(rename = $name)] $variant(Table<super::$parameters>),)+
        }

        impl CameraParameters {
            /// The camera for a film of this aspect ratio; for two eyes, the camera halfway between them. It frames
            /// the subject if the parameters give no position.
            ///
            /// # Errors
            /// Returns an error if a parameter is out of range, or parameters exclude each other.
            pub fn camera(
                &self,
                aspect: f64,
                subject: &Subject<'_>,
            ) -> Result<Box<dyn Camera>, CameraError> {
                match &self.0 {
                    $(ByKind::$variant(parameters) => {
                        Ok(Box::new(parameters.0.camera(aspect, subject)?))
                    })+
                }
            }

            /// The same camera with its position, its direction and the direction that is up, so that it no longer
            /// depends on the subject.
            ///
            /// # Errors
            /// Returns an error if a parameter is out of range, or parameters exclude each other.
            pub fn placed(
                &self,
                aspect: f64,
                subject: &Subject<'_>,
            ) -> Result<Self, CameraError> {
                match &self.0 {
                    $(ByKind::$variant(parameters) => {
                        let placed = parameters.0.placed(aspect, subject)?;
                        Ok(Self(ByKind::$variant(Table(placed))))
                    })+
                }
            }
        }
    };
}
camera_table!(define_camera_parameters);

impl CameraParameters {
    /// The cameras of the left and of the right eye; `None` unless the parameters ask for two eyes.
    ///
    /// # Errors
    /// Returns the same errors as [`CameraParameters::camera`].
    pub fn stereo_pair(
        &self,
        aspect: f64,
        subject: &Subject<'_>,
    ) -> Result<Option<[Box<dyn Camera>; 2]>, CameraError> {
        Ok(match &self.0 {
            ByKind::Pinhole(table) => table.0.stereo_pair(aspect, subject)?.map(boxed),
            ByKind::Panorama(table) => table.0.stereo_pair(aspect, subject)?.map(boxed),
            _ => None,
        })
    }
}

fn boxed<C: Camera + 'static>(pair: [C; 2]) -> [Box<dyn Camera>; 2] {
    pair.map(|camera| Box::new(camera) as Box<dyn Camera>)
}

impl Default for CameraParameters {
    fn default() -> Self {
        Self(ByKind::Pinhole(Table::default()))
    }
}
