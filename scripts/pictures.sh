#!/usr/bin/env bash
# Makes the pictures of docs/pictures, each by the command of its page, at the size that it has there; not that of the
# Python package, gallery.png. Needs pinhole on the PATH, ffmpeg, and entry 4HHB of the Protein Data Bank.
#
#   scripts/pictures.sh 4hhb.pdb           makes them anew
#   scripts/pictures.sh --check 4hhb.pdb   fails if one differs from what its command makes
#
# Drivers round differently, and random rays give noise, so --check asks for 40 dB (PSNR), which an eye takes for equal.
set -euo pipefail

check=
if [ "${1:-}" = --check ]; then
    check=1
    shift
fi
[ $# = 1 ] || { sed -n 's/^# \{0,1\}//p' "$0" | tail -n +2 >&2; exit 2; }
data=$(realpath "$1")
cd "$(dirname "$0")/.."
pages=$PWD/docs/pictures
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp -r examples "$work"
cp "$data" "$work/examples/4hhb.pdb"
cd "$work/examples"
failed=0

# keep NAME FILE: FILE is the picture NAME.
keep() {
    if [ ! "$check" ]; then
        mv "$2" "$pages/$1"
        return
    fi
    local psnr
    psnr=$(ffmpeg -nostdin -hide_banner -i "$2" -i "$pages/$1" -lavfi psnr -f null - 2>&1 | sed -n 's/.*average:\([^ ]*\).*/\1/p' || true)
    if ! awk -v psnr="$psnr" 'BEGIN { exit !(psnr == "inf" || psnr + 0 >= 40) }'; then
        echo "docs/pictures/$1 is not what its command makes: ${psnr:-no} dB of 40; run scripts/pictures.sh, and look at it" >&2
        failed=1
    fi
}

# picture NAME FILE FLAGS: the picture NAME is a render of FILE.
picture() {
    echo "$1" >&2
    pinhole render --quiet "$2" -o made.png "${@:3}"
    keep "$1" made.png
}

(mkdir demo && cd demo && pinhole demo)
keep demo.png demo/demo.png

styles=()
for style in default fast flat studio illustration path; do
    pinhole render --quiet 4hhb.pdb -o "$style.png" --color-by chain --style "$style" --size 400x300
    styles+=(-i "$style.png")
done
ffmpeg -y -v error "${styles[@]}" -lavfi 'xstack=inputs=6:layout=0_0|w0_0|w0+w1_0|0_h0|w0_h0|w0+w1_h0' -pred mixed -pix_fmt rgb24 -frames:v 1 six.png
keep styles.png six.png

picture heme-fast.png 4hhb.pdb --select 'residue == HEM and chain == A' --bonds --view x --style fast --size 480x360
picture heme.png 4hhb.pdb --select 'residue == HEM and chain == A' --bonds --view x --size 480x360
picture three-spheres.png three-spheres.toml
picture color-b-factor.png 4hhb.pdb --color-by b_factor --cmap batlow --range ,60 \
    --legend --legend-title 'B factor (Å²)' --scale-bar=Å --size 420x315
picture color-chain.png 4hhb.pdb --color-by chain --legend=top-right --label 4HHB --scale-bar='20 Å' --size 420x315
picture first-figure.png 4hhb.pdb --select 'residue != HOH' --color-by chain --legend --label 4HHB \
    --style studio --scale-bar='20 Å' --size 640x480 --dpi 300

while read -r name size; do
    picture "light/$name.png" "$name.toml" --size "$size"
done <<'SIZES'
hemoglobin-studio 560x420
hemoglobin-path 560x420
studio 400x300
shadows 400x300
opacity 400x300
depth-cue 400x300
path 320x214
glass 320x214
emissive 320x214
sky-image 320x214
sun 320x214
thin-lens 320x214
panorama 400x200
fisheye 300x300
stereo 400x200
SIZES
exit "$failed"
