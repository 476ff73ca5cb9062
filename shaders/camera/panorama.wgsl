// Rays of the panorama camera. Twin: src/camera/panorama.rs.
//
// `right`, `up` and `forward` are unit vectors. `first` is the distance by which the origin of a ray is moved along the
// tangent of the viewing circle. `second` and `third` are the cosine and the sine of the angle by which rays are
// rotated to the left.
// provides: panorama_ray
// needs: CameraRay, Ray, fence3, frame, sin_cos_half_turns

fn panorama_ray(location: vec2f) -> CameraRay {
    let camera = frame.camera;
    let longitude = sin_cos_half_turns(location.x);
    let latitude = sin_cos_half_turns(0.5 * location.y);
    let heading = fence3(longitude.x * camera.right + longitude.y * camera.forward);
    let tangent = fence3(longitude.y * camera.right - longitude.x * camera.forward);
    let straight = fence3(latitude.y * heading + latitude.x * camera.up);
    let toward = fence3(camera.second * straight - camera.third * tangent);
    let length = sqrt(dot(toward, toward));
    let ray = Ray(fence3(camera.origin + camera.first * tangent), fence3(toward * (1.0 / length)));
    return CameraRay(ray, 0.0, true);
}
