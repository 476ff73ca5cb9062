//! Camera paths: the points that they pass through, the keys that they refuse, and their form in scene files.

use pinhole::camera::{
    CameraKey, CameraMotion, CameraPath, CameraPathError, KeyPlace, PathClock, PlaceOnPath, Viewpoint,
};
use pinhole::glam::DVec3;
use pinhole_figure::scene_file::{SceneFile, parse_camera_path};

fn at(time: f64, eye: [f64; 3], look_at: [f64; 3]) -> CameraKey {
    let place = KeyPlace::Point { eye: eye.into(), look_at: look_at.into(), up: None };
    CameraKey { time, place, fov_radians: None, zoom: None }
}

fn view(time: f64, text: &str, turn: f64) -> CameraKey {
    let place = KeyPlace::View { viewpoint: text.parse().unwrap(), turn };
    CameraKey { time, place, fov_radians: None, zoom: None }
}

fn path(keys: &[CameraKey]) -> Result<CameraPath, CameraPathError> {
    CameraPath::new(keys.to_vec(), PathClock::Frames, true)
}

fn motion(keys: &[CameraKey]) -> CameraMotion {
    path(keys).unwrap().motion(DVec3::Y).unwrap()
}

/// The eye, target and `up` direction at a time.
fn points(motion: &CameraMotion, time: f64) -> [DVec3; 3] {
    match motion.at(time).place {
        PlaceOnPath::Point { eye, look_at, up } => [eye, look_at, up],
        PlaceOnPath::View { direction, up } => [-direction, DVec3::ZERO, up],
    }
}

fn assert_near(a: DVec3, b: DVec3) {
    assert!((a - b).length() < 1e-9, "{a} {b}");
}

#[test]
fn a_motion_passes_through_its_keys_and_stands_still_outside() {
    let keys = [
        at(2.0, [0.0, 0.0, 9.0], [0.0; 3]),
        at(10.0, [7.0, 1.0, 3.0], [1.0, 0.0, 0.0]),
        at(11.0, [7.0, -4.0, -3.0], [2.0, 0.0, 0.0]),
    ];
    let motion = motion(&keys);
    for key in keys {
        let KeyPlace::Point { eye, look_at, .. } = key.place else { panic!() };
        let [found, target, _] = points(&motion, key.time);
        assert_eq!([found, target], [eye, look_at]);
    }
    assert_eq!(motion.at(-5.0), motion.at(2.0));
    assert_eq!(motion.at(99.0), motion.at(11.0));
    let step = 1e-6;
    for time in [2.0, 4.0, 10.0, 10.5, 11.0] {
        for i in 0..3 {
            let place = |time: f64| points(&motion, time)[i];
            let left = (place(time) - place(time - step)) / step;
            let right = (place(time + step) - place(time)) / step;
            assert!((left - right).length() < 1e-3, "{i} at {time}: {left} {right}");
        }
    }
}

#[test]
fn up_is_perpendicular_to_the_view_and_of_unit_length() {
    // From the front over the top to the side.
    let keys =
        [at(0.0, [0.0, 0.0, 9.0], [0.0; 3]), at(1.0, [0.0, 9.0, 0.0], [0.0; 3]), at(2.0, [9.0, 1.0, 0.0], [0.0; 3])];
    let motion = motion(&keys);
    let mut before = DVec3::Y;
    for step in 0..=200 {
        let [eye, look_at, up] = points(&motion, f64::from(step) * 0.01);
        assert!((up.length() - 1.0).abs() < 1e-12);
        assert!(up.dot((look_at - eye).normalize_or_zero()).abs() < 1e-12, "{step}");
        assert!((up - before).length() < 0.2, "{step}: {before} {up}");
        before = up;
    }
    assert_near(points(&motion, 1.0)[2], DVec3::NEG_Z);
}

#[test]
fn field_of_view_and_zoom_are_logarithmic_and_need_not_be_in_every_key() {
    let mut keys = [0.0, 1.0, 2.0].map(|time| at(time, [0.0, time, 9.0], [0.0; 3]));
    keys[0].fov_radians = Some(0.1);
    keys[2].fov_radians = Some(0.9);
    keys[1].zoom = Some(3.0);
    let motion = motion(&keys);
    for (time, expected) in [(0.0, 0.1), (1.0, 0.3), (2.0, 0.9)] {
        assert!((motion.at(time).fov_radians.unwrap() - expected).abs() < 1e-12, "{time}");
        assert!((motion.at(time).zoom.unwrap() - 3.0).abs() < 1e-12);
    }
}

#[test]
fn views_turn_as_often_as_they_say() {
    let up = DVec3::new(0.0, 0.0, 2.0);
    let keys = vec![view(0.0, "0,30", 0.0), view(8.0, "0,30", 720.0)];
    let motion = CameraPath::new(keys, PathClock::Frames, false).unwrap().motion(up).unwrap();
    for step in 0..=8 {
        let PlaceOnPath::View { direction, up } = motion.at(f64::from(step)).place else { panic!() };
        let expected = Viewpoint::Angles { azimuth: 90.0 * f64::from(step), elevation: 30.0 };
        let [expected, _] = expected.axes(DVec3::Z, 0.0);
        assert_near(direction, expected);
        assert!(direction.dot(up).abs() < 1e-12 && up.z > 0.8);
    }
}

/// For any `up` direction, a view of a key is that of `--view`, and named axes are those of the world.
#[test]
fn views_are_those_of_viewpoints() {
    for up in [DVec3::Y, DVec3::Z, DVec3::new(1.0, 2.0, -0.5).normalize_or_zero()] {
        for text in ["x", "-x", "y", "-y", "z", "-z", "iso", "30,20", "10,-90"] {
            let keys = vec![view(0.0, text, 25.0), view(1.0, "0,0", 0.0)];
            let path = CameraPath::new(keys, PathClock::Frames, true).unwrap();
            let PlaceOnPath::View { direction, up: found } = path.motion(up).unwrap().at(0.0).place else { panic!() };
            let [expected, upward] = text.parse::<Viewpoint>().unwrap().axes(up, 25.0);
            assert_near(direction, expected);
            let upward = (upward - upward.dot(direction) * direction).normalize_or_zero();
            assert_near(found, upward);
        }
    }
}

#[test]
fn what_is_no_path_is_refused() {
    let [a, b] = [at(0.0, [0.0, 0.0, 9.0], [0.0; 3]), at(1.0, [9.0, 0.0, 0.0], [0.0; 3])];
    let refused = |keys: &[CameraKey], key: Option<usize>, words: &str| {
        let error = path(keys).unwrap_err();
        assert_eq!(error.key, key);
        assert!(error.message.contains(words), "{error}");
    };
    refused(&[], None, "needs at least two keys, but there is none");
    refused(&[a], None, "needs at least two keys, but there is only one");
    refused(&[a, CameraKey { time: 0.0, ..b }], Some(1), "key 1 is at 0.0, which is not later than");
    let inside = at(1.0, [3.0; 3], [3.0; 3]);
    refused(&[a, inside], Some(1), "the eye and the look-at point are both at [3.0, 3.0, 3.0]; move one of them");
    refused(&[a, view(1.0, "x", 0.0)], Some(1), "some keys have an eye and others a view");
    for key in [
        CameraKey { time: f64::NAN, ..b },
        CameraKey { time: f64::INFINITY, ..b },
        CameraKey { zoom: Some(0.0), ..b },
        CameraKey { zoom: Some(f64::NAN), ..b },
        CameraKey { fov_radians: Some(4.0), ..b },
        CameraKey { fov_radians: Some(f64::NAN), ..b },
        at(1.0, [f64::NAN, 0.0, 0.0], [0.0; 3]),
        at(1.0, [0.0; 3], [0.0, f64::INFINITY, 0.0]),
    ] {
        let error = path(&[a, key]).unwrap_err();
        assert_eq!(error.key, Some(1), "{error}");
    }
    assert!(path(&[view(0.0, "x", 0.0), view(1.0, "x", f64::INFINITY)]).is_err());
    let with_up = |key: CameraKey, up: DVec3| {
        let KeyPlace::Point { eye, look_at, .. } = key.place else { panic!() };
        CameraKey { place: KeyPlace::Point { eye, look_at, up: Some(up) }, ..key }
    };
    refused(&[a, with_up(b, DVec3::X)], Some(1), "is parallel to the direction of view");
    let rolled = path(&[a, with_up(b, DVec3::NEG_Y)]).unwrap();
    let error = rolled.motion(DVec3::Y).unwrap_err();
    assert_eq!(error.key, Some(1));
    assert!(error.message.contains("is opposite to that of key 0"), "{error}");
    assert!(rolled.motion(DVec3::X).is_ok());
}

#[test]
fn files_and_scenes_give_the_same_path() {
    let keys = "keys = [\n  { time = 0, eye = [0, 0, 9], look_at = [0, 0, 0], vertical_fov = 40 },\n  \
                { time = 2.5, eye = [9, 0, 0], look_at = [0, 0, 1], up = [0, 1, 1], zoom = 2 },\n]\n";
    let of_file = parse_camera_path(&format!("ease = false\n{keys}")).unwrap();
    let scene = SceneFile::parse(&format!("[camera_path]\nease = false\n{keys}")).unwrap();
    assert_eq!(scene.camera_path(), Some(&of_file));
    assert!(!of_file.eases() && of_file.clock() == PathClock::Seconds && of_file.end() == 2.5);
    assert_eq!(of_file.keys()[0].fov_radians, Some(40_f64.to_radians()));
    assert_eq!(of_file.keys()[1].zoom, Some(2.0));
    assert_eq!(SceneFile::parse("").unwrap().camera_path(), None);
}

/// Errors of scene files are in `tests/files/refused/scene_files.txt`.
#[test]
fn errors_of_files_have_a_place() {
    let error = parse_camera_path("[[keys]]\nframe = 0\nview = 'z'\n[camera]\n").unwrap_err();
    assert_eq!((error.line, error.column), (4, 2), "{error}");
    assert!(error.message.contains("unknown key `camera`"), "{error}");
    let none = parse_camera_path("").unwrap_err();
    assert!(none.message.contains("there is none"), "{none}");
    let error = SceneFile::parse("[camera_path]\nkeys = [{ frame = 1 }]").unwrap_err();
    assert_eq!((error.line, error.column), (2, 9), "{error}");
}
