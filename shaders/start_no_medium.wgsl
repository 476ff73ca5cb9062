// Where there is no glass, nothing absorbs light.

fn start_medium(index: u32) {}
