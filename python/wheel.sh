#!/usr/bin/env bash
# Builds what is published, into the folder that is given: the sdist, and from it a wheel for Linux systems with glibc 2.17
# or newer (2014), the oldest that Rust's standard library supports. Then installs the wheel where there is neither Rust
# nor a Vulkan driver, and renders a picture there. Needs a Rust toolchain and Python 3.10 or newer with venv, and, for the
# last step, debootstrap and the rights of root; without them it says that the step is skipped.
set -euo pipefail
out=$(realpath -m "${1:?write python/wheel.sh FOLDER}")
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"

python3 -m venv "$work/tools"
# Zig is a linker that knows the symbols of old versions of glibc.
"$work/tools/bin/pip" install --quiet 'maturin>=1.9,<2' ziglang auditwheel
export PATH="$work/tools/bin:$PATH"
maturin sdist --manifest-path python/Cargo.toml --out "$out" >"$work/sdist.log"
sdist=$(ls -t "$out"/pinhole_rt-*.tar.gz | head -1)
tar -xzf "$sdist" -C "$work"
cd "$work"/pinhole_rt-*/
# Not --locked: the lock file also names members of the workspace that an sdist leaves out.
maturin build --quiet --zig --compatibility manylinux2014 --out "$out"
wheel=$(ls -t "$out"/pinhole_rt-*.whl | head -1)
auditwheel show "$wheel"
echo "$(stat -c %s "$sdist") bytes: $sdist"
echo "$(stat -c %s "$wheel") bytes: $wheel"

if ! command -v debootstrap >/dev/null || [ "$(id -u)" -ne 0 ]; then
    echo "SKIPPED: the wheel on a bare system; debootstrap is missing, or this is not root" >&2
    exit
fi
debootstrap --variant=minbase --include=python3-venv bookworm "$work/bare" >"$work/debootstrap.log"
"$work/tools/bin/pip" download --quiet --dest "$work/bare/wheels" --python-version 3.11 --only-binary :all: "$wheel"
chroot "$work/bare" /usr/bin/env -i PATH=/usr/bin:/bin sh -euc '
    python3 -m venv /venv
    /venv/bin/pip install --quiet --no-index --find-links /wheels pinhole-rt
    /venv/bin/python -c "
import pinhole as ph
picture = ph.Spheres([[0, 0, 0]], radius=1.0).render(size=(64, 48))
assert picture.adapter is None and picture.rgb8.std() > 0
print(\"rendered on a bare system:\", picture.size)
"'
