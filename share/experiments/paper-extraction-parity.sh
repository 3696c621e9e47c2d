#!/bin/sh
# Compares the poles of paper mode with those of the authors' program in the same scans.
# Usage: share/experiments/paper-extraction-parity.sh DATA_DIR OUT
#   DATA_DIR  folder of scans with first_implementation/SET.csv (`scan,x,y,radius`) for each SET of
#             kitti_raw_0005, kitti_odom_00, nclt_scan; missing sets are left out
#   OUT       gets each set's poles as CSV, result.json and table.txt
# A partner of a pole lies within 2 cm, its radius within 1 cm, in the same scan, one to one (the nearest
# pairs first). `found`: share of their poles with a partner; `more`: our poles without one, as a share
# of theirs; `largest cm`: the greatest distance of partners. Rows of kitti-mended.ini: the poles
# that the mended height adds.
# Programs: build/bin, or POLEMCL_BIN. Needs jq; one minute on 2 cores.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 2 "$@"
data=$1
make_out "$2"
find_programs pole-import pole-extract
find_tools jq

# partners THEIRS OURS SIDE SCANS: one JSON object. SIDE: -1 where y counts to the right in THEIRS.
partners() {
  awk -F , -v side="$3" -v scans="$4" '
    FNR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
    NR == FNR { s[++n] = $column["scan"]; x[n] = $column["x"]; y[n] = side * $column["y"]
                r[n] = $column["radius"]; next }
    { ++ours
      for (i = 1; i <= n; ++i) {
        if (s[i] != $column["scan"]) continue
        distance = sqrt((x[i] - $column["x"]) ^ 2 + (y[i] - $column["y"]) ^ 2)
        apart = r[i] - $column["radius"]
        if (distance <= 0.02 && apart <= 0.01 && apart >= -0.01) print distance, i, ours
      } }
    END { print "counts", n, ours, scans }' "$1" "$2" | sort -g | awk '
    $1 == "counts" { theirs = $2; ours = $3; scans = $4; next }
    !($2 in left) && !($3 in right) { left[$2]; right[$3]; ++found; if ($1 > most) most = $1 }
    END { printf "{\"scans\": %d, \"theirs\": %d, \"ours\": %d, \"found\": %.4f, \"more\": %.4f, ", scans,
            theirs, ours, found / theirs, (ours - found) / theirs
          printf "\"largest_m\": %.5f}\n", most }'
}

# compare SET SIDE CONFIG: one JSON object.
compare() {
  csv=$out/$1-$(basename "$3" .ini).csv
  "$bin/pole-extract" --quiet --config "$3" --input "$out/$1.rawlog" --output "$out/poles.rawlog" \
    --csv "$csv"
  scans=$(find "$data/$1" -name '*.bin' | wc -l)
  partners "$data/first_implementation/$1.csv" "$csv" "$2" "$scans" |
    jq --arg set "$1" --arg config "$(basename "$3")" \
      '{set: $set, config: $config} + . + {ours_per_scan: (.ours / .scans)}'
}

{
  for set in kitti_raw_0005 kitti_odom_00; do
    [ -f "$data/first_implementation/$set.csv" ] || continue
    "$bin/pole-import" folder --quiet --input "$data/$set" --output "$out/$set.rawlog"
    compare $set 1 "$top/config/paper/kitti.ini"
    compare $set 1 "$top/config/paper/kitti-mended.ini"
  done
  if [ -f "$data/first_implementation/nclt_scan.csv" ]; then
    "$bin/pole-import" nclt --quiet --input "$data/nclt_scan" --output "$out/nclt_scan.rawlog"
    compare nclt_scan -1 "$top/config/paper/nclt.ini"
  fi
} | jq -s . >"$out/result.json"
rm -f "$out/poles.rawlog"
[ "$(jq length "$out/result.json")" -gt 0 ] || die "no tables in $data/first_implementation"

table "$out/result.json" '.[] | [.set, .config, .scans, .theirs, .ours, .ours_per_scan, .found * 100, .more * 100,
  .largest_m * 100]' set config scans theirs ours ours/scan:1 "found %:2" "more %:2" "largest cm:2" | tee "$out/table.txt"
