#!/usr/bin/env bash
# Renders on a real Slurm of two nodes and on a real Dask cluster of two workers, all on this machine, with processes that
# are killed at random and a node that is set down; what is merged must be the bytes of one machine. Says how long two nodes
# take beside one, each of one core, which means something only where nothing else runs.
#
# Exit code 3: something could not be run, and it says what is missing; the rest passed.
#
# PINHOLE_PROGRAM names the program; PINHOLE_FRAMES the number of frames, 200 by default; PINHOLE_PYTHON a Python that has the
# package pinhole and dask.
set -euo pipefail
cd "$(dirname "$0")"

program=$(realpath "${PINHOLE_PROGRAM:-../../target/release/pinhole}")
frames=${PINHOLE_FRAMES:-200}
base_port=$((17000 + RANDOM % 2000 * 3))
work=$(mktemp -d)
pids=()
started_munge=
finish() {
    for pid in ${pids[@]+"${pids[@]}"}; do kill "$pid" 2>/dev/null || true; done
    wait 2>/dev/null || true
    [ -z "$started_munge" ] || kill "$(cat /run/munge/munged.pid 2>/dev/null)" 2>/dev/null || true
    rm -rf "$work"
}
trap finish EXIT

skipped=()
skip() {
    skipped+=("SKIPPED: $1")
    echo "${skipped[-1]}" >&2
}

# One thread each, so that a node is one core. The device is the CPU, which every machine has.
export RAYON_NUM_THREADS=1
export PINHOLE_SIZE=160x120 PINHOLE_SAMPLES=8
flags="--frames : --backend cpu --size $PINHOLE_SIZE --samples $PINHOLE_SAMPLES"
cd "$work"
awk -v frames="$frames" 'BEGIN { for (f = 0; f < frames; f++) { print "40\nframe"; for (i = 0; i < 40; i++)
    printf "%s %.3f %.3f %.3f\n", (i % 3 ? "H" : "O"), 4 * sin(i + f * 0.01), 4 * cos(i * 1.7 + f * 0.02), 4 * sin(i * 0.6 - f * 0.015) } }' >a.xyz

echo "== one machine: $frames frames =="
mkdir one
# shellcheck disable=SC2086 # These are words.
"$program" render a.xyz $flags --layer depth=one/d%03d.npy -o one/f%03d.png -q
# shellcheck disable=SC2086
"$program" render a.xyz $flags -o one/m.apng -q

# What the recipes of docs/how-to/clusters.md call `pinhole`.
page=$OLDPWD/../../docs/how-to/clusters.md
mkdir bin
ln -s "$program" bin/pinhole

# same FOLDER: compares all files with those of one machine.
same() {
    local count
    count=$(find one -type f | wc -l)
    [ "$(find "$1" -type f | wc -l)" = "$count" ] || { echo "$1 has not all $count files" >&2; return 1; }
    diff -rq one "$1"
    echo "the same bytes: $count files"
}

split() {
    # shellcheck disable=SC2086
    "$program" job split a.xyz $flags --tiles 2x2 --layer depth -o "$1" -q
}

if command -v slurmctld slurmd sbatch munged >/dev/null && [ "$(id -u)" = 0 ]; then
    # shellcheck source=slurm.sh
    . "$OLDPWD/slurm.sh"
    start_slurm
    echo "== Slurm of two nodes: random kills, and a node set down =="
    split killed
    mkdir killed-out
    # submit JOB UNITS AT_ONCE MERGE_FLAGS: the recipe of docs/how-to/clusters.md, with other numbers.
    submit() {
        rm -f JOB
        ln -s "$1" JOB
        for name in part submit; do
            { echo '#!/bin/bash'; sed -n "/^# $name.sh: /,/^\`\`\`/p" "$page" | grep -v '^```'; } >$name.sh
        done
        sed -i "s/-n 8/-n $2/; s/%100/%$3/; s|-o movie.apng|$4|" submit.sh
        PATH=$work/bin:$PATH bash submit.sh
    }
    submit killed 8 100 "--layer depth=killed-out/d%03d.npy -o killed-out/f%03d.png"
    killed=0
    end=$((SECONDS + 600))
    down=0
    while [ -n "$(squeue --noheader --name=pinhole-part)" ] && [ "$SECONDS" -lt "$end" ]; do
        sleep "0.$((RANDOM % 4 + 1))"
        # What renders a part now, and not this script.
        mapfile -t running < <(pgrep -f "^pinhole job part JOB" || true)
        if [ ${#running[@]} -gt 0 ] && [ "$killed" -lt 40 ]; then
            kill -KILL "${running[RANDOM % ${#running[@]}]}" 2>/dev/null && killed=$((killed + 1))
        fi
        if [ "$down" = 0 ] && [ "$killed" -ge 5 ]; then
            scontrol update NodeName=n2 State=DOWN Reason=test
            down=1
        elif [ "$down" = 1 ] && [ "$killed" -ge 10 ]; then
            # It may have come back by itself.
            scontrol update NodeName=n2 State=RESUME 2>/dev/null || true
            down=2
        fi
    done
    [ "$down" != 1 ] || scontrol update NodeName=n2 State=RESUME 2>/dev/null || true
    # Tasks that failed are submitted again, until none is missing.
    for _ in 1 2 3 4 5; do
        wait_for_slurm 600
        [ -z "$("$program" job status killed --missing)" ] && [ -e "killed-out/f$(printf %03d $((frames - 1))).png" ] && break
        submit killed 8 100 "--layer depth=killed-out/d%03d.npy -o killed-out/f%03d.png"
    done
    wait_for_slurm 600
    echo "$killed processes were killed; node n2 was set down: $([ "$down" = 0 ] && echo no || echo yes)"
    "$program" job merge killed -o killed-out/m.apng -q
    same killed-out

    echo "== Slurm: two nodes beside one =="
    # Each task has so much work that starting it does not count.
    times=()
    for limit in 1 2; do
        # shellcheck disable=SC2086
        "$program" job split a.xyz ${flags/$PINHOLE_SIZE/320x240} --tiles 2x2 -o "speed$limit" -q
        began=$(date +%s.%N)
        submit "speed$limit" $((frames / 2)) "$limit" "-o speed$limit.apng"
        wait_for_slurm 3000
        [ -z "$("$program" job status "speed$limit" --missing)" ]
        times+=("$(awk -v a="$began" -v b="$(date +%s.%N)" 'BEGIN { print b - a }')")
    done
    awk -v one="${times[0]}" -v two="${times[1]}" -v frames="$frames" 'BEGIN {
        printf "one node %.1f s, two nodes %.1f s: %.2f times as fast (%d frames of 320x240, 2x2 tiles)\n", one, two, one / two, frames }'
else
    skip "Slurm: this needs root and apt-get install slurmctld slurmd slurm-client munge"
fi

python=${PINHOLE_PYTHON:-python3}
if "$python" -c 'import dask.distributed, pinhole' 2>/dev/null; then
    echo "== Dask of two workers, with one killed =="
    PINHOLE_PROGRAM=$program "$python" "$OLDPWD/dask_farm.py" "$frames" dask-out
    same dask-out
else
    skip "Dask: $python has no package dask or pinhole; pip install 'dask[distributed]' and the wheel"
fi

# The other recipes of docs/how-to/clusters.md, for the number of units that this job has.
# shellcheck disable=SC2086
"$program" job split a.xyz ${flags/--frames :/--frames :5} --tiles 2x2 -o recipe -q
# shellcheck disable=SC2086
"$program" render a.xyz ${flags/--frames :/--frames :5} -o recipe.apng -q
recipe() {
    rm -f recipe/parts/* movie.apng JOB
    ln -s recipe JOB
    PATH=$work/bin:$PATH "$@"
    cmp recipe.apng movie.apng
    echo "the same bytes"
}
if command -v parallel >/dev/null; then
    echo "== GNU parallel =="
    line=$(grep '| parallel ' "$page" | sed 's/--sshlogin [^ ]* //; s/f%04d.png/movie.apng/')
    recipe bash -c "$line" 2>/dev/null
else
    skip "GNU parallel: apt-get install parallel"
fi
snakemake=$(dirname "$(command -v "$python" || echo .)")/snakemake
[ -x "$snakemake" ] || snakemake=$(command -v snakemake || true)
if [ -n "$snakemake" ]; then
    echo "== Snakemake =="
    sed -n '/^# Snakefile/,/^```/p' "$page" | grep -v '^```' | sed 's/range(40)/range(20)/' >Snakefile
    recipe "$snakemake" --cores 2 --quiet all
else
    skip "Snakemake: pip install snakemake"
fi

if [ ${#skipped[@]} -gt 0 ]; then
    printf '%s\n' "${skipped[@]}" >&2
    exit 3
fi
