// Rays of the pinhole camera. Twin: src/camera/pinhole.rs.
//
// `right` and `up` are the vectors from the centre of the view plane to its edges. `forward` is the vector from the eye
// to the centre of the view plane.
// provides: pinhole_ray
// needs: CameraRay, Ray, fence3, frame

fn pinhole_ray(location: vec2f) -> CameraRay {
    let camera = frame.camera;
    let aside = fence3(location.x * camera.right + location.y * camera.up);
    let toward = aside + camera.forward;
    let length = sqrt(dot(toward, toward));
    let ray = Ray(camera.origin + camera.advance * aside, fence3(toward * (1.0 / length)));
    return CameraRay(ray, camera.advance * length, true);
}
