// Rays of the thin-lens camera. Twin: src/camera/thin_lens.rs.
//
// `right` and `up` are the vectors from the centre of the plane of focus to its edges. `forward` is the vector from the
// centre of the lens to the centre of that plane. `first` and `second` are the radius of the lens, divided by the
// lengths of `right` and `up`.
// provides: thin_lens_ray
// needs: CameraRay, Ray, concentric_disk, fence, fence3, frame

fn thin_lens_ray(location: vec2f, lens: vec2f) -> CameraRay {
    let camera = frame.camera;
    let on_lens = concentric_disk(lens) * vec2f(camera.first, camera.second);
    let offset = fence3(on_lens.x * camera.right + on_lens.y * camera.up);
    let aside = fence3(location.x * camera.right + location.y * camera.up);
    let toward = fence3(aside + camera.forward - offset);
    let length = sqrt(dot(toward, toward));
    // The origin is moved by the fraction `advance` of the way from the point on the lens to the point on the plane of
    // focus.
    let along = fence3(camera.advance * aside) + fence3(fence(1.0 - camera.advance) * offset);
    let ray = Ray(fence3(camera.origin + along), fence3(toward * (1.0 / length)));
    return CameraRay(ray, camera.advance * length, true);
}
