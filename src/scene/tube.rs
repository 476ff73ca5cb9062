//! Tubes through points, as rounded cones.

use glam::DVec3;

use super::cone::Cone;

/// A tube along a smooth curve through points. It consists of sides, each of which touches the spheres at its ends, so
/// that there is neither a gap nor an edge between two pieces. Nothing is checked.
///
/// ```
/// use pinhole::scene::tube::Tube;
///
/// let tube = Tube::through(&[[0.0, 0.0, 0.0, 0.2], [1.0, 0.0, 0.0, 0.1], [1.0, 1.0, 0.0, 0.2]]);
/// assert_eq!(tube.spheres.first(), Some(&[0.0, 0.0, 0.0, 0.2]));
/// assert!(tube.spheres.len() > 10 && tube.sides.len() < tube.spheres.len());
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tube {
    /// The spheres (x, y, z, radius) at both ends and between pieces, along the tube.
    pub spheres: Vec<[f64; 4]>,
    /// The sides between them, without caps.
    pub sides: Vec<Cone>,
}

/// The most by which normals turn between two pieces, in radians: 3 degrees.
const TURN: f64 = 0.052_36;

/// The most pieces between two points.
const MOST_PIECES: usize = 120;

/// The number of steps between two points with which the turn of normals is measured.
const STEPS: usize = 24;

impl Tube {
    /// The tube through points (x, y, z, radius). Between them it follows a centripetal Catmull-Rom curve (Yuksel,
    /// Schaefer and Keyser 2011, "Parameterization and Applications of Catmull-Rom Curves"), which has neither cusps nor
    /// loops between two points, and the radius goes smoothly from one to the other. If the last point is the first one,
    /// the tube is closed. Points in the place of the point before are left out.
    #[must_use]
    pub fn through(points: &[[f64; 4]]) -> Self {
        let mut path: Vec<(DVec3, f64)> = Vec::with_capacity(points.len());
        for &[x, y, z, radius] in points {
            let place = DVec3::new(x, y, z);
            if path.last().is_none_or(|(last, _)| *last != place) {
                path.push((place, radius));
            }
        }
        let (Some(first), Some(last)) = (path.first().copied(), path.last().copied()) else { return Self::default() };
        let is_closed = path.len() > 3 && first.0 == last.0;
        let sphere = |(place, radius): (DVec3, f64)| [place.x, place.y, place.z, radius];
        let mut tube = Self { spheres: vec![sphere(first)], sides: Vec::new() };
        for index in 1..path.len() {
            let (from, to) = (path[index - 1], path[index]);
            // Beyond an end, the curve goes on as it began.
            let before = match index.checked_sub(2) {
                Some(before) => path[before].0,
                None if is_closed => path[path.len() - 2].0,
                None => 2.0 * from.0 - to.0,
            };
            let after = match path.get(index + 1) {
                Some(after) => after.0,
                None if is_closed => path[1].0,
                None => 2.0 * to.0 - from.0,
            };
            let curve = Curve::new([before, from.0, to.0, after]);
            let at = |t: f64| (curve.at(t), from.1 + (to.1 - from.1) * t * t * (3.0 - 2.0 * t));
            for end in cuts(at).into_iter().map(at).chain([to]).map(sphere) {
                let begin = tube.spheres.last().copied().unwrap_or(end);
                tube.sides.extend(Cone::rounded(begin, end).0);
                tube.spheres.push(end);
            }
        }
        tube.spheres.retain(|sphere| sphere[3] != 0.0);
        tube
    }
}

/// The places, between 0 and 1, at which a curve is cut, so that normals turn equally little in all pieces: by the turns
/// of the curve, and of its sides against it.
fn cuts(at: impl Fn(f64) -> (DVec3, f64)) -> Vec<f64> {
    let places: Vec<(DVec3, f64)> = (0..=STEPS).map(|step| at(step as f64 / STEPS as f64)).collect();
    let steps: Vec<_> = places.windows(2).map(|pair| (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1)).collect();
    let slope = |(step, growth): &(DVec3, f64)| growth.atan2(step.length());
    let turn = |pair: &[(DVec3, f64)]| pair[0].0.angle_between(pair[1].0) + (slope(&pair[1]) - slope(&pair[0])).abs();
    let inner: Vec<f64> = steps.windows(2).map(turn).collect();
    // Half of the turn between two steps counts for each. At both ends it is taken to be as beside them.
    let beside = |step: usize| 0.5 * (inner[step.saturating_sub(1)] + inner[step.min(STEPS - 2)]);
    let turns: Vec<f64> = (0..STEPS).map(beside).collect();
    let whole: f64 = turns.iter().sum();
    let pieces = ((whole / TURN).ceil() as usize).clamp(1, MOST_PIECES);
    let (mut step, mut before) = (0, 0.0);
    let mut cut = |piece: usize| {
        let wanted = whole * piece as f64 / pieces as f64;
        while step < STEPS - 1 && before + turns[step] < wanted {
            before += turns[step];
            step += 1;
        }
        (step as f64 + ((wanted - before) / turns[step]).clamp(0.0, 1.0)) / STEPS as f64
    };
    (1..pieces).map(&mut cut).collect()
}

/// A piece of a centripetal Catmull-Rom curve: a cubic from the second of four points to the third.
struct Curve {
    ends: [DVec3; 2],
    /// The velocities at both ends.
    velocities: [DVec3; 2],
}

impl Curve {
    fn new([before, from, to, after]: [DVec3; 4]) -> Self {
        // The time between two points is the square root of their distance. The velocity at a point is that of the
        // parabola through it and its neighbours.
        let [s, t, u] = [from - before, to - from, after - to].map(|step| step.length().sqrt());
        let slope = |first: DVec3, a: f64, second: DVec3, b: f64| {
            let [first, second] = [first / a, second / b];
            (b * first + a * second) / (a + b)
        };
        let velocities = [slope(from - before, s, to - from, t), slope(to - from, t, after - to, u)].map(|v| v * t);
        Self { ends: [from, to], velocities }
    }

    /// Hermite's cubic.
    fn at(&self, t: f64) -> DVec3 {
        let ([from, to], [first, second]) = (self.ends, self.velocities);
        let rise = t * t * (3.0 - 2.0 * t);
        let back = 1.0 - t;
        from + rise * (to - from) + (t * back * back) * first - (t * t * back) * second
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place([x, y, z, _]: [f64; 4]) -> DVec3 {
        DVec3::new(x, y, z)
    }

    /// A helix is followed closely, and normals turn little from piece to piece, also where the radius changes.
    #[test]
    fn a_helix_is_smooth() {
        let at = |t: f64| [t.cos(), t.sin(), 0.2 * t, 0.2 + 0.1 * (3.0 * t).sin()];
        let points: Vec<[f64; 4]> = (0..40).map(|i| at(0.4 * f64::from(i))).collect();
        let tube = Tube::through(&points);
        assert!(points.iter().all(|point| tube.spheres.contains(point)));
        assert_eq!(tube.sides.len() + 1, tube.spheres.len());
        for sphere in &tube.spheres[20..tube.spheres.len() - 20] {
            let of_curve = place(at(sphere[2] / 0.2));
            assert!(place(*sphere).distance(of_curve) < 0.01, "{sphere:?}");
        }
        let axis = |side: &Cone| (DVec3::from(side.end) - DVec3::from(side.start)).normalize_or(DVec3::X);
        let slope = |side: &Cone| {
            let length = DVec3::from(side.end).distance(DVec3::from(side.start));
            ((side.radii[1] - side.radii[0]) / length).atan()
        };
        for pair in tube.sides.windows(2) {
            let turn = axis(&pair[0]).angle_between(axis(&pair[1])) + (slope(&pair[0]) - slope(&pair[1])).abs();
            assert!(turn < 2.0 * TURN, "{turn}");
        }
    }

    #[test]
    fn straight_tubes_have_few_pieces_and_closed_ones_no_seam() {
        let straight =
            Tube::through(&[[0.0, 0.0, 0.0, 0.1], [1.0, 0.0, 0.0, 0.1], [1.0, 0.0, 0.0, 0.3], [3.0, 0.0, 0.0, 0.1]]);
        assert_eq!((straight.spheres.len(), straight.sides.len()), (3, 2));
        let corners = [[1.0, 0.0, 0.0, 0.1], [0.0, 1.0, 0.0, 0.1], [-1.0, 0.0, 0.0, 0.1], [0.0, -1.0, 0.0, 0.1]];
        let ring = Tube::through(&[corners[0], corners[1], corners[2], corners[3], corners[0]]);
        let along = |side: &Cone| (DVec3::from(side.end) - DVec3::from(side.start)).normalize_or(DVec3::X);
        let [first, last] = [&ring.sides[0], &ring.sides[ring.sides.len() - 1]].map(along);
        assert!(first.angle_between(last) < 2.0 * TURN);
        assert_eq!(Tube::through(&[]), Tube::default());
        assert_eq!(Tube::through(&corners[..1]).spheres, [corners[0]]);
        // A tube with tips has no spheres there.
        let spindle = Tube::through(&[[0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.2], [2.0, 0.0, 0.0, 0.0]]);
        assert!(spindle.spheres.iter().all(|sphere| sphere[3] > 0.0));
        assert!(spindle.sides.iter().all(|side| side.check().is_ok()), "{:?}", spindle.sides);
    }
}
