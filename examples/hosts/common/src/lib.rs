//! Code that the host programs share: a window with wgpu, a camera that orbits, a molecule and its light, a budget of
//! rays, and a picture by `Headless` for comparison.

mod budget;
mod light;
mod molecule;
mod orbit;
mod still;
mod surface;
mod window;

use std::error::Error;

pub use budget::Budget;
pub use light::{background, paths, studio};
pub use molecule::molecule;
pub use orbit::Orbit;
pub use still::save_still;
pub use surface::{Gpu, WindowSurface};
pub use window::{Host, Next, run};

/// The result of a step in a host. Any error ends the host with a message.
pub type Outcome<T> = Result<T, Box<dyn Error>>;

/// Logs warnings and errors of wgpu to standard error. The environment variable `RUST_LOG` asks for more.
pub fn start_log() {
    let environment = env_logger::Env::default().default_filter_or("warn");
    env_logger::Builder::from_env(environment).init();
}
