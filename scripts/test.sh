#!/usr/bin/env bash
# Runs every test. On Debian and Ubuntu it first installs Mesa's software Vulkan driver if there is no
# Vulkan driver at all; elsewhere it says what to install.
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

install_driver() {
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || {
            echo "no Vulkan driver was found: as root, apt-get install mesa-vulkan-drivers libvulkan1" >&2
            exit 1
        }
        as_root=(sudo)
    fi
    echo "no Vulkan driver was found: installing Mesa's lavapipe with apt-get"
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends mesa-vulkan-drivers libvulkan1 >/dev/null
}

# macOS and Windows bring Metal and DX12.
if [ -z "${PINHOLE_NO_GPU_TESTS:-}" ] && [ "$(uname -s)" = Linux ]; then
    if ! has_vulkan_loader || ! has_vulkan_driver; then
        if command -v apt-get >/dev/null; then
            install_driver
        else
            echo "no Vulkan driver was found: install Mesa's Vulkan drivers and the Vulkan loader" >&2
            echo "(Fedora: mesa-vulkan-drivers vulkan-loader; Arch: vulkan-swrast vulkan-icd-loader)," >&2
            echo "or run the tests that need none with scripts/test.sh --no-gpu" >&2
            exit 1
        fi
    fi
fi

exec cargo test "$@"
