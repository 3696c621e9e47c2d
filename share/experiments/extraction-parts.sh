# Sourced by scripts that set $top, $bin, $out, $length, $spacing: the steps.
# shellcheck shell=sh disable=SC2154

# scan_line_settings SENSOR: the configuration of that sensor.
scan_line_settings() {
  case $1 in
    hdl64e) echo "$top/config/kitti.ini" ;;
    os1_64) echo "$top/config/mulran.ini" ;;
    *) echo "$top/config/$1.ini" ;;
  esac
}

# paper_settings DIR: the authors' settings for each sensor. A sensor for which they had none gets NCLT's, with
# the sensor and its rows and field of view exchanged.
paper_settings() {
  mkdir -p "$1"
  cp "$top/config/paper/kitti.ini" "$1/hdl64e.ini"
  cp "$top/config/paper/kitti-mended.ini" "$1/hdl64e-mended.ini"
  cp "$top/config/paper/mulran.ini" "$1/os1_64.ini"
  for sensor in hdl32e vlp16; do
    case $sensor in
      hdl32e) rows="range_image.fov_up_deg=10.67 range_image.fov_down_deg=-30.67" ;;
      vlp16) rows="range_image.rows=16 range_image.fov_up_deg=15 range_image.fov_down_deg=-15" ;;
    esac
    # shellcheck disable=SC2086 # several words
    copy_settings "$top/config/paper/nclt.ini" "$1/$sensor.ini" sensor.model=$sensor sensor.upside_down=false \
      "sensor.origin=0 0 0" sensor.height_m=1.0 range_image.heights_above_ground=true \
      range_image.mirrored=false range_image.coordinate_step_m=0 $rows
  done
}

# methods SENSOR: the methods to compare. The authors' settings for the HDL-64E come twice: as they are, and with
# the height of the top counted from the ground (mended).
methods() {
  if [ "$1" = hdl64e ]; then echo scan_line mended paper; else echo scan_line paper; fi
}

# settings METHOD SENSOR: the file.
settings() {
  case $1 in
    paper) echo "$out/paper/$2.ini" ;;
    mended) echo "$out/paper/$2-mended.ini" ;;
    *) scan_line_settings "$2" ;;
  esac
}

# real_drive FOLDER: real_METHOD.json with repeatability and rotation.
real_drive() {
  work=$out/real
  mkdir -p "$work"
  "$bin/pole-import" folder --quiet --input "$1" --output "$work/scans.rawlog"
  for method in $(methods hdl64e); do
    config=$(settings "$method" hdl64e)
    "$bin/pole-extract" --quiet --config "$config" --input "$work/scans.rawlog" \
      --output "$work/$method.rawlog"
    "$bin/pole-eval" repeatability --quiet --poles "$work/$method.rawlog" \
      --truth "$work/scans.tum" --json "$work/again.json"
    "$bin/pole-eval" rotation --quiet --config "$config" --input "$work/scans.rawlog" --every 8 \
      --json "$work/turned.json"
    jq -n --slurpfile r "$work/again.json" --slurpfile t "$work/turned.json" \
      '{repeatability: $r[0], rotation: $t[0]}' >"$out/real_$method.json"
  done
}

# map_score METHOD TRUTH METRIC: precision or recall of the world's map; 0 without a map.
map_score() {
  if [ -f "$work/$1.polemap" ]; then
    score_map 0.5 "$2" "$work/$1.polemap" "$work/map.json"
    json_value "$work/map.json" "$3"
  else
    echo 0
  fi
}

# simulated_drive SENSOR SEED: SENSOR_METHOD_SEED.json for each method; the scans are removed again.
simulated_drive() {
  work=$out/world
  rm -rf "$work"
  mkdir -p "$work"
  copy_settings "$(scan_line_settings "$1")" "$work/scan_line.ini" "world.seed=$2" "world.length_m=$length" \
    "simulation.spacing_m=$spacing"
  "$bin/pole-simulate" --quiet --config "$work/scan_line.ini" --output "$work/scans"
  "$bin/pole-import" folder --quiet --input "$work/scans" --output "$work/scans.rawlog"
  for method in $(methods "$1"); do
    [ "$method" = scan_line ] || cp "$(settings "$method" "$1")" "$work/$method.ini"
    evaluate_drive "$method"
    auc_all=null
    [ "$method" != scan_line ] || auc_all=$(undecided_auc)
    "$bin/pole-map" build --quiet --config "$work/$method.ini" --input "$work/$method.rawlog" \
      --truth "$work/scans.tum" --output "$work/$method.polemap" 2>"$work/$method.log" ||
      grep -q 'no pole' "$work/$method.log" || die "$(cat "$work/$method.log")"
    jq --argjson seed "$2" --argjson auc "$auc_all" \
      --argjson p "$(map_score "$method" "$work/scans/poles_gt.csv" precision)" \
      --argjson r "$(map_score "$method" "$work/visible.csv" recall)" \
      '{seed: $seed} + . + {auc_all: $auc, map_precision: $p, map_recall: $r,
        map_f1: (if $p + $r > 0 then 2 * $p * $r / ($p + $r) else 0 end)}' \
      "$work/score.json" >"$out/$1_${method}_$2.json"
  done
  rm -r "$work"
}

# evaluate_drive METHOD: METHOD.rawlog, score.json, visible.csv.
evaluate_drive() {
  "$bin/pole-extract" --quiet --config "$work/$1.ini" --input "$work/scans.rawlog" \
    --output "$work/$1.rawlog"
  "$bin/pole-eval" detections --quiet --scans "$work/scans" --poles "$work/$1.rawlog" \
    --json "$work/score.json" --visible "$work/visible.csv" --min-scans 3
}

# undecided_auc: area under the ROC of the confidence of scan_line when it rejects nothing.
undecided_auc() {
  copy_settings "$work/scan_line.ini" "$work/undecided.ini" scan_line.min_confidence=0.001
  cp "$work/score.json" "$work/scan_line-score.json"
  evaluate_drive undecided
  json_value "$work/score.json" auc
  mv "$work/scan_line-score.json" "$work/score.json"
}

# summarize QUICK: all figures as one JSON object on standard output.
summarize() {
  {
    [ ! -f "$out/pair.json" ] || jq '{pair: .}' "$out/pair.json"
    for method in $(methods hdl64e); do
      [ ! -f "$out/real_$method.json" ] || jq --arg m "$method" '{real: {($m): .}}' "$out/real_$method.json"
    done
    for sensor in hdl64e hdl32e os1_64 vlp16; do
      for method in $(methods $sensor); do
        # The mean, least and greatest of every figure over the worlds.
        jq -s --arg s $sensor --arg m "$method" '
          def over(f): . as $worlds | (.[0] | keys_unsorted) - ["seed"]
            | map({key: ., value: (. as $k | [$worlds[] | .[$k] | numbers]
                  | if length == 0 then null else f end)}) | from_entries;
          {simulated: {($s): {($m): {mean: over(add / length), min: over(min), max: over(max),
                                     worlds: .}}}}' "$out/${sensor}_${method}"_*.json
      done
    done
  } | jq -s --arg quick "$1" --argjson length "$length" --argjson spacing "$spacing" '
    {quick: ($quick == "yes"), length_m: $length, spacing_m: $spacing} + reduce .[] as $part ({}; . * $part)'
}

# extraction_table FILE: the figures as tables.
# shellcheck disable=SC2016,SC2046 # names of jq; lists of words
extraction_table() {
  jq -r 'select(.quick) | "QUICK RUN: not to judge by"' "$1"
  [ ! -f "$out/real_paper.json" ] ||
    table "$1" '.real as $methods | ["poles per scan", "repeatability", "per_scan"], ["found again in the next scans",
      "repeatability", "share"], ["found again when turned", "rotation", "share"], ["turned poles that were there",
      "rotation", "back_share"] | . as [$name, $kind, $key] | [$name, ($methods | .scan_line, .mended, .paper
      | .[$kind][$key])]' "real drive" scan_line:3 "paper mended:3" paper:3
  jq -r 'def cm: . * 1000 | round / 10; .pair // empty | "", "Pair of real scans: \(.poles[0]) and \(.poles[1]) poles, "
    + "\(.matched) of them in both, apart by \(.median_m | cm) cm (median), \(.p90_m | cm) cm (90 %), "
    + "\(.max_m | cm) cm (most); \(.within_10cm) within 10 cm"' "$1"
  for sensor in hdl64e hdl32e os1_64 vlp16; do
    printf '\nSimulated %s, worlds %s\n' $sensor "$(jq ".simulated.$sensor.scan_line.worlds[].seed" "$1" | paste -s -d ' ')"
    table "$1" ".simulated.$sensor"' as $methods | ["precision", "precision", 1], ["recall of visible poles", "recall", 1],
      ["centre error, median (cm)", "centre_median_m", 100], ["centre error, mean (cm)", "centre_mean_m", 100],
      ["centre error, 90 % (cm)", "centre_p90_m", 100], ["bias along the ray (cm)", "bias_along_m", 100],
      ["bias across (cm)", "bias_across_m", 100], ["radius error, median (cm)", "radius_abs_median_m", 100],
      ["squared error, mean (2)", "nees_mean", 1], ["squared error, median (1.39)", "nees_median", 1], ["auc", "auc", 1],
      ["auc all", "auc_all", 1], ["map precision", "map_precision", 1], ["map recall", "map_recall", 1],
      ["map F1", "map_f1", 1] | . as [$name, $key, $scale] | [$name, ($methods | .scan_line, .mended, .paper | values
      | (.mean, .min, .max)[$key] | if . then . * $scale else . end)]' mean \
      $(for method in $(methods $sensor); do echo "$method:3 least:3 most:3"; done)
  done
}
