# What a developer does. `just` lists these; each line can also be typed by hand.

# Lists the recipes.
default:
    @just --list

# Type errors, in seconds.
check:
    cargo check --workspace --all-targets

# Tests that take less than a minute.
quick:
    scripts/test.sh --quick

# All tests.
test *ARGUMENTS:
    scripts/test.sh {{ARGUMENTS}}

# Lints, as the gate has them.
lint:
    cargo fmt --all --check
    cargo clippy --workspace --all-targets -- -D warnings

# The documentation of the library, in a browser.
doc:
    cargo doc --no-deps -p pinhole --open

# Renders the demo.
demo:
    cargo run --release -- demo

# Drives the host programs of examples/hosts in windows of Xvfb.
hosts *ARGUMENTS:
    tests/hosts/drive.sh {{ARGUMENTS}}

# Shows a file in a window.
view *ARGUMENTS:
    cargo run --release -p pinhole-viewer -- {{ARGUMENTS}}

# Drives the viewer in a window on a screen in memory.
drive:
    cargo build -p pinhole-cli -p pinhole-viewer
    tests/viewer/drive.sh

# Compares structures on this machine's adapter.
bench *ARGUMENTS:
    cargo run --release -- bench {{ARGUMENTS}}

# 500 random lit scenes, whose every stage is checked.
campaign:
    cargo bench --bench verify -- lit-campaign 500

# The gate.
ci:
    .ci/run

# The program as it is given away.
dist:
    cargo build --profile dist -p pinhole-cli
