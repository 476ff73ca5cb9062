//! The sphereflake of Eric Haines' Standard Procedural Databases.
//!
//! E. Haines, "A proposal for standard graphics environments", IEEE Computer Graphics and Applications 7(11), 1987; the
//! directions of the children are those of its program `balls`. Two things differ: the first sphere is in the middle of
//! the unit cube and has the radius ¼, so that the whole flake, which extends to twice its radius, fits into the cube;
//! and spheres are in breadth-first order.

use glam::DVec3;

/// The number of children of every sphere: sphere i has the children 9·i + 1 to 9·i + 9.
const CHILDREN: u64 = 9;

/// The radius of a child relative to its parent.
const SCALE: f64 = 1.0 / 3.0;

/// The generator of a sphereflake of any number of spheres.
pub(super) struct Sphereflake {
    /// Directions of the children from a parent whose axis is z.
    directions: [DVec3; CHILDREN as usize],
}

impl Sphereflake {
    pub(super) fn new() -> Self {
        Self { directions: std::array::from_fn(direction) }
    }

    /// Centre and radius of the i-th sphere.
    pub(super) fn sphere(&self, i: u64) -> [f64; 4] {
        // The child to choose at each level, from the last level to the first; 2⁶⁴ spheres have fewer than 24 levels.
        let mut path = [0_usize; 24];
        let mut depth = 0;
        let mut sphere = i;
        while sphere > 0 {
            path[depth] = ((sphere - 1) % CHILDREN) as usize;
            sphere = (sphere - 1) / CHILDREN;
            depth += 1;
        }
        let (mut center, mut radius, mut axis) = (DVec3::splat(0.5), 0.25, DVec3::Z);
        for &child in path[..depth].iter().rev() {
            axis = turned(self.directions[child], axis);
            center += axis * (radius * (1.0 + SCALE));
            radius *= SCALE;
        }
        [center.x, center.y, center.z, radius]
    }
}

/// Direction of a child from a parent whose axis is z: three groups of three, a third of a turn apart.
fn direction(child: usize) -> DVec3 {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let corner =
        [DVec3::new(half, half, 0.0), DVec3::new(half, 0.0, -half), DVec3::new(0.0, half, -half)]
            [child % 3];
    // Rotation about (1, −1, 0)/√2 by the angle whose sine is 2/√6, which makes the middle of the group horizontal.
    let about = DVec3::new(half, -half, 0.0);
    let (sine, cosine) = ((2.0_f64 / 3.0).sqrt(), (1.0_f64 / 3.0).sqrt());
    let v =
        corner * cosine + about.cross(corner) * sine + about * (about.dot(corner) * (1.0 - cosine));
    // Rotation about z by 0, 1/3 or 2/3 of a turn.
    let root = 0.75_f64.sqrt();
    let (sine, cosine) = [(0.0, 1.0), (root, -0.5), (-root, -0.5)][child / 3];
    DVec3::new(v.x * cosine - v.y * sine, v.x * sine + v.y * cosine, v.z)
}

/// Applies the rotation that takes z to `axis` by the shortest way to a vector.
fn turned(v: DVec3, axis: DVec3) -> DVec3 {
    if axis.z <= -1.0 {
        return DVec3::new(-v.x, v.y, -v.z);
    }
    // Rodrigues' formula; the length of `about` is the sine.
    let about = DVec3::Z.cross(axis);
    v * axis.z + about.cross(v) + about * (about.dot(v) / (1.0 + axis.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn children_touch_their_parent_and_lie_outside_it() {
        let flake = Sphereflake::new();
        for i in 1..9_u64.pow(5) {
            let [child, parent] = [i, (i - 1) / CHILDREN].map(|i| flake.sphere(i));
            let center = |s: [f64; 4]| DVec3::new(s[0], s[1], s[2]);
            let gap = (center(child) - center(parent)).length() - child[3] - parent[3];
            assert!(gap.abs() < 1e-9, "{i}: {gap}");
            assert!(child.iter().all(|x| (0.0..=1.0).contains(x)), "{child:?}");
        }
    }

    /// Six children lie around the equator and three above it.
    #[test]
    fn nine_directions() {
        let height = |child| direction(child).z;
        let on_equator = (0..9).filter(|child| height(*child).abs() < 1e-12).count();
        let above = (0..9).filter(|child| height(*child) > 0.5).count();
        assert_eq!((on_equator, above), (6, 3));
    }
}
