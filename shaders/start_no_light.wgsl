// Where no light is looked for, there is nothing to start with.

fn start_light(index: u32) {}
