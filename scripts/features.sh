#!/usr/bin/env bash
# What the features promise, which takes several minutes: clippy of the library with each feature alone, and the tests of
# the library and the program built without the feature `gpu`.
set -euo pipefail
cd "$(dirname "$0")/.."
for feature in "" gpu run-file; do
    cargo clippy --locked --quiet -p pinhole --lib --no-default-features --features "$feature" -- -D warnings
done
scripts/test.sh --cpu-only --locked
