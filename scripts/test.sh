#!/usr/bin/env bash
# Runs every test. Needs Rust. On Debian and Ubuntu it first installs what else is missing: a linker, and
# Mesa's software Vulkan driver if there is no Vulkan driver at all. Elsewhere it says what to install.
#
#   scripts/test.sh             all tests
#   scripts/test.sh --no-gpu    those that need no adapter; the others count as ignored
#
# What follows is handed to `cargo test`.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ "${1:-}" = --no-gpu ]; then
    shift
    export PINHOLE_NO_GPU_TESTS=1
fi

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
        command -v sudo >/dev/null || {
            echo "$what is missing: as root, apt-get install $*" >&2
            exit 1
        }
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

exec cargo test "$@"
