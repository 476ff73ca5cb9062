//! The program `pinhole`, which is the function [`pinhole_cli::main`].

use std::process::ExitCode;

fn main() -> ExitCode {
    pinhole_cli::main()
}
