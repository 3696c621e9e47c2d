#!/bin/sh
# Compares pole-localize with MRPT's pf-localization (untouched, with our plugin): same rawlog of poles, same
# map, same start, same motions, same likelihood, 1000 particles. A simulated street of 600 m, map of one day,
# drive of another, odometry of wheels. Each run of MRPT is a process of its own, because its seed cannot be set.
# Usage: share/experiments/pf-localization.sh OUT [RUNS [WORLD]]
#   OUT    gets map, drive, the runs, table.txt and result.json
#   RUNS   of each filter, at least 5 (the spread needs them), 10 unless given; WORLD: 31 unless given
# Pairs: resampling at each scan with equal weights after it (MRPT: adaptiveSampleSize with equal bounds), and
# resampling below half of the effective particles, where MRPT 2.5.8 keeps the old weights.
# Programs: build/bin, or POLEMCL_BIN. Needs jq, mrpt-apps; 8 minutes on 2 busy cores.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 1 3 "$@"
runs=${2:-10}
world=${3:-31}
[ "$runs" -ge 5 ] || die "RUNS must be 5 or more, not $runs"
find_programs pole-simulate pole-map pole-localize pole-eval
find_tools jq pf-localization
library=$(find "$bin/../lib" -name 'libpolemcl.so' 2>/dev/null | head -n 1)
[ -n "$library" ] || die "no libpolemcl.so in $bin/../lib: build first"
make_out "$1"
settle=40 # scans at the start that do not count: 20 m
radius=0.5
turn=2

draw_drive "$out/map" "$top/config/hdl32e.ini" "$world" 0 world.length_m=600
draw_drive "$out/drive" "$top/config/hdl32e.ini" "$world" 1 world.length_m=600 simulation.drive_seed=1
map_drive "$out/map" "$out/map.polemap"
# Lines of time, x, y, yaw, from the first time that is no whole second: MRPT takes whole numbers for indices.
awk '!/^#/ && (n || $1 != int($1)) {
  n = 1
  printf "%.9f %.9f %.9f %.9f\n", $1, $2, $3, atan2(2 * ($8 * $7 + $5 * $6), $8 * $8 + $5 * $5 - $6 * $6 - $7 * $7)
}' "$out/drive.tum" >"$out/truth.txt"
awk '!/^#/ && n++ >= settle' settle=$settle "$out/drive.tum" >"$out/settled.tum"
awk '!/^#/ { print $2, $3, 2 * atan2($7, $8) * 57.29577951308232; exit }' "$out/drive.tum" >"$out/start"
read -r x y yaw <"$out/start"

# theirs NAME [PF_options.KEY=VALUE...]: runs of pf-localization, as NAME/run_NN.tum and the mean distance of the
# particles from the truth, one line a run, in NAME/distances.
theirs() {
  folder=$out/$1
  shift
  rm -rf "$folder"
  mkdir -p "$folder"
  box=$(awk -v x="$x" -v y="$y" -v a="$yaw" -v r=$radius -v t=$turn 'BEGIN {
    p = "LocalizationExperiment.init_PDF_"
    printf "%smin_x=%.6f %smax_x=%.6f %smin_y=%.6f %smax_y=%.6f %smin_yaw_deg=%.6f %smax_yaw_deg=%.6f",
      p, x - r, p, x + r, p, y - r, p, y + r, p, a - t, p, a + t }')
  # shellcheck disable=SC2086 # several words
  copy_settings "$top/config/mrpt/pf-localization.ini" "$folder/pf.ini" $box "$@" \
    "LocalizationExperiment.rawlog_file=$out/drive.rawlog" \
    "LocalizationExperiment.ground_truth_path_file=$out/truth.txt" \
    "LocalizationExperiment.logOutput_dir=$folder/pf" \
    "MetricMap_poleMap_00_creationOpts.map_file=$out/map.polemap" \
    MetricMap_poleMap_00_likelihoodOpts.far_outlier=1
  for run in $(seq -f %02g 0 $((runs - 1))); do
    rm -rf "$folder"/pf_*
    (
      # shellcheck disable=SC3045 # dash and bash know it
      ulimit -v 4000000 # kB
      LD_PRELOAD=$library timeout 300 pf-localization "$folder/pf.ini" </dev/null
    ) >"$folder/run_$run.log" 2>&1 || die "pf-localization failed: see $folder/run_$run.log"
    # One estimate a scan: (x,y,yaw in deg), rounded to 1 mm and 0.01 deg.
    sed -n 's/.*PDF estimation: (\([^,]*\),\([^,]*\),\([^d]*\)deg).*/\1 \2 \3/p' "$folder/run_$run.log" |
      paste -d ' ' "$out/drive.stamps" - | awk -v settle=$settle 'NR > settle {
        a = $4 / 57.29577951308232 / 2
        printf "%s %s %s 0 0 0 %.9f %.9f\n", $1, $2, $3, sin(a), cos(a) }' >"$folder/run_$run.tum"
    awk -v settle=$settle 'NR >= settle { sum += $1; ++n } END { printf "%.6f\n", sum / n }' \
      "$folder"/pf_*/GT_error.txt >>"$folder/distances"
  done
  evaluate_runs "$folder" "$out/settled.tum"
}

# ours NAME [SECTION.KEY=VALUE...]: the same of pole-localize. The distance of the particles follows from mean and
# covariance: the mean over 12 directions and 96 lengths of a normal distribution. The poses are rounded as
# MRPT's are.
ours() {
  folder=$out/$1
  shift
  rm -rf "$folder"
  copy_settings "$out/drive.ini" "$out/ours.ini" "$@"
  "$bin/pole-localize" --quiet --config "$out/ours.ini" --input "$out/drive.rawlog" \
    --map "$out/map.polemap" --output "$folder" --runs "$runs" --seed 1 --particles 1000 \
    --start "$x,$y,$yaw,$radius,$turn"
  for csv in "$folder"/run_*_cov.csv; do
    awk -F , -v settle=$settle '
      FNR == 1 { ++file }
      file == 1 { if (FNR > settle) { split($0, row, " "); tx[FNR] = row[2]; ty[FNR] = row[3] } next }
      FNR - 1 > settle {
        a = sqrt($6 + 1e-15); b = $7 / a; c = sqrt($9 - b * b + 1e-15)
        for (i = 0; i < 96; ++i) for (j = 0; j < 12; ++j) {
          length_ = sqrt(-2 * log((i + 0.5) / 96)); angle = (j + 0.5) * 0.5235987755982988
          u = length_ * cos(angle); v = length_ * sin(angle)
          dx = $3 + a * u - tx[FNR - 1]; dy = $4 + b * u + c * v - ty[FNR - 1]
          sum += sqrt(dx * dx + dy * dy) / 1152
        }
        ++n
      }
      END { printf "%.6f\n", sum / n }' "$out/drive.tum" "$csv" >>"$folder/distances"
  done
  for run in "$folder"/run_[0-9][0-9].tum; do
    awk -v settle=$settle '!/^#/ && n++ >= settle {
      a = sprintf("%.2f", 2 * atan2($7, $8) * 57.29577951308232) / 57.29577951308232 / 2
      printf "%s %.3f %.3f 0 0 0 %.9f %.9f\n", $1, $2, $3, sin(a), cos(a) }' "$run" >"$run.rounded"
    mv "$run.rounded" "$run"
  done
  evaluate_runs "$folder" "$out/settled.tum"
}

awk '!/^#/ { print $1 }' "$out/drive.tum" >"$out/drive.stamps"
# Ours without what MRPT's filter lacks: all detections of each scan at once, nothing but the motions' noise, and
# outliers that weigh the same at each scan.
plain="likelihood.far_outlier=1 filter.extra_sigma_m=0 filter.extra_sigma_deg=0 filter.regularization=0 filter.tempering=0 \
filter.heaviest_place=false start.particles=10000 tracking.min_hits=1 tracking.every_m=0 \
tracking.average=false search.recover=false odometry_monitor.enabled=false \
odometry_calibration.enabled=false"
theirs mrpt_each_scan
theirs mrpt_half PF_options.adaptiveSampleSize=false PF_options.resamplingMethod=3 \
  LocalizationExperiment.particles_count=1000
# shellcheck disable=SC2086 # several words
ours plain_each_scan $plain filter.resample_below=1 filter.resampling=multinomial
# shellcheck disable=SC2086
ours plain_half $plain filter.resample_below=0.5 filter.resampling=systematic start.particles=1000
ours default

# row NAME: the errors of each run, and the distance of the particles, as JSON.
row() {
  jq -s --rawfile distances "$out/$1/distances" --arg name "$1" '
    def spread: (add / length) as $m | {mean: $m, sd: ((map((. - $m) * (. - $m)) | add) / (length - 1) | sqrt)};
    {name: $name, runs: length, position_m: (map(.pos_mean) | spread), position_rmse_m: (map(.pos_rmse) | spread),
     heading_rmse_deg: (map(.ang_rmse_deg) | spread),
     particles_m: ($distances | split("\n") | map(select(. != "") | tonumber) | spread)}' \
    "$out/$1"/run_[0-9][0-9].json
}
for name in mrpt_each_scan plain_each_scan mrpt_half plain_half default; do row $name; done >"$out/rows"
# Differences of the pairs in standard errors: within Monte Carlo noise below 3.
jq -s --argjson world "$world" '
  def errors: ["position_m", "position_rmse_m", "heading_rmse_deg", "particles_m"];
  def apart($a; $b): [errors[] as $k | {key: $k, value: (($a[$k].mean - $b[$k].mean) /
    ((($a[$k].sd * $a[$k].sd) / $a.runs + ($b[$k].sd * $b[$k].sd) / $b.runs) | sqrt))}] | from_entries;
  {world: $world, filters: ., standard_errors_apart: {
    each_scan: apart(.[0]; .[1]), half: apart(.[2]; .[3])}} |
  .each_scan_within_noise = ([.standard_errors_apart.each_scan[] | fabs < 3] | all)' "$out/rows" >"$out/result.json"
rm "$out/rows"
{
  table "$out/result.json" '.filters[] | [.name, .position_m.mean, .position_m.sd, .position_rmse_m.mean,
    .heading_rmse_deg.mean, .particles_m.mean, .particles_m.sd]' filter "position m:6" sd:6 "RMSE m:6" "heading deg:5" \
    "particles m:6" sd:6
  jq -r '(.standard_errors_apart | to_entries[] | "\(.key): standard errors apart \(.value)"),
    "resampled at each scan, within Monte Carlo noise (3 standard errors): \(.each_scan_within_noise)"' "$out/result.json"
} | tee "$out/table.txt"
