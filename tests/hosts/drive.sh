#!/usr/bin/env bash
# Drives the host programs of examples/hosts in real windows: starts each under Xvfb, turns the camera, zooms, resizes,
# picks and quits by xdotool, and compares screenshots with each other and with what `Headless` renders for the same
# camera.
#
#   tests/hosts/drive.sh [HOST...]      all hosts, or some: winit raster egui
#
# It needs Xvfb, xdotool, Python and a Vulkan driver that can draw to a window. If Xvfb or xdotool is missing and it runs
# as root, it installs them with apt-get; otherwise it says what it skips and ends with exit code 77.
#
# What is checked in the logs are the errors of wgpu. WGPU_VALIDATION=1 loads the validation layers of Vulkan as well, whose
# version must be one that knows WGSL as a source language (those of Debian 12 do not).
#
# OUT names the folder for screenshots and logs, target/hosts by default. A screenshot equals the picture of `Headless` if
# at most 0.1 % of the pixels differ by more than 2 of 255.
set -euo pipefail
cd "$(dirname "$0")/../.."

hosts=("$@")
[ ${#hosts[@]} -gt 0 ] || hosts=(winit raster egui)

missing=()
for tool in Xvfb xdotool python3; do
    command -v "$tool" >/dev/null || missing+=("$tool")
done
if [ ${#missing[@]} -gt 0 ] && [ "$(id -u)" -eq 0 ] && command -v apt-get >/dev/null; then
    apt-get update -qq && apt-get install -y -qq --no-install-recommends xvfb xdotool python3 >/dev/null && missing=()
fi
if [ ${#missing[@]} -gt 0 ]; then
    echo "SKIPPED: the hosts ${hosts[*]} were not driven, because ${missing[*]} is missing." >&2
    echo "SKIPPED: install xvfb, xdotool and python3, and run tests/hosts/drive.sh again." >&2
    exit 77
fi

target=${CARGO_TARGET_DIR:-target}
mkdir -p "$target"
target=$(realpath "$target")
out=${OUT:-$target/hosts}
mkdir -p "$out"
out=$(realpath "$out")
pixels=$(realpath tests/hosts/pixels.py)
cargo build --locked --manifest-path examples/hosts/Cargo.toml --target-dir "$target" "${hosts[@]/#/-ppinhole-host-}"

# A display of its own, whose screen is a file.
exec 3> >(cat >"$out/display")
Xvfb -displayfd 3 -screen 0 1280x900x24 -fbdir "$out" -nolisten tcp >"$out/Xvfb.log" 2>&1 &
xvfb=$!
host=
trap 'kill $host $xvfb 2>/dev/null || true' EXIT
for _ in $(seq 100); do
    [ -s "$out/display" ] && break
    sleep 0.1
done
DISPLAY=:$(cat "$out/display")
export DISPLAY
unset WAYLAND_DISPLAY
# Without this folder Mesa writes a line that begins with "error" whenever a surface is asked for, as in a container.
export XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-$out/runtime}
mkdir -p -m 700 "$XDG_RUNTIME_DIR"

failed=0
# check WHAT VALUE OPERATOR LIMIT
check() {
    if python3 -c "import sys; sys.exit(not ($2 $3 $4))"; then
        echo "  ok: $1: $2 $3 $4"
    else
        echo "  FAILED: $1: not $2 $3 $4" >&2
        failed=1
    fi
}

# Ends the whole run. $1 says why.
give_up() {
    echo "FAILED: $name: $1; see $log" >&2
    tail -20 "$log" >&2
    exit 1
}

shot() { python3 "$pixels" shot "$out/Xvfb_screen0" "${width}x$height+$x+$y" "$dir/$1.png"; }
differ() { python3 "$pixels" differ "$dir/$1.png" "$dir/$2.png"; }

# Where the window is now: x, y, width, height.
locate() {
    local X Y WIDTH HEIGHT
    eval "$(xdotool getwindowgeometry --shell "$window" | grep -E '^(X|Y|WIDTH|HEIGHT)=')"
    x=$X y=$Y width=$WIDTH height=$HEIGHT
}

# Takes a screenshot once four in a row are the same, and no samples remain to be recorded where the host has a lit picture.
settle() {
    local same=0
    shot "$1"
    for _ in $(seq 600); do
        sleep 0.7
        kill -0 "$host" 2>/dev/null || give_up "it ended by itself"
        mv "$dir/$1.png" "$dir/before.png"
        shot "$1"
        [ "$(grep -E '^(done|refining)$' "$log" | tail -1)" != refining ] || continue
        if [ "$(differ "$1" before)" = 0.000 ]; then same=$((same + 1)); else same=0; fi
        [ "$same" -ge 3 ] && return
    done
    give_up "its picture does not come to rest"
}

# Waits until the log has more lines with $1 than $2.
await() {
    for _ in $(seq 600); do
        [ "$(grep -c "$1" "$log")" -gt "$2" ] && return
        kill -0 "$host" 2>/dev/null || give_up "it ended by itself"
        sleep 0.1
    done
    give_up "it does not say '$1'"
}

# Presses s and compares the picture of `Headless`, $1-headless.png, with the same part of the screenshot $1.
compare() {
    local count part w h x0 y0
    count=$(grep -c '^wrote' "$log" || true)
    xdotool key s
    await '^wrote' "$count"
    cp "$dir/pinhole-host-$name.png" "$dir/$1-headless.png"
    part=$(sed -n 's/^panel //p' "$log" | tail -1)
    IFS='x+' read -r w h x0 y0 <<<"${part:-${width}x$height+0+0}"
    python3 "$pixels" shot "$dir/$1.png" "${w}x$h+$x0+$y0" "$dir/$1-part.png"
    check "$1: percent that differ from Headless" "$(differ "$1-part" "$1-headless")" "<=" 0.1
}

move() { xdotool mousemove --window "$window" "$1" "$2"; sleep 0.1; }
drag() {
    move $((width / 2 + 60)) $((height / 2))
    xdotool mousedown 1
    for _ in 1 2 3 4 5 6; do
        xdotool mousemove_relative -- "$1" "$2"
        sleep 0.05
    done
    xdotool mouseup 1
}

open() {
    name=$1
    dir=$out/$name
    log=$dir/log
    rm -rf "$dir"
    mkdir -p "$dir"
    echo "== $name =="
    (cd "$dir" && exec env RUST_LOG=warn WGPU_VALIDATION="${WGPU_VALIDATION:-0}" "$target/debug/pinhole-host-$name" >"$log" 2>&1) &
    host=$!
    window=
    for _ in $(seq 600); do
        window=$(xdotool search --onlyvisible --name "^pinhole " 2>/dev/null | head -1) && [ -n "$window" ] && break
        kill -0 "$host" 2>/dev/null || give_up "it ended by itself"
        sleep 0.1
    done
    [ -n "$window" ] || give_up "no window"
    xdotool windowmove "$window" 0 0
    xdotool windowfocus "$window"
    # A host draws for the first time when its pipelines are built.
    for _ in $(seq 120); do
        sleep 0.5
        locate
        shot begin
        [ "$(python3 "$pixels" colors "$dir/begin.png")" -gt 200 ] && return
        kill -0 "$host" 2>/dev/null || give_up "it ended by itself"
    done
    give_up "it draws nothing"
}

quit() {
    local code=0
    xdotool key Escape
    for _ in $(seq 100); do
        kill -0 "$host" 2>/dev/null || break
        sleep 0.1
    done
    kill -0 "$host" 2>/dev/null && give_up "Escape does not end it"
    wait "$host" || code=$?
    check "exit code" "$code" "==" 0
    check "lines of its log with errors" \
        "$(grep -ciE 'error|validation|panicked|VUID|lost' "$log" || true)" "==" 0
    rm -f "$dir/before.png" "$dir/begin.png"
}

# What all hosts do.
common() {
    settle first
    compare first
    drag 8 4
    settle turned
    check "percent that a drag changes" "$(differ first turned)" ">" 1
    xdotool click 4 click 4 click 4
    settle nearer
    check "percent that the wheel changes" "$(differ turned nearer)" ">" 1
    compare nearer
    xdotool windowsize "$window" 901 523
    sleep 1
    locate
    check "width after the window was resized" "$width" "==" 901
    settle resized
    compare resized
}

drive_winit() { common; }

drive_raster() {
    shot turning
    sleep 1
    shot turning-later
    check "percent that the turning box changes" "$(differ turning turning-later)" ">" 0.05
    xdotool key space
    await 'turning false' 0
    settle boxes
    xdotool key d
    await 'early depth true' 0
    settle boxes-early
    check "percent that early depth changes, at edges" "$(differ boxes boxes-early)" "<" 1
    xdotool key d
    xdotool key t
    await 'triangles false' 0
    common
    xdotool key t
    settle boxes-resized
    # The corner pixel shows the sky.
    seen=$(python3 "$pixels" seen "$dir/resized-headless.png" "$dir/boxes-resized.png" 2 2)
    check "percent of the spheres that are in front of the boxes" "$seen" ">" 20
    check "percent of the spheres that are in front of the boxes" "$seen" "<" 90
}

drive_egui() {
    common
    # The middle of the knot is empty; a strand is beside it.
    move $((width / 2 + 100)) $((height / 2))
    for right in 0 20 20 20 20; do
        xdotool mousemove_relative -- "$right" 0
        sleep 0.2
        count=$(grep -c '^picked' "$log" || true)
        xdotool click 1
        await '^picked' "$count"
        grep -q '^picked Some' "$log" && break
    done
    check "picks with a sphere" "$(grep -c '^picked Some' "$log" || true)" ">=" 1
    settle picked
    # The styles are below each other: light of a studio, paths, flat colours.
    move 20 59
    xdotool click 1
    settle paths
    check "percent that path tracing changes" "$(differ picked paths)" ">" 1
    compare paths
    move 20 83
    xdotool click 1
    settle flat
    check "percent that flat colours change" "$(differ paths flat)" ">" 1
    # What was picked has the colour of that pixel.
    IFS='x+' read -r _ _ x0 y0 <<<"$(sed -n 's/^panel //p' "$log" | tail -1)"
    read -r id column row color <<<"$(sed -nE 's/^picked Some\(([0-9]+)\) at \[([0-9]+), ([0-9]+)\], Some\((.*)\)$/\1 \2 \3 \4/p' "$log" | tail -1)"
    found=$(python3 "$pixels" color "$dir/flat.png" $((x0 + column)) $((y0 + row)))
    check "colour of the picked sphere $id and of its pixel" "$color" "==" "$found"
}

for name in "${hosts[@]}"; do
    open "$name"
    "drive_$name"
    quit
done
if [ "$failed" -ne 0 ]; then
    echo "some checks FAILED; screenshots and logs are in $out" >&2
    exit 1
fi
echo "all checks passed; screenshots and logs are in $out"
