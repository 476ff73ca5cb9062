#!/usr/bin/env bash
# Runs the GPU tests with every other Vulkan driver for processors that this machine has: those in the folders of PINHOLE_ICDS,
# and SwiftShader of an installed Chromium. Needs the tests' program, which `cargo test --no-run` builds.
#
#     tests/drivers/run.sh [FILTER]
#
# PINHOLE_ICDS is a list of manifests (*.json), separated by colons. Without a FILTER, the tests that ask whether a driver is accused
# are run: of primary rays, light, structures, ray queries and written pictures; the adversary's tests say nothing about a driver.
# Ends with 3 if there is no other driver.
set -euo pipefail
cd "$(dirname "$0")/../.."

tests=$(cargo test --locked --quiet -p pinhole --features run-file --test gpu --no-run --message-format=json |
    python3 -c 'import json, sys
for line in sys.stdin:
    if line.startswith("{") and (path := json.loads(line).get("executable")): print(path)' | tail -n 1)

folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
IFS=: read -r -a manifests <<<"${PINHOLE_ICDS:-}"
swiftshader=/usr/lib/chromium/libvk_swiftshader.so
if [ -e "$swiftshader" ]; then
    printf '{"file_format_version": "1.0.0", "ICD": {"library_path": "%s", "api_version": "1.1.0"}}\n' "$swiftshader" \
        >"$folder/swiftshader.json"
    manifests+=("$folder/swiftshader.json")
fi
if [ ${#manifests[@]} -eq 0 ]; then
    echo "SKIPPED: no other driver: set PINHOLE_ICDS, or apt-get install chromium" >&2
    exit 3
fi

filters=("$@")
[ ${#filters[@]} -gt 0 ] || filters=(verify:: agreement:: ray_query:: written:: denoised:: self_test::)
export XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-/tmp}
failed=0
for manifest in "${manifests[@]}"; do
    for filter in "${filters[@]}"; do
        printf '\n== %s, %s ==\n' "$manifest" "$filter"
        VK_DRIVER_FILES=$manifest VK_ICD_FILENAMES=$manifest "$tests" "$filter" >"$folder/log" 2>&1 || failed=1
        grep -E '^adapter:|FAILED|^test result' "$folder/log" || { cat "$folder/log"; failed=1; }
        sed -n '/^failures:/,$p' "$folder/log"
    done
done
exit "$failed"
