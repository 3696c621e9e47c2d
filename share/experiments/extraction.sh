#!/bin/sh
# Measures the extractor: method scan_line beside the paper's method (for the HDL-64E, also with the paper's
# height error mended).
# Usage: share/experiments/extraction.sh [--quick] DATA_DIR OUT [SEED...]
#   DATA_DIR  folder of real scans (kitti_raw_0005/ in it); missing scans are left out
#   OUT       gets result.json, table.txt, pictures and every world's own figures
#   SEED      of the simulated worlds, 201 to 205 unless given: not fitted on, but used to choose settings
#   --quick   streets of 80 m, two worlds: a test of the script, not a measurement
# Programs: build/bin, or POLEMCL_BIN. Needs jq, 1 GB of disk while it runs, 10 minutes on 2 cores.
#
# Real drive: repeatability, and poles found again when a scan is turned (pole-eval --help).
# Simulated: streets of 160 m, a scan every 0.8 m; HDL-64E with the laser angles of KITTI's unit (those
# of the extractor's model hdl64e); HDL-32E, OS1-64 (first generation) and VLP-16 with those of the data
# sheet. Per scan: pole-eval detections. `auc all` is the area under the ROC when nothing is rejected
# for its confidence. Map of one drive, one to one at 0.5 m: precision against all true poles, recall
# against the poles visible in 3 scans or more (2.4 m of the path): the others cannot be confirmed.
# Single scans: SCAN.png of each with its poles, for inspection. The poles of hdl32_pair/ under the given
# transform: each with the nearest pole of the other scan within half a metre.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"
# shellcheck source=share/experiments/extraction-parts.sh
. "$top/share/experiments/extraction-parts.sh"
# shellcheck source=share/experiments/single-scans.sh
. "$top/share/experiments/single-scans.sh"

quick=no
[ "${1-}" != --quick ] || {
  quick=yes
  shift
}
check_arguments 2 any "$@"
data=$1
make_out "$2"
shift 2
length=160
spacing=0.8
[ "$quick" = no ] || length=80
if [ $# = 0 ]; then
  set -- 201 202 203 204 205
  [ "$quick" = no ] || set -- 201 202
fi
find_tools jq
find_programs pole-import pole-extract pole-map pole-eval pole-simulate
rm -f "$out"/*.json

paper_settings "$out/paper"
[ ! -d "$data/kitti_raw_0005" ] || real_drive "$data/kitti_raw_0005"
single_scans "$data"
for sensor in hdl64e hdl32e os1_64 vlp16; do
  for seed in "$@"; do simulated_drive "$sensor" "$seed"; done
done

summarize "$quick" >"$out/result.json"
extraction_table "$out/result.json" | tee "$out/table.txt"
