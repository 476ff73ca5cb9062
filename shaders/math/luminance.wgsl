// The luminance of a linear colour, by the weights of Rec. 709.
// provides: luminance

const LUMINANCE: vec3f = vec3f(0.2126, 0.7152, 0.0722);

fn luminance(color: vec3f) -> f32 {
    return dot(color, LUMINANCE);
}
