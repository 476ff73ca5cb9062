// Twin of src/camera/pinhole.rs. `right` and `up` reach from the middle of the view plane to its
// edges; `forward` reaches from the eye to the middle of the view plane.

fn camera_ray(location: vec2f) -> Ray {
    let camera = frame.camera;
    let toward = location.x * camera.right + location.y * camera.up + camera.forward;
    return Ray(camera.origin, toward / sqrt(dot(toward, toward)));
}
