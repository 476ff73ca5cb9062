// The light that a path has sampled, as far as nothing occludes it, for kernels that trace whole paths. It finds what
// `path/occlude.wgsl` finds.
// provides: seen_light
// needs: CameraRay, Departure, DirectLight, Ray, SAMPLES_LIGHT, Search, enter_scene, excluded_by, find_any

fn seen_light(light: DirectLight, position: vec3f, departure: Departure) -> vec3f {
    var visibility = light.pending.w;
    // The distance is 0 if there is no light.
    let entry = enter_scene(CameraRay(Ray(position, light.shadow.xyz), 0.0, true));
    let rest = light.shadow.w - entry.distance;
    if (SAMPLES_LIGHT && rest > 0.0 && entry.is_inside) {
        if (find_any(Search(entry.ray, entry.inverse, excluded_by(departure)), rest)) {
            visibility = 0.0;
        }
    }
    return light.pending.rgb * visibility;
}
