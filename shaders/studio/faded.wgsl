// Depth cueing: the fading of colours with distance.
// provides: faded
// needs: lighting

// The fraction of the colour that depth cueing replaces at a distance.
fn faded(distance: f32) -> f32 {
    return clamp((distance - lighting.cue_near) * lighting.cue_scale, 0.0, 1.0);
}
