#!/usr/bin/env bash
# Builds the wheel and the program, installs the wheel into a fresh virtual environment, and runs the tests of the package,
# the examples in its documentation and mypy. Needs a Rust toolchain and Python 3.10 or newer with venv, which PYTHON may
# name; the rest comes from PyPI. With PINHOLE_SIGN_OF_LIFE=1 a handful of tests runs. PINHOLE_PROGRAM names a program that was built from the same sources.
set -euo pipefail
cd "$(dirname "$0")/.."

python=${PYTHON:-}
if [ -z "$python" ]; then
    for python in python3 python3.14 python3.13 python3.12 python3.11 python3.10 none; do
        "$python" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 10))' 2>/dev/null && break
    done
fi
if [ "$python" = none ]; then
    echo "Python 3.10 or newer with venv is missing; PYTHON=... names another one" >&2
    exit 3
fi

target=${CARGO_TARGET_DIR:-$PWD/target}
work=$target/python
export CARGO_TARGET_DIR=$target PIP_DISABLE_PIP_VERSION_CHECK=1
mkdir -p "$work"

# The tools stay; the environment with the wheel is made anew.
if ! "$work/tools/bin/maturin" --version >/dev/null 2>&1; then
    "$python" -m venv --clear "$work/tools"
    "$work/tools/bin/pip" install --quiet 'maturin>=1.9,<2'
fi
rm -rf "$work/wheels"
"$work/tools/bin/maturin" build --quiet --locked --profile "${PINHOLE_PROFILE:-dev}" --manifest-path python/Cargo.toml \
    --features "${PINHOLE_FEATURES:-}" --interpreter "$work/tools/bin/python" --out "$work/wheels"
if [ -z "${PINHOLE_PROGRAM:-}" ]; then
    cargo build --quiet --locked --profile "${PINHOLE_PROFILE:-dev}" -p pinhole-cli
    profile=${PINHOLE_PROFILE:-debug}
    [ "$profile" = dev ] && profile=debug
    export PINHOLE_PROGRAM=$target/$profile/pinhole
fi

"$python" -m venv --clear "$work/venv"
if [ -n "${PINHOLE_SIGN_OF_LIFE:-}" ]; then
    "$work/venv/bin/pip" install --quiet "$work"/wheels/pinhole_rt-*.whl pytest
    tests=$PWD/python/tests config=$PWD/python/pyproject.toml
    cd "$work"
    exec "$work/venv/bin/pytest" -c "$config" --rootdir "$tests/.." -p no:cacheprovider -q -rs "$tests/test_arrays.py" \
        "$tests/test_program.py"
fi
"$work/venv/bin/pip" install --quiet "$work"/wheels/pinhole_rt-*.whl pytest mypy anywidget nbclient ipykernel pillow

# Dask and Snakemake are large, and only tests/cluster/run.sh and one test use them.
if [ -n "${PINHOLE_DASK:-}" ]; then
    for package in "dask[distributed]" snakemake; do
        timeout 120 "$work/venv/bin/pip" install --quiet "$package" ||
            echo "SKIPPED: $package, which pip cannot install within two minutes" >&2
    done
fi

# Away from python/, whose folder pinhole/ has no compiled half.
cd "$work"
"$work/venv/bin/pytest" -c "$OLDPWD/python/pyproject.toml" --rootdir "$OLDPWD/python" -p no:cacheprovider -q -rs \
    "$OLDPWD/python/tests" "$@"
"$work/venv/bin/python" -W ignore -c '
import doctest, importlib, pkgutil, sys
import pinhole
failed = 0
for name in ["pinhole", *(f"pinhole.{module.name}" for module in pkgutil.iter_modules(pinhole.__path__))]:
    module = importlib.import_module(name)
    failed += doctest.testmod(module, extraglobs={"pinhole": pinhole}).failed
sys.exit(failed > 0)
'
# The pictures of the gallery, which take a minute or two: PINHOLE_GALLERY=1 python/test.sh
if [ -n "${PINHOLE_GALLERY:-}" ]; then
    "$work/venv/bin/python" -W ignore "$OLDPWD/python/gallery/run.py"
fi
"$work/venv/bin/mypy" --config-file "$OLDPWD/python/pyproject.toml" --cache-dir "$work/mypy" -p pinhole
