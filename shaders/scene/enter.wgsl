// Moving the origin of a ray to the point where it enters the scene's box. No vector from there to a sphere is longer
// than the box's diagonal, which bounds all rounding errors.
// provides: Entry, enter_scene, inverse_direction
// needs: CameraRay, Ray, fence, fence3, frame

struct Entry {
    // The ray, which starts in the box or on its boundary.
    ray: Ray,
    // Reciprocals of the direction's components, from `inverse_direction`.
    inverse: vec3f,
    // Distance from the camera to the origin of the ray.
    distance: f32,
    // Whether there is a ray, and it hits the box.
    is_inside: bool,
}

// Components of a direction that are smaller than this, 2^-40, are replaced by it with their sign, to avoid infinities.
const SMALLEST_COMPONENT: f32 = 0x1p-40;

fn inverse_direction(direction: vec3f) -> vec3f {
    let size = max(abs(direction), vec3f(SMALLEST_COMPONENT));
    return 1.0 / select(-size, size, direction >= vec3f(0.0));
}

fn enter_scene(camera_ray: CameraRay) -> Entry {
    let ray = camera_ray.ray;
    let inverse = inverse_direction(ray.direction);
    let a = fence3(frame.scene_min - ray.origin) * inverse;
    let b = fence3(frame.scene_max - ray.origin) * inverse;
    let near = min(a, b);
    let far = max(a, b);
    let t_near = max(max(near.x, max(near.y, near.z)), 0.0);
    let t_far = min(far.x, min(far.y, far.z));
    let entered = Ray(fence3(ray.origin + t_near * ray.direction), ray.direction);
    let is_inside = camera_ray.is_seen && t_near <= t_far;
    return Entry(entered, inverse, fence(camera_ray.distance + t_near), is_inside);
}
