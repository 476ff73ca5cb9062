#!/usr/bin/env bash
# Joins the pictures of the gallery into docs/pictures/gallery.png. Needs the program ffmpeg.
# python/gallery/run.py pictures && python/gallery/sheet.sh pictures
set -euo pipefail
docs=$(cd "$(dirname "$0")/../../docs" && pwd)
cd "$1"
inputs=() cells="" stack="" number=0
# Four in a row; the last two are twice as wide.
places=""
for name in galaxy lattice drum depth_of_field helix labels stereo verify turntable color_maps; do
    width=$((number < 8 ? 300 : 600))
    places+="|$((number < 8 ? number % 4 * 300 : (number - 8) * 600))_$((number / 4 * 225))"
    inputs+=(-i "$name.png")
    cells+="[$number]scale=$((width - 6)):219:force_original_aspect_ratio=decrease:flags=area,format=rgb24,"
    cells+="pad=$width:225:(ow-iw)/2:(oh-ih)/2:white[c$number];"
    stack+="[c$number]"
    number=$((number + 1))
done
palette="split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=sierra2_4a"
ffmpeg -y -loglevel error "${inputs[@]}" -filter_complex "$cells${stack}xstack=inputs=10:layout=${places#|},$palette" \
    -frames:v 1 "$docs/pictures/gallery.png"
ls -l "$docs/pictures/gallery.png"
