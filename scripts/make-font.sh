#!/usr/bin/env bash
# Writes crates/figure/src/annotate/font/OpenSans-subset.ttf from Open Sans Regular 1.10 (Apache-2.0), for example of Debian's package
# fonts-open-sans. Needs fonttools (`pip install fonttools`).
#
#   scripts/make-font.sh OpenSans-Regular.ttf
set -euo pipefail
target=$(cd "$(dirname "$0")/.." && pwd)/crates/figure/src/annotate/font/OpenSans-subset.ttf
# Latin with its accents, Greek, Cyrillic, punctuation, and signs of the sciences.
pyftsubset "$1" --output-file="$target" --no-hinting --desubroutinize --layout-features='' \
    --drop-tables+=GSUB,GPOS,GDEF,kern,DSIG,gasp --name-IDs=0,1,2,5,13 --notdef-outline \
    --unicodes=U+0020-007E,U+00A0-017F,U+0391-03A9,U+03B1-03C9,U+0410-044F,U+2010-2015,U+2018-201E,U+2020-2022,U+2026,U+2030,U+2032-2033,U+20AC,U+2122,U+2126,U+212B,U+2202,U+2206,U+2211,U+2212,U+221A,U+221E,U+2248,U+2260,U+2264,U+2265
