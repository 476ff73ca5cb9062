//! Cones and cylinders.

use glam::DVec3;

use crate::geometry::bounds::Bounds;
use crate::geometry::cone::ConeInFrame;

/// The largest coordinate or radius of a cone, 2⁴⁰, and the inverse of its smallest radius. Squares of lengths times
/// squares of [`MOST_ASPECT`] must be normal numbers in f32.
const MAX_LENGTH: f64 = (1_u64 << 40) as f64;

/// The most by which length and larger radius differ, as a factor.
const MOST_ASPECT: f64 = 1e4;

/// The length of a side between two spheres, as a part of its larger radius, below which the spheres alone look the same:
/// the gap between them is as deep as f32 rounds their places, about 1e-7 of the radius.
const SHORTEST_SIDE: f64 = 1e-3;

/// By how much limits are wider for cones that were rounded to f32, as a factor.
const IN_FRAME: f64 = 1.0 + 1.0 / (1 << 20) as f64;

/// A cone between two discs, in world space, that has not been checked. A cylinder has two equal radii, and the tip of a
/// pointed cone has radius 0. [`Scene::from_shapes`](crate::Scene::from_shapes) checks it.
///
/// Names and meaning are those of `cone` and `cylinder` in Khronos' ANARI 1.0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The middle of the first disc, in scene units.
    pub start: [f64; 3],
    /// The middle of the second disc.
    pub end: [f64; 3],
    /// The radii of the discs.
    pub radii: [f64; 2],
    /// The closed ends.
    pub caps: Caps,
}

/// The ends of a cone that are closed by discs. The inside is seen through others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Caps {
    /// None of them, as in a tube.
    None,
    /// The first.
    First,
    /// The second.
    Second,
    /// Both.
    #[default]
    Both,
}

/// The reason why a cone is not valid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{0}")]
#[non_exhaustive]
pub struct ConeError(String);

impl ConeError {
    pub(super) fn emissive() -> Self {
        Self("it has an emissive material; only spheres emit light".to_owned())
    }
}

impl Cone {
    /// A cone with closed ends.
    #[must_use]
    pub const fn new(start: [f64; 3], end: [f64; 3], radii: [f64; 2]) -> Self {
        Self { start, end, radii, caps: Caps::Both }
    }

    /// A cylinder with closed ends.
    #[must_use]
    pub const fn cylinder(start: [f64; 3], end: [f64; 3], radius: f64) -> Self {
        Self::new(start, end, [radius; 2])
    }

    /// The cone with other closed ends.
    #[must_use]
    pub const fn with_caps(self, caps: Caps) -> Self {
        Self { caps, ..self }
    }

    /// A cone or cylinder with round ends, which is the convex hull of two spheres (x, y, z, radius): its side, without
    /// caps, and the spheres at its ends that stick out of it. The side touches both spheres in circles, and is smooth
    /// there. One sphere that contains the other comes alone, a radius of 0 makes a tip without a sphere, and a side is left
    /// out where the spheres are so close that it would not be seen. Nothing is checked.
    ///
    /// These are the segments of Han, Wald, Usher, Wu, Wang, Pascucci, Hansen and Johnson 2019, "Ray Tracing Generalized
    /// Tube Primitives: Method and Applications".
    #[must_use]
    pub fn rounded(first: [f64; 4], second: [f64; 4]) -> (Option<Self>, [Option<[f64; 4]>; 2]) {
        let [(start, r0), (end, r1)] = [first, second].map(|[x, y, z, radius]| (DVec3::new(x, y, z), radius));
        let axis = end - start;
        let distance = axis.length();
        if distance <= (r0 - r1).abs() {
            return (None, if r0 >= r1 { [Some(first), None] } else { [None, Some(second)] });
        }
        // The sine of the angle between the side and the axis, and its cosine.
        let sine = (r0 - r1) / distance;
        let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt();
        let along = axis * (sine / distance);
        let [start, end] = [start + along * r0, end + along * r1].map(|place| place.to_array());
        let is_seen = distance * cosine > SHORTEST_SIDE * r0.max(r1);
        let side = Self { start, end, radii: [r0 * cosine, r1 * cosine], caps: Caps::None };
        (is_seen.then_some(side), [first, second].map(|sphere| (sphere[3] != 0.0).then_some(sphere)))
    }

    /// Checks that the cone is in range.
    ///
    /// # Errors
    /// Returns an error if a coordinate or radius is not finite or too large, if both radii are 0, or if the cone is too
    /// thin or too flat.
    pub fn check(&self) -> Result<(), ConeError> {
        self.check_within(1.0)
    }

    /// Checks that the cone is in range, whose limits are wider by a factor.
    fn check_within(&self, slack: f64) -> Result<(), ConeError> {
        let Self { start, end, radii, .. } = *self;
        let longest = slack * MAX_LENGTH;
        for (name, place) in [("start", start), ("end", end)] {
            // `contains` is false for NaN.
            if !place.iter().all(|x| (-longest..=longest).contains(x)) {
                return Err(ConeError(format!(
                    "its {name} is {place:?}; every coordinate must be finite and at most {MAX_LENGTH:e} in size"
                )));
            }
        }
        let is_radius = |radius: &f64| *radius == 0.0 || (1.0 / longest..=longest).contains(radius);
        if let Some(radius) = radii.iter().find(|radius| !is_radius(radius)) {
            let range = format!("finite, and between {:e} and {MAX_LENGTH:e}, or 0 at a tip", 1.0 / MAX_LENGTH);
            return Err(ConeError(format!("its radius is {radius:?}; a radius must be {range}")));
        }
        let radius = radii[0].max(radii[1]);
        if radius == 0.0 {
            return Err(ConeError("both radii are 0; one of them must be larger".to_owned()));
        }
        let length = (DVec3::from(end) - DVec3::from(start)).length();
        if length == 0.0 {
            return Err(ConeError(format!("it has no length: start and end are both {start:?}")));
        }
        if length > slack * MOST_ASPECT * radius {
            return Err(ConeError(format!(
                "its length, {length:?}, is more than {MOST_ASPECT} times its radius, {radius:?}; make it thicker, or \
                 several shorter ones of it"
            )));
        }
        if radius > slack * MOST_ASPECT * length {
            return Err(ConeError(format!(
                "its radius, {radius:?}, is more than {MOST_ASPECT} times its length, {length:?}; make it longer"
            )));
        }
        Ok(())
    }

    /// A box around the cone.
    pub(super) fn bounds(&self) -> Bounds {
        let [start, end] = [self.start, self.end].map(DVec3::from);
        Bounds::of_sphere(start, self.radii[0]).union(Bounds::of_sphere(end, self.radii[1]))
    }

    /// The cone in a frame. An error if rounding leaves no length, or too little or too much for its radius.
    pub(super) fn in_frame(&self, origin: DVec3) -> Result<ConeInFrame, ConeError> {
        let [start, end] = [self.start, self.end].map(|place| (DVec3::from(place) - origin).as_vec3().to_array());
        let [is_first, is_second] = match self.caps {
            Caps::None => [false, false],
            Caps::First => [true, false],
            Caps::Second => [false, true],
            Caps::Both => [true, true],
        };
        let signed = |radius: f64, is_closed: bool| if is_closed { radius as f32 } else { -(radius as f32) };
        let [first_radius, second_radius] = [signed(self.radii[0], is_first), signed(self.radii[1], is_second)];
        let rounded = ConeInFrame { start, first_radius, end, second_radius };
        check_in_frame(&rounded).map_err(|ConeError(error)| {
            let origin = origin.to_array();
            ConeError(format!("after rounding to f32 in the scene's frame, whose origin is {origin:?}, {error}"))
        })?;
        Ok(rounded)
    }
}

/// Checks a cone of a frame. Its limits are wider, so that rounding alone does not push it out of range, except if it is
/// too small where it is.
pub(super) fn check_in_frame(cone: &ConeInFrame) -> Result<(), ConeError> {
    let [start, end] = cone.ends().map(|end| end.to_array());
    Cone::new(start, end, cone.radii()).check_within(IN_FRAME)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::math::unit;

    #[test]
    fn what_is_wrong_with_a_cone_is_said() {
        let good = Cone::cylinder([0.0; 3], [0.0, 0.0, 1.0], 0.5);
        assert_eq!(good.check(), Ok(()));
        for (cone, expected) in [
            (Cone { end: [0.0; 3], ..good }, "it has no length: start and end are both [0.0, 0.0, 0.0]"),
            (Cone { radii: [0.0; 2], ..good }, "both radii are 0"),
            (Cone { radii: [0.5, -1.0], ..good }, "its radius is -1.0; a radius must be finite"),
            (Cone { radii: [f64::NAN, 1.0], ..good }, "its radius is NaN"),
            (Cone { end: [f64::NAN, 0.0, 0.0], ..good }, "its end is [NaN, 0.0, 0.0]; every coordinate"),
            (Cone { start: [1e13, 0.0, 0.0], ..good }, "its start is [10000000000000.0"),
            (Cone { radii: [1e-5; 2], ..good }, "its length, 1.0, is more than 10000 times its radius, 1e-5; make"),
            (Cone { end: [0.0, 0.0, 1e-5], ..good }, "its radius, 0.5, is more than 10000 times its length"),
        ] {
            let error = cone.check().unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
        let far = Cone::cylinder([1e9, 0.0, 0.0], [1e9 + 1.0, 0.0, 0.0], 0.5);
        assert!(far.in_frame(DVec3::ZERO).is_err());
        assert!(far.in_frame(DVec3::new(1e9, 0.0, 0.0)).is_ok());
    }

    #[test]
    fn the_side_of_a_cone_with_round_ends_touches_its_spheres() {
        for [first, second] in [
            [[0.0, 0.0, 0.0, 0.5], [3.0, 0.0, 0.0, 0.5]],
            [[1.0, 2.0, 3.0, 1.0], [2.0, 4.0, 1.0, 0.25]],
            [[1.0, 2.0, 3.0, 0.25], [2.0, 4.0, 1.0, 1.0]],
            [[0.0, 0.0, 0.0, 2.0], [0.0, 1.1, 0.0, 1.0]],
            [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 2.0, 0.0]],
        ] {
            let (side, spheres) = Cone::rounded(first, second);
            let cone = side.unwrap();
            assert_eq!((cone.check(), cone.caps), (Ok(()), Caps::None));
            assert_eq!(spheres, [Some(first), (second[3] > 0.0).then_some(second)]);
            let [start, end] = [cone.start, cone.end].map(DVec3::from);
            let axis = unit(end - start).unwrap();
            let across = axis.any_orthonormal_vector();
            let slope = (cone.radii[0] - cone.radii[1]) / (end - start).length();
            let normal_of_side = unit(across + axis * slope).unwrap();
            for ([x, y, z, radius], middle, of_cone) in [(first, start, cone.radii[0]), (second, end, cone.radii[1])] {
                let from_center = middle + across * of_cone - DVec3::new(x, y, z);
                assert!((from_center.length() - radius).abs() < 1e-12, "the circle is on the sphere");
                assert!(from_center.distance(normal_of_side * radius) < 1e-12, "normals are equal there");
            }
        }
    }

    #[test]
    fn a_cone_with_round_ends_may_be_one_sphere_or_two() {
        let (big, inside) = ([0.0, 0.0, 0.0, 1.0], [0.5, 0.0, 0.0, 0.5]);
        assert_eq!(Cone::rounded(big, inside), (None, [Some(big), None]));
        assert_eq!(Cone::rounded(inside, big), (None, [None, Some(big)]));
        assert_eq!(Cone::rounded(big, big), (None, [Some(big), None]));
        let near = [0.0, 1e-4, 0.0, 1.0];
        assert_eq!(Cone::rounded(big, near), (None, [Some(big), Some(near)]));
    }
}
