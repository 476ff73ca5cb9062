//! Small views for the checker. Each contains something that makes one kind of fault visible.

use pinhole::camera::{
    Camera, FisheyeCamera, OrthographicCamera, PanoramaCamera, PinholeCamera, Pose, ThinLensCamera,
};
use pinhole::{Appearance, Film, LinearRgb, Scene, Shading, Sphere, SphereArray};

use crate::support::spheres;
use crate::support::{View, shaded};

/// Makes a view.
type Make = fn() -> View;

pub(crate) const ALL: &[(&str, Make)] = &[
    ("balls", balls),
    ("own_colors", own_colors),
    ("parallel", parallel),
    ("lens", lens),
    ("around", around),
    ("disk", disk),
    ("inside", inside),
    ("behind", behind),
    ("lattice", lattice),
    ("clusters", clusters),
    ("far_clusters", far_clusters),
    ("copies", copies),
    ("two_tiles", two_tiles),
];

fn colored(center: [f64; 3], radius: f64, i: usize) -> Sphere {
    let level = |k: usize| ((i * k) % 17 + 1) as f32 / 18.0;
    let color = LinearRgb::new([level(3), level(5), level(7)]).unwrap();
    Sphere::new(center, radius, color)
}

fn view(spheres: &[Sphere], camera: impl Camera + 'static, size: [u32; 2]) -> View {
    let background = LinearRgb::new([0.25, 0.5, 0.75]).unwrap();
    View {
        scene: Scene::new(spheres).unwrap(),
        camera: Box::new(camera),
        film: Film::new(size[0], size[1]).unwrap(),
        settings: shaded(Shading::Headlight, background),
    }
}

fn pose(eye: [f64; 3], look_at: [f64; 3]) -> Pose {
    Pose::looking_at(eye, look_at, [0.1, 1.0, 0.2]).unwrap()
}

fn pinhole(eye: [f64; 3], look_at: [f64; 3], degrees: f64) -> PinholeCamera {
    PinholeCamera::with_vertical_fov(pose(eye, look_at), f64::to_radians(degrees), 1.2).unwrap()
}

fn random(count: usize, seed: u64) -> Vec<Sphere> {
    let mut random = fastrand::Rng::with_seed(seed);
    (0..count)
        .map(|i| {
            let center = [0; 3].map(|_| random.f64() * 4.0 - 2.0);
            colored(center, 0.08 + 0.1 * random.f64(), i)
        })
        .collect()
}

/// Spheres in several colours, seen from outside, with background around them.
pub(crate) fn balls() -> View {
    view(&random(400, 31), pinhole([3.0, 2.0, 6.0], [0.1, 0.2, 0.3], 44.0), [96, 80])
}

/// Spheres with individual colours.
pub(crate) fn own_colors() -> View {
    let view = balls();
    let colors = (0..view.scene.len()).map(|i| [i as u8, (i / 2) as u8, (i / 3) as u8, 255]);
    let appearance = Appearance::from(colors.collect::<Vec<_>>());
    let spheres = SphereArray::F32(view.scene.spheres().to_vec());
    View { scene: Scene::from_parts(spheres, appearance).unwrap(), ..view }
}

pub(crate) fn parallel() -> View {
    let camera =
        OrthographicCamera::new(pose([3.0, 2.0, 6.0], [0.1, 0.2, 0.3]), [3.4, 2.8]).unwrap();
    view(&random(400, 31), camera, [96, 80])
}

/// A view through a lens. Recordings use rays through the centre of the lens.
pub(crate) fn lens() -> View {
    let pinhole = pinhole([3.0, 2.0, 6.0], [0.1, 0.2, 0.3], 44.0);
    view(&random(400, 31), ThinLensCamera::new(pinhole, 0.3, 5.0).unwrap(), [96, 80])
}

/// A stereo view from the middle, for the right eye.
pub(crate) fn around() -> View {
    let pose = pose([0.1, 0.2, 0.3], [3.0, 2.0, 6.0]);
    let [_, right] = PanoramaCamera::new(pose).stereo_pair(0.1, 1.0).unwrap();
    view(&random(400, 31), right, [96, 48])
}

/// A view from the middle in most directions, in which no ray misses.
pub(crate) fn disk() -> View {
    let mut spheres = random(400, 31);
    spheres.push(colored([0.0; 3], 5.0, 3));
    let pose = pose([0.1, 0.2, 0.3], [3.0, 2.0, 6.0]);
    let camera = FisheyeCamera::new(pose, 5.0, 1.2).unwrap();
    view(&spheres, camera, [96, 80])
}

/// A view from inside a large sphere, with others inside and around it.
pub(crate) fn inside() -> View {
    let mut spheres = random(60, 32);
    spheres.push(colored([0.0; 3], 5.0, 3));
    view(&spheres, pinhole([0.5, 1.0, 3.9], [0.0; 3], 90.0), [96, 80])
}

/// Spheres all around the eye, most of them behind it.
pub(crate) fn behind() -> View {
    view(&random(100, 33), pinhole([0.0, 0.0, 1.6], [0.0, 0.0, 4.0], 60.0), [96, 80])
}

/// Spheres that fill all cells of a grid equally and extend into neighbouring cells.
pub(crate) fn lattice() -> View {
    let spheres: Vec<Sphere> = spheres::lattice(12)
        .iter()
        .enumerate()
        .map(|(i, [x, y, z, r])| {
            let radius = f64::from(*r) * (0.2 + 0.3 * (i % 5) as f64);
            colored([*x, *y, *z].map(f64::from), radius, i)
        })
        .collect();
    view(&spheres, pinhole([-9.0, 15.0, -12.0], [5.0, 5.0, 5.0], 40.0), [96, 80])
}

fn in_clusters() -> Vec<Sphere> {
    let mut random = fastrand::Rng::with_seed(34);
    (0..12)
        .flat_map(|_| {
            let center = [0; 3].map(|_| random.f64() * 4.0 - 2.0);
            let size = 10_f64.powf(-2.0 * random.f64());
            (0..120)
                .map(|i| {
                    let near = center.map(|x| x + (random.f64() - 0.5) * size);
                    colored(near, size * 0.08 * (0.2 + random.f64()), i)
                })
                .collect::<Vec<_>>()
        })
        .collect()
}

/// Spheres that form a few dense clusters.
pub(crate) fn clusters() -> View {
    view(&in_clusters(), pinhole([3.0, 2.0, 6.0], [0.1, 0.2, 0.3], 44.0), [96, 80])
}

/// The same spheres, but small in a large box.
pub(crate) fn far_clusters() -> View {
    let mut spheres = in_clusters();
    spheres.push(colored([40.0, 60.0, 120.0], 0.5, 5));
    view(&spheres, pinhole([63.0, 42.0, 126.0], [0.0; 3], 1.8), [96, 80])
}

/// Eight copies of each sphere, in shuffled order.
pub(crate) fn copies() -> View {
    let mut random = fastrand::Rng::with_seed(35);
    let mut places: Vec<usize> = (0..40 * 8).map(|i| i % 40).collect();
    random.shuffle(&mut places);
    let spheres: Vec<Sphere> = places
        .into_iter()
        .enumerate()
        .map(|(i, place)| {
            let center = [(place % 8) as f64 - 3.5, (place / 8) as f64 - 2.0, 0.0];
            colored(center, 0.45, i)
        })
        .collect();
    view(&spheres, pinhole([1.0, 2.0, 9.0], [0.0; 3], 40.0), [96, 80])
}

/// A picture that is larger than one tile.
pub(crate) fn two_tiles() -> View {
    let spheres = [colored([-1.0, 0.0, 0.0], 0.9, 1), colored([1.0, 0.0, 0.0], 0.9, 2)];
    view(&spheres, pinhole([0.0, 0.5, 5.0], [0.0; 3], 16.0), [1100, 1000])
}
