#!/usr/bin/env python3
"""Measures one part of tests/long/run.sh; adds its figures to OUT/long.json.

Exits with 1 when a promise is broken.
"""
import argparse
import datetime
import filecmp
import hashlib
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import time
import types

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "benchmark"))
import packet_rate  # noqa: E402

GROWTH = 5.0  # MB
SLOWEST = 5.0  # of 99.9 % of the steps, in medians
RATE = 10  # scans a second


def resident(pid):
    """MB; none when the process is gone."""
    try:
        status = pathlib.Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return None
    lines = [line for line in status.splitlines() if line.startswith("VmRSS:")]
    return int(lines[0].split()[1]) / 1024 if lines else None


def largest_child(pid):
    """The resident memory of the largest process that it has started and that still runs, MB."""
    try:
        lists = [file.read_text() for file in pathlib.Path(f"/proc/{pid}/task").glob("*/children")]
    except OSError:  # a thread has ended
        return 0
    return max((resident(child) or 0 for child in " ".join(lists).split()), default=0)


def waited(pid):
    """How long its main thread could have run, but had no core, s: of a busy machine."""
    return int(pathlib.Path(f"/proc/{pid}/schedstat").read_text().split()[1]) / 1e9


class Memory(threading.Thread):
    """Resident memory of a process, once a second, with what `reached` says then."""

    def __init__(self, pid, reached):
        super().__init__(daemon=True)
        self.pid, self.reached, self.samples, self.waited = pid, reached, [], 0.0
        self.largest_child = 0.0
        self.start()

    def run(self):
        while (size := resident(self.pid)) is not None:
            self.samples.append((self.reached(), size))
            self.waited = waited(self.pid)
            self.largest_child = max(self.largest_child, largest_child(self.pid))
            time.sleep(1)

    def figures(self, begin):
        """\\param begin What must be reached for the first value."""
        later = [size for reached, size in self.samples if reached >= begin]
        if not later:
            return {"samples": 0}
        return {"begin_mb": round(later[0], 1), "largest_later_mb": round(max(later), 1),
                "end_mb": round(later[-1], 1), "growth_mb": round(max(later) - later[0], 1),
                "samples": len(later)}


class Drive(threading.Thread):
    """A run of pole-localize, whose stream is read to its end."""

    def __init__(self, command, folder, environment=None):
        super().__init__()
        self.folder, self.scans, self.gaps, self.bad, self.states = folder, 0, 0, 0, {}
        self.digest = hashlib.sha256()
        self.process = subprocess.Popen([*command, "--output", folder, "--stream", "-", "--quiet"],
                                        stdout=subprocess.PIPE, env=environment)
        self.memory = Memory(self.process.pid, lambda: self.scans)
        self.start()

    def run(self):
        for line in self.process.stdout:
            self.digest.update(line)
            if b'"scan":null' in line:  # nothing has come for 2 s
                self.gaps += 1
                continue
            self.scans += 1
            # NaN is null in JSON; so is a pose that is not known.
            self.bad += b"null" in line
            state = line.split(b'"state":"', 1)[1].split(b'"', 1)[0].decode()
            self.states[state] = self.states.get(state, 0) + 1
        self.process.wait()

    def figures(self, begin):
        self.join()
        if not (self.folder / "timings.json").exists():
            raise SystemExit(f"long: pole-localize failed, exit code {self.process.returncode}")
        timings = json.loads((self.folder / "timings.json").read_text())
        tables = [*self.folder.glob("*.tum"), *self.folder.glob("*.csv")]
        found = subprocess.run(["grep", "-icE", r"\bnan\b|\binf\b", *tables],
                               capture_output=True, text=True).stdout
        nan = sum(int(line.rsplit(":", 1)[1]) for line in found.splitlines())
        latency = {}
        for stage in ("step", "total"):
            spans = timings["latency_ms"][stage]
            latency[stage] = {"median_ms": round(spans["median"], 3),
                              "p99.9_ms": round(spans["p99.9"], 3),
                              "worst_ms": round(spans["worst"], 3),
                              "p99.9_by_median": round(spans["p99.9"] / spans["median"], 2)}
        return {"exit_code": self.process.returncode, "scans": self.scans,
                "wall_s": round(timings["wall_s"], 1),
                "waited_for_a_core_s": round(self.memory.waited, 1), "states": self.states,
                "scans_without_pose": self.bad, "nan_in_files": nan,
                "memory": self.memory.figures(begin), "latency": latency}


def is_sound(figures):
    return (figures["exit_code"] == 0 and figures["scans_without_pose"] == 0
            and figures["nan_in_files"] == 0 and is_flat(figures["memory"]))


def is_quick(figures):
    return figures["latency"]["step"]["p99.9_by_median"] <= SLOWEST


def is_flat(memory):
    return memory["samples"] > 0 and memory["growth_mb"] <= GROWTH


def start_of(tum):
    """The option --start for the first pose of a trajectory."""
    for line in tum.open():
        if not line.startswith("#"):
            x, y, qz, qw = (float(line.split()[i]) for i in (1, 2, 6, 7))
            yaw = 2 * math.degrees(math.atan2(qz, qw))
            return f"{x},{y},{yaw},2.5,5"
    raise SystemExit(f"{tum}: no pose")


def localize(options):
    return [options.bin / "pole-localize", "--config", options.config, "--seed", "1", "--map",
            options.out / "street.polemap", "--start", start_of(options.out / "drive.tum")]


def hour(options):
    """\\return First scan after the first hour; of shorter drives, after the first tenth."""
    scans = sum(1 for line in (options.out / "drive.tum").open() if not line.startswith("#"))
    return min(3600 * RATE, scans // 10)


def same(first, second):
    names = {file.name for folder in (first, second) for file in folder.iterdir()}
    return all(filecmp.cmp(first / name, second / name, shallow=False)
               for name in names - {"timings.json"})


def measure_file(options):
    """One after the other, so that the latencies are those of a run alone."""
    begin, command = hour(options), localize(options) + ["--input", options.out / "drive.rawlog"]
    drives, figures = [], []
    for threads in (1, 2):
        drives.append(Drive([*command, "--threads", str(threads)], options.out / f"file{threads}"))
        figures.append(drives[-1].figures(begin))
    result = {"one_thread": figures[0], "two_threads": figures[1],
              "same_files": same(drives[0].folder, drives[1].folder),
              "same_stream": drives[0].digest.digest() == drives[1].digest.digest()}
    sound = (all(is_sound(each) and is_quick(each) for each in figures)
             and result["same_files"] and result["same_stream"])
    for drive in drives:
        shutil.rmtree(drive.folder)
    return result, sound


def measure_live(options):
    sensors = options.out / "player.ini"
    sensors.write_text("[player]\ndriver = RawlogPlayer\n"
                       f"process_rate = {RATE * options.speed}\n"
                       f"rawlog = {options.out / 'drive.rawlog'}\n")
    drive = Drive(localize(options) + ["--sensors", sensors], options.out / "live",
                  os.environ | {"LD_PRELOAD": str(options.player)})
    result = drive.figures(hour(options))
    summary = json.loads((drive.folder / "summary.json").read_text())
    result |= {"speed": options.speed, "dropped": summary["dropped_scans"]}
    shutil.rmtree(drive.folder)
    return result, is_sound(result) and is_quick(result)


def measure_packets(options):
    seconds = 60 * options.minutes
    folder = options.out / "packets"
    folder.mkdir(exist_ok=True)
    lidar = packet_rate.Hdl32e(dual=False)
    packet_rate.prepare(folder, lidar, 1)
    subprocess.run([options.bin / "pole-map", "--quiet", "import", "--input", folder / "poles.csv",
                    "--columns", "e,n", "--crs", "EPSG:25832", "--sigma-m", "0.05", "--output",
                    folder / "a.polemap"], check=True)
    drive = Drive([options.bin / "pole-localize", "--config", options.config, "--sensors",
                   folder / "sensors.ini", "--map", folder / "a.polemap", "--start", "0,0,0,1,5"],
                  folder / "out")
    packet_rate.wait_for_listener(drive.process)
    packet_rate.send(lidar, types.SimpleNamespace(lidars=1, seconds=seconds))
    drive.process.send_signal(signal.SIGINT)
    result = drive.figures(min(60, seconds // 10) * RATE)
    summary = json.loads((folder / "out/summary.json").read_text())
    result |= {"minutes": options.minutes, "dropped": summary["dropped_scans"],
               "lost_packets": summary["lost_packets"]}
    shutil.rmtree(folder)
    return result, is_sound(result)


def measure_batch(options):
    folder = options.out / "million"
    shutil.rmtree(folder, ignore_errors=True)
    began = time.monotonic()
    process = subprocess.Popen([options.bin / "pole-batch", options.out / "million.ini", "--quiet",
                                "--output", folder])
    done = [0]
    memory = Memory(process.pid, lambda: done[0])
    while process.poll() is None:
        if (folder / "tasks").is_dir():
            done[0] = sum(1 for name in os.listdir(folder / "tasks")
                          if name.startswith("run.") and not name.endswith(".part"))
        time.sleep(1)
    wall = time.monotonic() - began
    summaries = [json.loads(file.read_text())
                 for file in (folder / "tasks").glob("run.*/**/summary.json")]
    health = [run["health"] for summary in summaries for run in summary["runs"]]
    result = {"exit_code": process.returncode, "runs": len(summaries),
              "scans": sum(summary["scans"] for summary in summaries),
              "failures": options.runs - len(summaries),
              "lost_scans": sum(run["lost"] for run in health), "wall_s": round(wall, 1),
              "memory": memory.figures(1),  # of pole-batch itself
              "largest_child_mb": round(memory.largest_child, 1)}
    shutil.rmtree(folder, ignore_errors=True)
    return result, (process.returncode == 0 and result["failures"] == 0
                    and is_flat(result["memory"]))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("part", choices=("file", "live", "packets", "batch"))
    for name in ("bin", "out", "config", "player"):
        parser.add_argument(f"--{name}", type=pathlib.Path)
    for name in ("speed", "minutes", "runs"):
        parser.add_argument(f"--{name}", type=int)
    options = parser.parse_args()
    result, sound = globals()[f"measure_{options.part}"](options)
    result |= {"sound": sound, "date": datetime.date.today().isoformat()}
    (options.out / f"{options.part}.json").write_text(json.dumps(result, indent=2) + "\n")
    parts = {file.stem: json.loads(file.read_text()) for name in ("file", "live", "packets", "batch")
             if (file := options.out / f"{name}.json").exists()}
    (options.out / "long.json").write_text(json.dumps(parts, indent=2) + "\n")
    print(json.dumps(result, indent=2))
    sys.exit(0 if sound else 1)


main()
