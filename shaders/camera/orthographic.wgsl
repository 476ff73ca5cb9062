// Rays of the orthographic camera. Twin: src/camera/orthographic.rs.
//
// `right` and `up` are the vectors from the centre of the view plane to its edges. `forward` is the unit direction of
// all rays.
// provides: orthographic_ray
// needs: CameraRay, Ray, fence3, frame

fn orthographic_ray(location: vec2f) -> CameraRay {
    let camera = frame.camera;
    let aside = fence3(location.x * camera.right + location.y * camera.up);
    return CameraRay(Ray(camera.origin + aside, camera.forward), camera.advance, true);
}
