// Twin of src/camera/thin_lens.rs. `right` and `up` reach from the middle of the plane of focus to its edges;
// `forward` reaches from the lens's centre to that middle. `first` and `second` are the lens's radius in lengths of
// `right` and `up`.
// provides: camera_ray
// needs: CameraRay, Ray, concentric_disk, fence, fence3, frame

fn camera_ray(location: vec2f, lens: vec2f) -> CameraRay {
    let camera = frame.camera;
    let on_lens = concentric_disk(lens) * vec2f(camera.first, camera.second);
    let offset = fence3(on_lens.x * camera.right + on_lens.y * camera.up);
    let aside = fence3(location.x * camera.right + location.y * camera.up);
    let toward = fence3(aside + camera.forward - offset);
    let length = sqrt(dot(toward, toward));
    // From the lens at its offset to the plane of focus at its location, in one step of `advance`.
    let along = fence3(camera.advance * aside) + fence3(fence(1.0 - camera.advance) * offset);
    let ray = Ray(fence3(camera.origin + along), fence3(toward * (1.0 / length)));
    return CameraRay(ray, camera.advance * length, true);
}
