#!/usr/bin/env bash
# Runs the tests. Needs Rust, a linker and, for the tests on an adapter, a Vulkan driver; on Debian and Ubuntu it installs
# the last two if they are missing and it runs as root. It never calls sudo unless it is asked to.
#
#   scripts/test.sh              all tests
#   scripts/test.sh --quick      units and the program without an adapter: after a small change, within a minute
#   scripts/test.sh --no-gpu     all that need no adapter; the others count as ignored
#   scripts/test.sh --cpu-only   the library and the program built without the feature `gpu`
#   scripts/test.sh --install    may call sudo to install what is missing; also before another of these
#
# What follows is handed to `cargo test`.
set -euo pipefail
cd "$(dirname "$0")/.."

may_call_sudo=
if [ "${1:-}" = --install ]; then
    shift
    may_call_sudo=1
fi
scope=()
case "${1:-}" in
    --quick)
        shift
        export PINHOLE_NO_GPU_TESTS=1
        scope=(--workspace --lib --bins --test program)
        ;;
    --no-gpu)
        shift
        export PINHOLE_NO_GPU_TESTS=1
        ;;
    --cpu-only)
        shift
        export PINHOLE_NO_GPU_TESTS=1
        scope=(-p pinhole -p pinhole-data -p pinhole-figure -p pinhole-cli --no-default-features --features pinhole/run-file --lib --test cpu --test readers --test figures --test program)
        ;;
esac

has_vulkan_driver() {
    # Where the loader looks for drivers (VK_DRIVER_FILES comes before all of them).
    [ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] && return 0
    local folder
    for folder in /usr/share /usr/local/share /etc /usr/local/etc \
        "${XDG_DATA_HOME:-${HOME:-/nonexistent}/.local/share}"; do
        compgen -G "$folder/vulkan/icd.d/*.json" >/dev/null && return 0
    done
    return 1
}

has_vulkan_loader() {
    # ldconfig is not on the path of every user.
    PATH="$PATH:/sbin:/usr/sbin" ldconfig -p 2>/dev/null | grep -q 'libvulkan\.so\.1'
}

# install WHAT PACKAGE...
install() {
    local what=$1 as_root=()
    shift
    if ! command -v apt-get >/dev/null; then
        echo "$what is missing; install it" >&2
        exit 1
    fi
    if [ "$(id -u)" -ne 0 ]; then
        if [ -z "$may_call_sudo" ] || ! command -v sudo >/dev/null; then
            echo "$what is missing. Install it with: sudo apt-get install $*" >&2
            echo "or have this script do it: scripts/test.sh --install" >&2
            exit 1
        fi
        as_root=(sudo)
    fi
    echo "$what is missing: installing $* with apt-get"
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "$@" >/dev/null
}

command -v cargo >/dev/null || {
    version=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
    echo "cargo is missing: install Rust $version or newer, see https://rustup.rs" >&2
    exit 1
}
command -v cc >/dev/null || install "a C linker" gcc libc6-dev

# macOS and Windows bring Metal and DX12.
if [ -z "${PINHOLE_NO_GPU_TESTS:-}" ] && [ "$(uname -s)" = Linux ]; then
    if ! has_vulkan_loader || ! has_vulkan_driver; then
        command -v apt-get >/dev/null || {
            echo "no Vulkan driver was found: install Mesa's Vulkan drivers and the Vulkan loader" >&2
            echo "(Fedora: mesa-vulkan-drivers vulkan-loader; Arch: vulkan-swrast vulkan-icd-loader)," >&2
            echo "or run the tests that need none with scripts/test.sh --no-gpu" >&2
            exit 1
        }
        install "a Vulkan driver" mesa-vulkan-drivers libvulkan1
    fi
fi

exec cargo test "${scope[@]}" "$@"
