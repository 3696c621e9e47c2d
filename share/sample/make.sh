#!/bin/sh
# Makes the drives and the map of this sample anew, in less than a minute: a simulated street of 100 m on two days.
# The examples that --help shows run in a copy of this folder. The table of trees and the OSM file are made up.
# Usage: share/sample/make.sh OUT
# Programs: build/bin, or POLEMCL_BIN.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 1 "$@"
find_programs pole-simulate pole-map
mkdir -p "$1"
cd "$1"
for drive in monday:0 tuesday:1; do
  name=${drive%:*}
  "$bin/pole-simulate" --quiet --config demo.ini --length 100 --set simulation.spacing_m=1 \
    --day "${drive#*:}" --poles "$name.rawlog"
  gzip -9n <"$name.rawlog" >"$name.gz"
  mv "$name.gz" "$name.rawlog"
done
"$bin/pole-map" build --quiet --config demo.ini --input monday.rawlog --truth monday.tum --output street.polemap
