#!/usr/bin/env bash
# Drives the viewer in a real window, as a user would: orbits, resizes, plays, picks, copies, saves, quits. What it saves
# must be, to the byte, what `pinhole render` writes by the command that it copies. Makes its own data.
#
#     cargo build -p pinhole-cli -p pinhole-viewer
#     tests/viewer/drive.sh [FOLDER]
#
# Needs Xvfb and xdotool; python3 for screenshots, and xclip, xsel or its tkinter for the clipboard. Says what it skips without them.
# FOLDER keeps the screenshots, the pictures and what the viewer said. PINHOLE_BIN is the folder of both programs.
set -euo pipefail
cd "$(dirname "$0")/../.."

bin=$(realpath "${PINHOLE_BIN:-${CARGO_TARGET_DIR:-target}/debug}")
folder=${1:-$(mktemp -d)}
mkdir -p "$folder"
folder=$(realpath "$folder")
skipped=0
skip() {
    skipped=$((skipped + 1))
    echo "SKIPPED: $1" >&2
}
fail() {
    echo "FAILED: $1" >&2
    [ -f "$folder/said.txt" ] && tail -n 20 "$folder/said.txt" >&2
    exit 1
}

for program in pinhole pinhole-viewer; do
    [ -x "$bin/$program" ] || fail "$bin/$program is missing; build it: cargo build -p pinhole-cli -p pinhole-viewer"
done
for tool in Xvfb xdotool; do
    if ! command -v "$tool" >/dev/null; then
        skip "all of it: $tool is missing"
        exit 0
    fi
done

# A molecule and a trajectory: a helix of carbon, nitrogen and oxygen that turns. The last frame is cut off.
cd "$folder"
awk 'BEGIN { split("C N O", e, " ")
    for (i = 0; i < 240; i++)
        printf "ATOM  %5d  %-3s %s A%4d    %8.3f%8.3f%8.3f  1.00%6.2f          %2s\n", i + 1, e[i % 3 + 1] "A",
            (i % 2 ? "ALA" : "GLY"), i / 6 + 1, 8 * cos(i / 5), 8 * sin(i / 5), i / 6, i % 50, e[i % 3 + 1] }' >helix.pdb
awk 'BEGIN { split("C N O", e, " ")
    for (f = 0; f < 12; f++) {
        print 240; print "Properties=species:S:1:pos:R:3:charge:R:1"
        for (i = 0; i < 240; i++) {
            a = i / 5 + f / 4
            print e[i % 3 + 1], 8 * cos(a), 8 * sin(a), i / 6, (i - 120) / 100 } } }' >turning.xyz
{ cat turning.xyz; printf '240\nProperties=species:S:1:pos:R:3\nC 1 2 3\n'; } >cut.xyz
awk 'BEGIN { srand(1); print "x,y,z,radius"
    for (i = 0; i < 100000; i++) print 100 * rand() "," 100 * rand() "," 100 * rand() "," 0.6 + 0.4 * rand() }' >many.csv

# A screen whose pixels are a file.
mkdir -p screen
export XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-/tmp}
display=
for number in $(seq 90 120); do
    [ -e "/tmp/.X11-unix/X$number" ] && continue
    Xvfb ":$number" -screen 0 1280x900x24 -fbdir "$folder/screen" -nolisten tcp >/dev/null 2>&1 &
    xvfb=$!
    for _ in $(seq 50); do
        [ -e "/tmp/.X11-unix/X$number" ] && break
        sleep 0.1
    done
    kill -0 "$xvfb" 2>/dev/null && display=:$number && break
done
[ -n "$display" ] || fail "Xvfb does not start"
export DISPLAY=$display
unset WAYLAND_DISPLAY
viewer=
end() {
    [ -n "$viewer" ] && kill "$viewer" 2>/dev/null
    kill "$xvfb" 2>/dev/null
    wait 2>/dev/null
}
trap end EXIT

# shot NAME: writes the screen to NAME.png.
shot() {
    if ! command -v python3 >/dev/null; then
        skip "screenshot $1: python3 is missing"
        return
    fi
    python3 - "$folder/screen/Xvfb_screen0" "$folder/$1.png" <<'PY'
import struct, sys, zlib
data = open(sys.argv[1], "rb").read()
head = struct.unpack(">25I", data[:100])
size, width, height, line, colors = head[0], head[4], head[5], head[12], head[19]
start = size + 12 * colors
rows = []
for y in range(height):
    row = data[start + y * line : start + y * line + 4 * width]
    rgb = bytearray(3 * width)
    rgb[0::3], rgb[1::3], rgb[2::3] = row[2::4], row[1::4], row[0::4]
    rows.append(b"\0" + bytes(rgb))
def chunk(kind, body):
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0))
open(sys.argv[2], "wb").write(png + chunk(b"IDAT", zlib.compress(b"".join(rows), 6)) + chunk(b"IEND", b""))
PY
}

# waits TEXT [SECONDS]: waits until the viewer has said something since the last mark.
marked=0
mark() { marked=$(wc -l <said.txt); }
waits() {
    for _ in $(seq $((${2:-120} * 5))); do
        tail -n "+$((marked + 1))" said.txt | grep -q -- "$1" && return
        kill -0 "$viewer" 2>/dev/null || fail "the viewer ended while it should say: $1"
        sleep 0.2
    done
    shot "failed"
    fail "the viewer does not say: $1"
}

# opens WORDS ...: starts the viewer, and waits for its first still picture.
opens() {
    : >said.txt
    : >copied.txt
    PINHOLE_VIEWER_LOG=1 "$bin/pinhole" view "$@" >copied.txt 2>said.txt &
    viewer=$!
    marked=0
    waits "shown:"
    window=$(xdotool search --sync --onlyvisible --pid "$viewer" | tail -n 1)
    xdotool windowmove "$window" 0 0 windowfocus "$window"
    waits "still: \([0-9]*\) of \1 samples"
}

# quits: closes the window by its keys. The viewer must end by itself, and without an error.
quits() {
    xdotool key --window "$window" ctrl+q
    for _ in $(seq 100); do
        kill -0 "$viewer" 2>/dev/null || break
        sleep 0.1
    done
    kill -0 "$viewer" 2>/dev/null && fail "the viewer does not end"
    wait "$viewer" || fail "the viewer ended with code $?"
    viewer=
}

# drags BUTTON X Y DX DY: drags in ten steps.
drags() {
    xdotool mousemove --window "$window" "$2" "$3" mousedown "$1"
    for step in $(seq 10); do
        xdotool mousemove --window "$window" $(($2 + $4 * step / 10)) $(($3 + $5 * step / 10))
        sleep 0.05
    done
    xdotool mouseup "$1"
}

# same NAME: copies the command, saves, and compares both pictures to the byte.
same() {
    mark
    xdotool key --window "$window" ctrl+c
    sleep 1
    xdotool key --window "$window" ctrl+s
    waits "saved" 300
    command=$(tail -n 1 copied.txt)
    [[ $command == "pinhole render "* ]] || fail "$1: no command was copied: $command"
    if command -v xclip >/dev/null; then
        [ "$(timeout 10 xclip -selection clipboard -o)" = "$command" ] || fail "$1: the clipboard has another command"
    elif command -v xsel >/dev/null; then
        [ "$(timeout 10 xsel --clipboard --output)" = "$command" ] || fail "$1: the clipboard has another command"
    elif python3 -c 'import tkinter' 2>/dev/null; then
        [ "$(timeout 10 python3 -c 'import tkinter; print(tkinter.Tk().clipboard_get())')" = "$command" ] ||
            fail "$1: the clipboard has another command"
    else
        skip "$1: the clipboard: xclip, xsel and tkinter are missing; the command on standard output was used"
    fi
    saved=${command##* -o }
    mv "$saved" "$1-saved.png"
    PATH="$bin:$PATH" bash -c "$command" 2>/dev/null || fail "$1: the command fails: $command"
    cmp "$saved" "$1-saved.png" || fail "$1: the saved picture is another one than that of: $command"
    echo "equal to the byte: $1: $command"
}

echo "== a molecule: orbit, zoom, pan, pick, resize =="
opens helix.pdb
shot molecule-start
same start
mark
drags 1 400 350 160 60
waits "still: \([0-9]*\) of \1 samples"
same orbit
drags 3 400 350 60 -40
mark
xdotool mousemove --window "$window" 400 350 click 4 click 4
waits "still: \([0-9]*\) of \1 samples"
same pan-and-zoom
shot molecule-moved
# The picture is the left part of the window; somewhere in its middle row there is a sphere.
mark
for x in $(seq 150 35 750); do
    xdotool mousemove --window "$window" "$x" 350 click 1
    sleep 0.7
    tail -n "+$((marked + 1))" said.txt | grep -q "picked: id" && break
done
waits "picked: id" 5
shot molecule-picked
mark
xdotool windowsize "$window" 900 620
waits "still: \([0-9]*\) of \1 samples"
same resized
shot molecule-resized
quits

echo "== balls and sticks: what is seen while the view turns has cylinders, too =="
opens helix.pdb --bonds --size 400x300
waits "still: \([0-9]*\) of \1 samples" 300
mark
xdotool mousemove --window "$window" 300 250 mousedown 1
xdotool mousemove --window "$window" 380 290
sleep 1
shot sticks-turning
xdotool mouseup 1
waits "still: \([0-9]*\) of \1 samples" 300
grep -qi "error\|pipeline" said.txt && fail "the viewer complains about cylinders: $(cat said.txt)"
quits

echo "== flags: path tracing, a selection, colors, a given size =="
opens helix.pdb --style path --samples 16 --select 'residue_number < 30 and name != "NA"' --color-by b_factor --legend \
    --scale-bar --camera orthographic --size 320x200
mark
drags 1 400 350 -120 30
waits "still: \([0-9]*\) of \1 samples" 300
same flags
shot flags
quits

echo "== a trajectory: play, pause, and a frame that is cut off =="
opens turning.xyz
mark
xdotool key --window "$window" space
waits "rate:"
waits "shown:"
shot trajectory-playing
xdotool key --window "$window" space
mark
xdotool key --window "$window" Right
waits "still: \([0-9]*\) of \1 samples"
same frame
shot trajectory-frame
quits
opens cut.xyz
shot trajectory-cut
# The file gets shorter while it is open: the frame is missing, and the window says so.
head -n 500 turning.xyz >cut.xyz
mark
xdotool key --window "$window" Left
waits "failed:"
sleep 1
shot trajectory-bad
kill -0 "$viewer" || fail "the viewer ended with a bad frame"
quits

echo "== 100,000 spheres at 800x600: pictures a second while orbiting =="
opens many.csv --size 800x600
mark
xdotool mousemove --window "$window" 450 350 mousedown 1
for step in $(seq 160); do
    xdotool mousemove --window "$window" $((450 + step % 80 * 3)) $((350 + step % 40 * 2))
    sleep 0.05
done
waits "rate:" 10
grep "rate:" said.txt
mark
xdotool mouseup 1
waits "still: \([0-9]*\) of \1 samples" 300
shot many
quits

echo "== bad input: one line, and the exit code of the other commands =="
# refused CODE WORDS ...
refused() {
    code=0
    timeout 60 "$bin/pinhole" view "${@:2}" >out.txt 2>err.txt || code=$?
    [ "$code" = "$1" ] || fail "pinhole view ${*:2}: exit code $code, not $1: $(cat err.txt)"
    [ "$(grep -c '^error: ' err.txt)" = 1 ] && [ "$(wc -l <err.txt)" = 1 ] || fail "pinhole view ${*:2}: $(cat err.txt)"
    echo "code $code: $(cat err.txt)"
}
head -c 300 /dev/urandom >bad.xyz
refused 1 missing.pdb
refused 1 bad.xyz
refused 2 helix.pdb --styel path
refused 2 helix.pdb --style nothing
refused 2 helix.txt.unknown
refused 2 -
refused 1 helix.pdb --color-by nothing
refused 2 helix.pdb --adapter "no such adapter"
DISPLAY='' refused 1 helix.pdb
VK_DRIVER_FILES=/nonexistent VK_ICD_FILENAMES=/nonexistent refused 1 helix.pdb
mkdir -p alone
cp "$bin/pinhole" alone/
code=0
PATH=/usr/bin:/bin alone/pinhole view helix.pdb >out.txt 2>err.txt || code=$?
[ "$code" = 1 ] && grep -q 'cargo install --path viewer' err.txt || fail "without a viewer: code $code, $(cat err.txt)"
echo "code $code: $(cat err.txt)"
rm -r alone
echo "done; $skipped skipped; the screenshots are in $folder"
