// What the scenes have that a pipeline of paths is for. The kernels are those of a studio if they have nothing of it.
// provides: ANY_MATERIALS, SAMPLES_LIGHT

// Whether there are surfaces that are neither matt nor emissive.
override ANY_MATERIALS: bool;
// Whether there is a light source that can be sampled.
override SAMPLES_LIGHT: bool;
