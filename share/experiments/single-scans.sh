# Sourced by extraction.sh, which sets $top, $bin, $out: single real scans, drawn, and a pair of them.
# shellcheck shell=sh disable=SC2154

# draw NAME CONFIG RAWLOG: NAME.png and NAME.csv.
draw() {
  "$bin/pole-extract" --quiet --config "$2" --input "$3" --output "$out/singles/$1.poles.rawlog" \
    --csv "$out/$1.csv" --png "$out/$1.png"
}

# pair_agreement CSV RELATIVE: how far the poles of two scans are apart, as JSON. RELATIVE takes points
# of the second scan to the first; poles belong together when each is the other's nearest within 0.5 m.
pair_agreement() {
  awk -F '[ ,]+' '
    FNR == NR { gsub(/^ +/, ""); for (i = 1; i <= 4; ++i) T[FNR, i] = $i; next }
    FNR == 1 { next }
    $1 == 0 { ax[++a] = $3; ay[a] = $4 }
    $1 == 1 { bx[++b] = T[1,1] * $3 + T[1,2] * $4 + T[1,4]; by[b] = T[2,1] * $3 + T[2,2] * $4 + T[2,4] }
    function distance(i, k) { return sqrt((ax[i] - bx[k]) ^ 2 + (ay[i] - by[k]) ^ 2) }
    END {
      for (i = 1; i <= a; ++i) {
        k = 0
        for (j = 1; j <= b; ++j) if (distance(i, j) < 0.5 && (!k || distance(i, j) < distance(i, k))) k = j
        for (j = 1; k && j <= a; ++j) if (distance(j, k) < distance(i, k)) k = 0
        if (k) print distance(i, k)
      }
      print a, b
    }' "$2" "$1" >"$out/singles/pair.txt"
  awk 'NF == 2 { print }' "$out/singles/pair.txt" >"$out/singles/counts.txt"
  awk 'NF == 1 { print }' "$out/singles/pair.txt" | sort -g | jq -s \
    --argjson a "$(cut -d ' ' -f 1 "$out/singles/counts.txt")" \
    --argjson b "$(cut -d ' ' -f 2 "$out/singles/counts.txt")" \
    '{poles: [$a, $b], matched: length, within_10cm: map(select(. < 0.1)) | length,
      median_m: .[(length - 1) / 2 | floor], p90_m: .[(length - 1) * 0.9 | floor], max_m: max}'
}

# single_scans DATA_DIR: pictures of what is there; pair.json.
single_scans() {
  mkdir -p "$out/singles"
  if [ -d "$1/nclt_scan" ]; then
    "$bin/pole-import" nclt --quiet --input "$1/nclt_scan" --output "$out/singles/nclt.rawlog"
    draw nclt_scan "$top/config/nclt.ini" "$out/singles/nclt.rawlog"
  fi
  if [ -d "$1/os1_64" ]; then
    # A second generation OS1 ("45 degrees").
    copy_settings "$top/config/mulran.ini" "$out/singles/os1.ini" sensor.model=os1_64_gen2
    "$bin/pole-import" pcd --quiet --input "$1/os1_64" --output "$out/singles/os1.rawlog"
    draw os1_64 "$out/singles/os1.ini" "$out/singles/os1.rawlog"
  fi
  if [ -d "$1/hdl32_pair" ]; then
    "$bin/pole-import" pcd --quiet --input "$1/hdl32_pair" --output "$out/singles/pair.rawlog"
    draw hdl32_pair "$top/config/hdl32e.ini" "$out/singles/pair.rawlog"
    pair_agreement "$out/hdl32_pair.csv" "$1/hdl32_pair/relative.txt" >"$out/pair.json"
  fi
  vlp16=/usr/share/mrpt/datasets/test_velodyne_VLP16.rawlog
  [ ! -f $vlp16 ] || draw vlp16 "$top/config/vlp16.ini" $vlp16
}
