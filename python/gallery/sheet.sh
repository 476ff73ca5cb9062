#!/usr/bin/env bash
# Joins the pictures of the gallery into docs/gallery.png. Needs the program ffmpeg.
# python/gallery/run.py pictures && python/gallery/sheet.sh pictures
set -euo pipefail
docs=$(cd "$(dirname "$0")/../../docs" && pwd)
cd "$1"
inputs=() cells="" stack="" number=0
for name in galaxy lattice drum depth_of_field helix stereo labels verify turntable color_maps; do
    inputs+=(-i "$name.png")
    cells+="[$number]scale=236:176:force_original_aspect_ratio=decrease:flags=area,format=rgb24,"
    cells+="pad=240:180:(ow-iw)/2:(oh-ih)/2:white[c$number];"
    stack+="[c$number]"
    number=$((number + 1))
done
places=$(for row in 0 1; do for column in 0 1 2 3 4; do printf '|%d_%d' $((240 * column)) $((180 * row)); done; done)
palette="split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=none"
ffmpeg -y -loglevel error "${inputs[@]}" -filter_complex "$cells${stack}xstack=inputs=10:layout=${places#|},$palette" \
    -frames:v 1 "$docs/gallery.png"
ls -l "$docs/gallery.png"
