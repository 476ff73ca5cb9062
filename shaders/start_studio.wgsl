// In a studio, nothing more is known of a ray.

fn start_light(index: u32) {}
