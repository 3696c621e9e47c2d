#!/bin/sh
# Measures how sigma, outlier share, gate and model of the likelihood change the accuracy: one setting at
# a time, on simulated HDL-32E streets (odometry with 2 % noise) and on the real KITTI drive split. Writes a table, a plot
# and their data as JSON.
# Usage: share/experiments/likelihood-sweep.sh DATA_DIR OUT [LENGTH [WORLD...]]
#   DATA_DIR  a folder of real scans with poses (kitti_raw_0005)
#   OUT       gets the poles of the drives (used again if they exist), table.md, sweep.svg, sweep.json
#   LENGTH    of each street, 400 m unless given; WORLD: seeds, 21 22 unless given
# Programs: build/bin, or POLEMCL_BIN. Needs jq. 10 minutes on 2 cores, half of it simulation.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 any "$@"
data=$1
out=$2
length=${3:-400}
shift 2
[ $# = 0 ] || shift
[ $# != 0 ] || set -- 21 22
find_programs pole-simulate pole-import pole-extract pole-map pole-localize pole-eval
find_tools jq
mkdir -p "$out"

for world in "$@"; do
  folder=$out/world$world
  [ -f "$folder/map.polemap" ] && continue
  # shellcheck disable=SC2086,SC2154 # several words
  for day in 0 1; do
    simulate_day "$top/config/hdl32e.ini" "$folder" "$world" "$length" $day $noise
  done
  "$bin/pole-map" build --quiet --config "$folder/day0.ini" --input "$folder/day0.rawlog" \
    --truth "$folder/day0.tum" --output "$folder/map.polemap"
done
"$top/share/experiments/kitti-split.sh" "$data" "$out/split" >/dev/null
"$bin/pole-extract" --quiet --config "$top/config/kitti.ini" --input "$out/split/odd.rawlog" \
  --output "$out/split/poles.rawlog"

# localize FOLDER CONFIG POLES TRUTH: mean position and heading error of 3 runs.
localize() {
  "$bin/pole-localize" --quiet --config "$2" --input "$1/$3" --map "$1/map.polemap" \
    --truth "$1/$4" --output "$1/sweep" --particles 1000 --runs 3 --seed 1
  evaluate_runs "$1/sweep" "$1/$4"
  awk 'END { print $2, $6 }' "$1/sweep/errors.txt"
}

# try_setting KEY VALUE WORLD...: a row of sweep.tsv.
try_setting() {
  key=$1
  value=$2
  shift 2
  for config in hdl32e kitti; do
    cp "$top/config/$config.ini" "$out/$config.ini"
    [ "$key" = default ] || copy_settings "$top/config/$config.ini" "$out/$config.ini" "likelihood.$key=$value"
  done
  streets=$(for world in "$@"; do
    localize "$out/world$world" "$out/hdl32e.ini" day1.rawlog day1.tum
  done | awk '{ p += $1; h += $2 } END { printf "%.5f\t%.5f", p / NR, h / NR }')
  split=$(localize "$out/split" "$out/kitti.ini" poles.rawlog odd.tum | tr ' ' '\t')
  printf '%s\t%s\t%s\t%s\n' "$key" "$value" "$streets" "$split" >>"$out/sweep.tsv"
}

: >"$out/sweep.tsv"
try_setting default - "$@"
for value in 0.01 0.02 0.03 0.05 0.08 0.15 0.3; do try_setting sigma_m $value "$@"; done
for value in 0.01 0.02 0.05 0.1 0.2 0.4; do try_setting outlier $value "$@"; done
for value in 0.3 0.5 1 2; do try_setting gate_m $value "$@"; done
try_setting weighted false "$@"
try_setting model paper "$@"

jq -R -s 'split("\n") | map(select(. != "") | split("\t")
    | {key: .[0], value: .[1], street_m: (.[2] | tonumber), street_deg: (.[3] | tonumber),
       split_m: (.[4] | tonumber), split_deg: (.[5] | tonumber)})' "$out/sweep.tsv" >"$out/sweep.json"
{
  echo '| setting | value | streets: position m | heading deg | KITTI split: position m | heading deg |'
  echo '|---|---|---|---|---|---|'
  awk -F '\t' '{ printf "| %s | %s | %.4f | %.3f | %.4f | %.3f |\n", $1, $2, $3, $4, $5, $6 }' \
    "$out/sweep.tsv"
} >"$out/table.md"

# One panel per setting; position errors over the value, both on logarithmic scales.
awk -F '\t' '
  function x(k, v) { return 60 + 230 * k + 180 * (log(v) - low[k]) / (high[k] - low[k]) }
  function y(e) { return 220 - 190 * (log(e) - log(0.004)) / (log(0.4) - log(0.004)) }
  BEGIN { n = split("sigma_m outlier gate_m", keys, " "); for (i = 1; i <= n; ++i) panel[keys[i]] = i - 1 }
  ($1 in panel) { k = panel[$1]; c = ++count[k]; v[k, c] = $2; e[k, c, 1] = $3; e[k, c, 2] = $5 }
  END {
    print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 760 290\" font-family=\"sans-serif\" font-size=\"11\">"
    print "<rect width=\"760\" height=\"290\" fill=\"white\"/>"
    for (k = 0; k < n; ++k) {
      low[k] = log(v[k, 1]); high[k] = log(v[k, count[k]])
      for (t = 0.005; t < 0.4; t *= 2)
        printf "<path d=\"M%d %.1fh180\" stroke=\"#ddd\"/><text x=\"%d\" y=\"%.1f\" text-anchor=\"end\">%g</text>\n", 60 + 230 * k, y(t), 56 + 230 * k, y(t) + 4, t
      for (s = 1; s <= 2; ++s) {
        printf "<polyline fill=\"none\" stroke-width=\"2\" stroke=\"%s\" points=\"", s == 1 ? "#1f6fb4" : "#c8541e"
        for (c = 1; c <= count[k]; ++c) printf "%.1f,%.1f ", x(k, v[k, c]), y(e[k, c, s])
        print "\"/>"
      }
      for (c = 1; c <= count[k]; ++c)
        printf "<text x=\"%.1f\" y=\"236\" text-anchor=\"middle\">%s</text>\n", x(k, v[k, c]), v[k, c]
      printf "<text x=\"%d\" y=\"254\" text-anchor=\"middle\">%s</text>\n", 150 + 230 * k, keys[k + 1]
    }
    print "<text x=\"60\" y=\"16\">mean position error, m: <tspan fill=\"#1f6fb4\">simulated streets</tspan>, <tspan fill=\"#c8541e\">KITTI split</tspan></text></svg>"
  }' "$out/sweep.tsv" >"$out/sweep.svg"
echo "One setting changed at a time; streets of $length m, worlds $*; 3 runs each"
cat "$out/table.md"
