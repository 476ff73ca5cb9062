#!/usr/bin/env bash
# Turns, zooms and picks in a view in JupyterLab, in a real browser without a screen. Needs the environment of
# python/test.sh, Node.js with npm, and Chromium, which CHROMIUM may name; exits with 3 if any is missing. The rest comes from
# PyPI and npm.
set -euo pipefail
cd "$(dirname "$0")/.."
target=${CARGO_TARGET_DIR:-$PWD/target}
work=$target/python
tests=$PWD/python/tests
export CHROMIUM=${CHROMIUM:-$(command -v chromium || echo /usr/bin/chromium)}
for part in "$work/venv/bin/python" "$CHROMIUM" "$(command -v npm || echo npm)"; do
    [ -x "$part" ] || { echo "$part is missing" >&2; exit 3; }
done

page=$work/browser
mkdir -p "$page"
cp "$tests/browser.mjs" "$page"
(cd "$page" && npm install --silent --no-fund --no-audit playwright-core@1)
if ! "$work/lab/bin/jupyter" --version >/dev/null 2>&1; then
    "$work/venv/bin/python" -m venv --clear "$work/lab"
    "$work/lab/bin/pip" install --quiet jupyterlab anywidget numpy
fi
"$work/lab/bin/pip" install --quiet --force-reinstall --no-deps "$work"/wheels/pinhole_rt-*.whl
cat >"$page/view.ipynb" <<'NOTEBOOK'
{"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": {"name": "python3", "display_name": "Python 3"}}, "cells": [
{"id": "a", "cell_type": "code", "metadata": {}, "outputs": [], "execution_count": null, "source":
 "import numpy as np, pinhole as ph\npoints = np.random.default_rng(1).normal(size=(400, 3))\nspheres = ph.Spheres(points, 0.3, points[:, 2], cmap='viridis')\nview = spheres.view((480, 360), samples=4)\nfar = np.linalg.norm(view.camera.keys['eye'])\nview"},
{"id": "b", "cell_type": "code", "metadata": {}, "outputs": [], "execution_count": null, "source":
 "print('picked', view.picked, 'from', np.linalg.norm(view.camera.keys['eye']) / far)"}]}
NOTEBOOK
port=$("$work/lab/bin/python" -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
cd "$page"
"$work/lab/bin/jupyter" lab --allow-root --no-browser --ip 127.0.0.1 --port "$port" --IdentityProvider.token= \
    --notebook-dir "$page" >"$page/lab.log" 2>&1 &
lab=$!
trap 'kill "$lab"' EXIT
for _ in $(seq 60); do
    if grep -q "is running at" "$page/lab.log"; then break; fi
    sleep 0.5
done
node browser.mjs "http://127.0.0.1:$port/lab/tree/view.ipynb?reset" "$page/view.png"
