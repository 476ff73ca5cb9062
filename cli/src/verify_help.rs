//! What `pinhole verify --help` says at its end.

pub(super) const AFTER_HELP: &str = "The check covers the data on the device and every ray, hit, depth, normal and \
    color. It computes in f64, with a bound for every rounding that WGSL leaves open. Where several answers are legal, the device must have \
    given one of them. The CPU reference never replaces an adapter here.\n\n\
    Exit codes: 0 every pixel is as a conforming device may have made it; 1 the job failed, or there is no adapter, \
    or RUN is damaged; 2 wrong usage; 3 the picture is not legal; 4 no violation was found, but more than 1 % of the \
    pixels have several legal answers, or of the stages of light paths or the denoised pixels have bounds so wide that \
    they say little.\n\n\
    JSON: `version`, `adapter` (name, backend, device_type, driver, driver_info, limits), `scene` (spheres, sha256), \
    `picture` (width, height, camera, y_axis, shading, structure), `counts` (decided, silhouette, tie, violation), \
    `decided_fraction`, `worst_depth` and `worst_normal` (as fractions of their bounds), `upload` (null, or what is \
    wrong), `violations` (the first hundred: pixel, stage, message), `open` (the first three ties and the first three silhouettes: \
    pixel, verdict, message), `paths` (only with the integrator `path`: paths, \
    stages, rectangles (column, row, width and height of what was checked), judged (samples, of_samples, pixels, of_pixels: so many of \
    so many in the picture, and fraction, of all its samples), open (the first stages that are open or \
    undecided: pixel, sample, surface, stage, is_undecided, legal: of an open search, up to four legal answers), upload, \
    violation_count, violations, outcome, legal), `studio` (only with the integrator `studio`: samples, \
     stages and so on), `denoiser` (only if the picture is denoised: pixels, undecided, violation_count, violations, \
     outcome), `biased` (quantities whose results lie to one side of the middle of their bounds, in words), `outcome` \
    (proved, undecided, violated), `legal`, `command`. `version` and `command` are those of the program \
    that rendered. New versions may add keys, but do not change these.";
