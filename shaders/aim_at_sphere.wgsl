// The sphere that a path looks for hides itself from nobody.

fn aim(index: u32) {
    target_sphere = load(index, TARGET);
}
