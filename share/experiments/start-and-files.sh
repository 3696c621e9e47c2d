#!/bin/sh
# CPU time of a program's start and of its help, and of one scan from file to file, one core, in one run; and how long
# a program waits until its output is on the disk.
# Usage: share/experiments/start-and-files.sh DATA OUT [BIN...]
#   DATA  folder of the real scans     OUT  folder for results, on the disk that is measured
#   BIN   folders of programs to compare, POLEMCL_BIN or build/bin unless given
# Needs python3 and c++. Prints the median of 9 starts, of 5 runs over the 80 scans of drive 0005, and of 15 runs each
# that write a map as a table, or a folder of two simulated scans; OUT/result.json has those of the first BIN.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
# shellcheck source=share/experiments/common.sh
. "$top/share/experiments/common.sh"

check_arguments 2 any "$@"
data=$1 out=$2
shift 2
find_programs pole-import pole-extract pole-localize pole-map pole-simulate
[ $# -gt 0 ] || set -- "$bin"
mkdir -p "$out"

# Two rawlogs with their clouds inside: the drive, and two scans of it, which cost the start.
for every in 1 40; do
  "$bin/pole-import" folder --quiet --embed --every $every --input "$data/kitti_raw_0005" \
    --output "$out/every$every.rawlog"
done
# An empty program, linked to what MRPT's libraries the programs need.
echo 'int main() {}' >"$out/empty.cpp"
c++ -O1 "$out/empty.cpp" -o "$out/empty" -Wl,--no-as-needed -lmrpt-slam -lmrpt-maps -lmrpt-obs \
  -lmrpt-opengl -lmrpt-config
# Tells how long the calls that wait for the disk took.
cat >"$out/waits.cpp" <<'END'
#include <dlfcn.h>
#include <chrono>
#include <cstdio>
struct Waited {
  double ms = 0;
  ~Waited() { std::fprintf(stderr, "%f\n", ms); }
} waited;
int timed(const char* name, int file) {
  const auto begin = std::chrono::steady_clock::now();
  const int result = reinterpret_cast<int (*)(int)>(dlsym(RTLD_NEXT, name))(file);
  waited.ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return result;
}
extern "C" int fsync(int file) { return timed("fsync", file); }
extern "C" int syncfs(int file) { return timed("syncfs", file); }
END
c++ -shared -fPIC "$out/waits.cpp" -o "$out/waits.so"

python3 - "$top/config/kitti.ini" "$top/config/demo.ini" "$out" "$@" <<'END'
import json, os, resource, statistics, subprocess, sys

kitti, demo, out, folders = sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:]

def milliseconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return 1e3 * (after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime)

def waited(command):
    done = subprocess.run(command, env=os.environ | {"LD_PRELOAD": out + "/waits.so"}, check=True,
                          stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    return float(done.stderr.split()[-1])

def interleaved(commands, rounds, measure=milliseconds):
    times = [[] for _ in commands]
    for _ in range(rounds):
        for k, command in enumerate(commands):
            times[k].append(measure(command))
    return [statistics.median(t) for t in times]

starts = [[out + "/empty"]]
for folder in folders:
    starts += [[f"{folder}/pole-localize", "--version"], [f"{folder}/pole-localize", "--help"],
               [f"{folder}/pole-map", "build", "--help"], [f"{folder}/pole-map", "no-such-command"]]
print("CPU ms, median of 9")
start_times = interleaved(starts, 9)
for command, time in zip(starts, start_times):
    print(f"{time:8.1f}  {' '.join(command)}")

def extract(folder, every):
    return [f"{folder}/pole-extract", "--quiet", "--threads", "1", "--config", kitti, "--input",
            f"{out}/every{every}.rawlog", "--output", f"{out}/poles.rawlog"]

runs = [extract(folder, every) for folder in folders for every in (1, 40)]
times = interleaved(runs, 5)
print("file to file, CPU ms, median of 5: a scan beyond a run over two; that run")
for k, folder in enumerate(folders):
    print(f"{(times[2 * k] - times[2 * k + 1]) / 78:8.2f} {times[2 * k + 1]:8.1f}  {folder}")

bin, simulated = folders[0], ["--quiet", "--config", demo, "--length", "40"]
subprocess.run([bin + "/pole-simulate", *simulated, "--poles", out + "/drive.rawlog", "--set",
                "simulation.detections=hdl32e.json"], check=True)
subprocess.run([bin + "/pole-map", "build", "--quiet", "--config", demo, "--input", out + "/drive.rawlog", "--truth",
                out + "/drive.tum", "--output", out + "/street.polemap"], check=True)
waits = interleaved([[bin + "/pole-map", "convert", out + "/street.polemap", "--output", out + "/street.csv"],
                     [bin + "/pole-simulate", *simulated, "--set", "simulation.spacing_m=20", "--output",
                      out + "/scans"]], 15, waited)
print(f"until the output is on the disk, ms, median of 15: {waits[0]:.1f} a file, {waits[1]:.1f} a folder")
with open(out + "/result.json", "w") as file:
    json.dump({"file_to_file_ms_a_scan": round((times[0] - times[1]) / 78, 2),
               "empty_program_ms": round(start_times[0], 1), "start_ms": round(start_times[1], 1),
               "help_ms": round(start_times[2], 1),
               "until_on_disk_ms": {"file": round(waits[0], 1), "folder": round(waits[1], 1)}}, file)
END
