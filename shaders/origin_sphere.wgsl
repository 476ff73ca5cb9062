// Rays that start on a sphere do not meet it: from outside a sphere is left for good, and the far wall, for a ray
// that goes inside, is known without a search. So no distance is too small to count.

var<private> left: vec4f;

fn is_left(sphere: vec4f) -> bool {
    return all(sphere.xyz == left.xyz) && abs(sphere.w) == left.w;
}
