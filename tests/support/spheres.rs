//! Scenes in which a structure may lose spheres: equal, nested, flat, aligned with cells, far away, or of uneven size
//! and density.

use fastrand::Rng;

/// Centre and radius of each sphere, in the scene's frame.
pub(crate) type Spheres = Vec<[f32; 4]>;

/// Spheres at random positions in the unit cube.
pub(crate) fn random(count: usize, seed: u64, radius: impl Fn(&mut Rng) -> f32) -> Spheres {
    let mut rng = Rng::with_seed(seed);
    (0..count).map(|_| [rng.f32(), rng.f32(), rng.f32(), radius(&mut rng)]).collect()
}

/// The same spheres with coordinates and radii times a factor.
pub(crate) fn scaled(spheres: &Spheres, factor: f32) -> Spheres {
    spheres.iter().map(|sphere| sphere.map(|x| x * factor)).collect()
}

/// Spheres with radii from 0.3 down to 0.00003.
pub(crate) fn four_decades(count: usize) -> Spheres {
    random(count, 4, |rng| 10_f32.powf(-4.0 * rng.f32() - 0.5))
}

pub(crate) fn coincident(count: usize) -> Spheres {
    vec![[0.0, 0.0, 0.0, 1.0]; count]
}

/// Spheres with one centre and many radii.
pub(crate) fn concentric(count: usize) -> Spheres {
    (0..count).map(|i| [7.0, 7.0, 7.0, 1.0 + i as f32 * 1e-3]).collect()
}

/// Equal pairs of spheres, so that every answer is a tie.
pub(crate) fn twice(count: usize) -> Spheres {
    let mut spheres = random(count, 5, |_| 0.03);
    spheres.extend_from_within(..);
    spheres
}

/// Pairs of spheres that are mirror images in the plane y = 0. A ray in that plane meets both at the same distance. On
/// its way to the large ones, it crosses cells that list only one of the two. Either has the smaller id.
pub(crate) fn mirrored(pairs: usize) -> Spheres {
    let mut rng = Rng::with_seed(16);
    let pairs = (0..pairs).flat_map(|i| {
        let (x, z, side) = (rng.f32(), rng.f32(), if rng.bool() { 1.0 } else { -1.0 });
        // Small spheres beside the plane make the cells small.
        let (y, radius) = if i % 32 == 0 { (0.08, 0.1) } else { (0.2 + 0.2 * rng.f32(), 0.005) };
        [[x, side * y, z, radius], [x, -side * y, z, radius]]
    });
    pairs.collect()
}

/// A sheet of spheres far behind a single sphere. Its boxes are thin beside their distance.
pub(crate) fn distant_sheet(count: usize) -> Spheres {
    let sheet = random(count, 17, |_| 0.05).into_iter();
    let mut spheres: Spheres = sheet.map(|[x, y, _, r]| [x * 40.0, y * 40.0, 0.0, r]).collect();
    spheres.push([20.0, 20.0, 120.0, 1.0]);
    spheres
}

/// Spheres with one centre, and radii so close together that no structure can separate them.
pub(crate) fn nearly_coincident(count: usize) -> Spheres {
    (0..count).map(|i| [0.0, 0.0, 0.0, 1.0 + i as f32 * f32::EPSILON]).collect()
}

/// Spheres in a row. Each touches the next.
pub(crate) fn line(count: usize) -> Spheres {
    (0..count).map(|i| [i as f32, 0.0, 0.0, 0.5]).collect()
}

/// Nested spheres. Each is inside the next.
pub(crate) fn nested(count: usize) -> Spheres {
    (0..count).map(|i| [i as f32 * 1e-3, 0.0, 0.0, 1.0 + i as f32]).collect()
}

/// Spheres along a line. Each is larger and farther away by the same factor.
pub(crate) fn geometric(count: i32) -> Spheres {
    (0..count).map(|i| [1.03_f32.powi(i), 0.0, 0.0, 0.01 * 1.03_f32.powi(i)]).collect()
}

/// A face-centred cubic lattice of touching spheres with integer centres.
pub(crate) fn lattice(side: usize) -> Spheres {
    (0..side * side * side)
        .filter_map(|i| {
            let [x, y, z] = [i % side, i / side % side, i / (side * side)];
            let radius = std::f32::consts::FRAC_1_SQRT_2;
            ((x + y + z) % 2 == 0).then_some([x as f32, y as f32, z as f32, radius])
        })
        .collect()
}

/// A huge sphere around many small ones.
pub(crate) fn one_around_all(count: usize) -> Spheres {
    let mut around = random(count, 6, |_| 0.005);
    around.insert(count / 3, [0.5, 0.5, 0.5, 3.0]);
    around
}

/// Dense clusters in a few places, with sizes from 1 to 0.001.
pub(crate) fn clusters(count: usize, each: usize) -> Spheres {
    let mut rng = Rng::with_seed(8);
    (0..count)
        .flat_map(|_| {
            let center = [rng.f32() * 100.0, rng.f32() * 100.0, rng.f32() * 100.0];
            let size = 10_f32.powf(-3.0 * rng.f32());
            let near = random(each, rng.u64(..), |_| 0.05);
            near.into_iter().map(move |[x, y, z, radius]| {
                let [a, b, c] = center;
                [a + x * size, b + y * size, c + z * size, radius * size]
            })
        })
        .collect()
}

/// Spheres with coordinates about 10⁷, where neighbours in f32 are 1 apart, and radii of 10⁻².
pub(crate) fn far(count: usize) -> Spheres {
    scaled(&random(count, 9, |_| 1e-9), 1e7)
}

/// Spheres whose centres all lie in one plane.
pub(crate) fn flat(count: usize) -> Spheres {
    random(count, 11, |_| 0.004).into_iter().map(|[x, y, _, r]| [x, y, 0.25, r]).collect()
}

/// Spheres whose centres all lie on one line, far apart.
pub(crate) fn needle(count: usize) -> Spheres {
    random(count, 12, |_| 1e-4).into_iter().map(|[x, _, _, r]| [0.5, 0.5, x, r]).collect()
}

/// Many spheres in a small place, and a huge one far away.
pub(crate) fn outlier(count: usize) -> Spheres {
    let mut spheres = random(count, 13, |_| 0.02);
    spheres.push([3e4, -2e4, 1e4, 2e3]);
    spheres
}

/// A crowd in a corner of a nearly empty box. It gives grids inside cells, and long ways through empty cells.
pub(crate) fn crowd(count: usize) -> Spheres {
    let mut spheres = random(count, 14, |_| 0.02);
    for sphere in &mut spheres {
        *sphere = sphere.map(|x| x * 0.2);
    }
    spheres.extend(random(count / 20, 15, |_| 0.01));
    spheres
}

/// A crowd in the unit cube, with some outliers in the list of its spheres, at up to `far` times its size. They are far
/// along only one axis if `is_in_line`.
pub(crate) fn crowd_and_outliers(count: usize, outliers: usize, far: f32, is_in_line: bool) -> Spheres {
    let mut spheres = random(count, 28, |rng| 0.02 * (0.2 + rng.f32()));
    let mut rng = Rng::with_seed(29);
    for i in 0..outliers {
        let mut place = [(); 3].map(|()| far * (rng.f32() - 0.5));
        place[i % 3] = if rng.bool() { far } else { -far };
        if is_in_line {
            place = [far * (0.5 + rng.f32()), 0.5, 0.5];
        }
        let [x, y, z] = place;
        // Most outliers are as small as the others. Some are as large as the crowd, or larger.
        let radius = if i % 8 == 7 { 0.05 * far } else { 0.02 };
        spheres.insert(rng.usize(..=spheres.len()), [x, y, z, radius]);
    }
    spheres
}
