#!/bin/sh
# CPU time of extraction, of a step of the filter, of a search in the whole map, of a start and of reading files.
# Usage: share/experiments/speed.sh DATA OUT
#   DATA  folder of the real scans, with kitti_raw_0005/     OUT  gets result.json
# Needs jq, python3, c++, the benchmarks built beside the programs, and a machine that does nothing else: the time
# varies by a half beside other work. Medians of 5 repetitions, those of start-and-files.sh as told there.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 2 "$@"
POLEMCL_DATA=$(cd "$1" && pwd)
export POLEMCL_DATA
find_programs bench_extraction bench_step bench_global pole-extract
find_tools jq
make_out "$2"

for bench in extraction step global; do
  "$bin/bench_$bench" --benchmark_repetitions=5 --benchmark_report_aggregates_only=true \
    --benchmark_out="$out/$bench.json" --benchmark_out_format=json >"$out/$bench.log" 2>&1
done
"$top/share/experiments/start-and-files.sh" "$POLEMCL_DATA" "$out"
jq -s --arg processor "$(sed -n 's/^model name\s*: //p' /proc/cpuinfo | head -1)" \
  '{processor: $processor, mhz: .[0].context.mhz_per_cpu, start_and_files: .[3],
    benchmarks: (.[:3] | map(.benchmarks[] | select(.aggregate_name == "median")
      | {name: .run_name, cpu: .cpu_time, unit: .time_unit} + with_entries(select(.key | IN("points", "poles", "mapPoles")))))}' \
  "$out/extraction.json" "$out/step.json" "$out/global.json" "$out/result.json" >"$out/speed.json"
mv "$out/speed.json" "$out/result.json"
