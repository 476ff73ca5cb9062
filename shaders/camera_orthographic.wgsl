// Twin of src/camera/orthographic.rs. `right` and `up` reach from the middle of the view plane to
// its edges; `forward` is the unit direction of every ray.

fn camera_ray(location: vec2f) -> Ray {
    let camera = frame.camera;
    return Ray(camera.origin + location.x * camera.right + location.y * camera.up, camera.forward);
}
