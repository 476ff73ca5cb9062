// Rays that start on a sphere and end on another meet neither.

var<private> left: vec4f;
var<private> target_sphere: vec4f;

fn is_left(sphere: vec4f) -> bool {
    let radius = abs(sphere.w);
    return (all(sphere.xyz == left.xyz) && radius == left.w)
        || (all(sphere.xyz == target_sphere.xyz) && radius == target_sphere.w);
}
