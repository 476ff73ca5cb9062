#!/bin/sh
# Turns the atoms of a PDB file into XYZ, without water:  examples/pdb-to-xyz.sh 4hhb.pdb > 4hhb.xyz
# With --chains before the file, atoms are called by their chain, or by their molecule if they are in none, not by
# their element; a scene file then gives each its color and radius. Columns are counted from 1, as the format does.
set -eu
by_chain=0
if [ "${1-}" = --chains ]; then by_chain=1; shift; fi
awk -v by_chain="$by_chain" '
    /^(ATOM  |HETATM)/ && substr($0, 18, 3) != "HOH" {
        name = substr($0, 77, 2)
        if (name ~ /^ *$/) name = substr($0, 13, 2)     # in old files: " C" of " CA " is carbon, "FE" iron
        if (by_chain) name = /^ATOM/ ? substr($0, 22, 1) : substr($0, 18, 3)
        gsub(/[^A-Za-z]/, "", name)
        if (!by_chain) name = toupper(substr(name, 1, 1)) tolower(substr(name, 2))
        atoms[++n] = name " " substr($0, 31, 8) " " substr($0, 39, 8) " " substr($0, 47, 8)
    }
    /^ENDMDL/ { exit }                                  # the first model is enough
    END {
        print n + 0
        print "atoms of a PDB file, in angstroms"
        for (i = 1; i <= n; i++) print atoms[i]
    }
' "$@"
