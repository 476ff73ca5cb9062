#!/bin/sh
# Turns the atoms of a PDB file into XYZ, without water:  examples/pdb-to-xyz.sh 4hhb.pdb > 4hhb.xyz
# A line of XYZ is a name, x, y and z; before all atoms are how many there are, and a comment.
set -eu
awk '
    /^(ATOM  |HETATM)/ && substr($0, 18, 3) != "HOH" {
        element = substr($0, 77, 2)                     # columns of the format, counted from 1
        gsub(/[^A-Za-z]/, "", element)
        if (element == "") {                            # old files name the atom alone: " CA " is carbon, "FE  " iron
            element = substr($0, 13, 2)
            gsub(/[^A-Za-z]/, "", element)
        }
        element = toupper(substr(element, 1, 1)) tolower(substr(element, 2))
        atoms[++n] = element " " substr($0, 31, 8) " " substr($0, 39, 8) " " substr($0, 47, 8)
    }
    /^ENDMDL/ { exit }                                  # the first model is enough
    END {
        print n + 0
        print "atoms of a PDB file, in angstroms"
        for (i = 1; i <= n; i++) print atoms[i]
    }
' "$@"
