#!/bin/sh
# sh examples/five-nights.sh FOLDER: five nights of one specimen, FOLDER/night1 to FOLDER/night5.
#
# Each night a mesher places the nodes a little elsewhere: here by up to 2 microns, where the shortest edge has 54. In the
# fourth night one node has come so close to the opposite face of element 11245 that this is a sliver. A cylinder of
# hexahedra is made with it and stays as it is.
set -eu
examples=$(dirname "$0")
for night in 1 2 3 4 5; do
    mkdir -p "$1/night$night"
    awk -F ', *' -v OFS=', ' -v night="$night" '
        /^\*/ { nodes = ($1 ~ /^\*NODE/) }
        nodes && /^[0-9]/ {
            for (axis = 2; axis <= 4; axis++) $axis = sprintf("%.9g", $axis + 0.002 * sin(12.9898 * $1 + 78.233 * night + axis))
            if (night == 4 && $1 == 3286) { $2 = 2.116; $3 = 0.0952; $4 = 12.6682 }
        }
        { print }
    ' "$examples/drop/pit-specimen.inp" >"$1/night$night/pit-specimen.inp"
    meshgauge generate swept-cylinder --elements 2500 --quiet --output "$1/night$night/cylinder.vtu"
done
