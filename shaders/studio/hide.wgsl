// Keeping which lights are hidden from a surface, in a studio.
// provides: hide
// needs: NORMAL, paths, slot

// Sets the bits of hidden lights, one for each of 32 lights.
fn hide(index: u32, lights: u32) {
    if (lights != 0u) {
        paths[slot(index, NORMAL)].w |= lights;
    }
}
