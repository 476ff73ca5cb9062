//! Moves a camera with the pointer.

use pinhole::glam::{DQuat, DVec3};
use pinhole_cli::viewing::ViewCamera;

/// The number of full turns when the pointer moves by one height of the picture.
const TURNS_PER_HEIGHT: f64 = 0.5;

/// The change of the distance by one step of the wheel, as a power of e.
const ZOOM_PER_POINT: f64 = 0.003;

/// A camera, and the point around which it turns.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Orbit {
    pub(crate) camera: ViewCamera,
    pub(crate) pivot: DVec3,
    /// The least distance of the camera from the pivot.
    least: f64,
}

impl Orbit {
    /// Sets the pivot to the point at which the camera looks, or else to the point in front of it at the depth of
    /// `center`. `size` is the length of the scene.
    pub(crate) fn new(camera: ViewCamera, center: DVec3, size: f64) -> Self {
        let (eye, direction) = (camera.eye(), camera.direction());
        let depth = (center - eye).dot(direction);
        let depth = if depth > 1e-3 * size { depth } else { 0.5 * size.max(1e-6) };
        let pivot = camera.look_at().unwrap_or(eye + depth * direction);
        Self { camera, pivot, least: 1e-4 * size.max(1e-9) }
    }

    fn distance(&self) -> f64 {
        self.camera.eye().distance(self.pivot)
    }

    fn right(&self) -> DVec3 {
        self.camera.direction().cross(self.camera.up())
    }

    /// Turns the scene under the pointer, which moved to the right and down by fractions of the picture's height.
    pub(crate) fn turn(&mut self, [x, y]: [f64; 2]) {
        let angle = |part: f64| -part * TURNS_PER_HEIGHT * std::f64::consts::TAU;
        let (up, right) = (self.camera.up(), self.right());
        let turn = DQuat::from_axis_angle(up, angle(x)) * DQuat::from_axis_angle(right, angle(y));
        let eye = self.pivot + turn * (self.camera.eye() - self.pivot);
        self.camera.set_place(eye, self.pivot, turn * up);
    }

    /// Turns the picture about its middle, counter-clockwise, by an angle in radians.
    pub(crate) fn roll(&mut self, angle: f64) {
        let turn = DQuat::from_axis_angle(self.camera.direction(), angle);
        self.camera.set_place(self.camera.eye(), self.pivot, turn * self.camera.up());
    }

    /// Moves the camera so that points at the depth of the pivot follow the pointer. `height` is the height of the
    /// picture at that depth, in scene units.
    pub(crate) fn pan(&mut self, [x, y]: [f64; 2], height: f64) {
        let by = height * (y * self.camera.up() - x * self.right());
        self.move_to(self.pivot + by);
    }

    /// Makes the camera look at a point from the same direction.
    pub(crate) fn move_to(&mut self, pivot: DVec3) {
        let eye = self.camera.eye() + (pivot - self.pivot);
        self.pivot = pivot;
        self.camera.set_place(eye, pivot, self.camera.up());
    }

    /// Moves nearer by steps of the wheel.
    pub(crate) fn zoom(&mut self, steps: f64) {
        let factor = (-ZOOM_PER_POINT * steps).clamp(-1.0, 1.0).exp();
        if self.camera.is_orthographic() {
            let (eye, up) = (self.camera.eye(), self.camera.up());
            self.camera.set_place(eye, self.pivot, up);
            self.camera.enlarge(1.0 / factor);
            return;
        }
        let away = self.camera.eye() - self.pivot;
        let distance = (self.distance() * factor).max(self.least);
        let eye = self.pivot + distance * away.normalize_or(-self.camera.direction());
        self.camera.set_place(eye, self.pivot, self.camera.up());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pinhole::camera::{Camera, CameraParameters};
    use pinhole::geometry::bounds::Bounds;
    use pinhole_cli::viewing::RenderFlags;

    fn camera_of(camera: &ViewCamera) -> Box<dyn Camera> {
        let subject = &Bounds::of_sphere(DVec3::ZERO, 1.0).into();
        camera.parameters().unwrap().camera(1.0, subject).unwrap()
    }

    fn orbit() -> Orbit {
        let subject = &Bounds::of_sphere(DVec3::ZERO, 5.0).into();
        let placed = CameraParameters::default().placed(1.0, subject).unwrap();
        Orbit::new(ViewCamera::new(&placed).unwrap(), DVec3::ZERO, 10.0)
    }

    #[test]
    fn turning_keeps_the_distance_and_the_middle() {
        let mut orbit = orbit();
        let distance = orbit.distance();
        for step in 0..50 {
            orbit.turn([0.03 * f64::from(step % 7), -0.02]);
            assert!((orbit.distance() - distance).abs() < 1e-3 * distance);
            let middle = camera_of(&orbit.camera).location_of(orbit.pivot).unwrap();
            assert!(middle.length() < 1e-5, "{middle}");
        }
    }

    #[test]
    fn the_pointer_takes_things_along() {
        // The side that faces the camera moves to the right and down with the pointer.
        let mut turned = orbit();
        let front = 5.0 * -turned.camera.direction();
        turned.turn([0.05, 0.05]);
        let at = camera_of(&turned.camera).location_of(front).unwrap();
        assert!(at.x > 0.01 && at.y < -0.01, "{at}");

        // The pivot follows the pointer exactly: 0.1 of the height is 0.2 in relative locations.
        let mut moved = orbit();
        let vectors = camera_of(&moved.camera).vectors();
        let height = 2.0 * moved.distance() * vectors.up.length() / vectors.forward.length();
        moved.pan([0.1, 0.1], height);
        let at = camera_of(&moved.camera).location_of(DVec3::ZERO).unwrap();
        assert!((at.x - 0.2).abs() < 1e-4 && (at.y + 0.2).abs() < 1e-4, "{at}");
    }

    #[test]
    fn zooming_in_and_out_comes_back() {
        let mut zoomed = orbit();
        let before = zoomed.distance();
        zoomed.zoom(100.0);
        assert!(zoomed.distance() < before);
        zoomed.zoom(-100.0);
        assert!((zoomed.distance() - before).abs() < 1e-4 * before);
        for _ in 0..1000 {
            zoomed.zoom(300.0);
        }
        assert!(zoomed.distance() > 0.0 && camera_of(&zoomed.camera).vectors().origin.is_finite());
    }

    /// The flags give the same view again after any motion, because the flags are the state.
    #[test]
    fn motions_survive_the_flags() {
        let mut orbit = orbit();
        let mut flags = RenderFlags::parse(["a.pdb", "--style", "path"]).unwrap();
        for step in 0..20 {
            orbit.turn([0.013, 0.007]);
            orbit.pan([0.01, -0.02], 3.0);
            orbit.zoom(f64::from(step));
            orbit.roll(0.01);
            orbit.camera.write_to(&mut flags);
            let read = RenderFlags::parse(flags.words()).unwrap();
            let sorted = |flags: &RenderFlags| {
                let mut words = flags.words();
                words.sort();
                words
            };
            assert_eq!(sorted(&read), sorted(&flags));
            let again = read.camera().unwrap().expect("the flags have a place");
            assert_eq!(again, orbit.camera);
            assert_eq!(Orbit::new(again, DVec3::ZERO, 10.0).pivot, orbit.camera.look_at().unwrap());
        }
    }
}
