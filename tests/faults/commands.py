"""The commands that write, with inputs so small that each takes a fraction of a second."""

import re
import subprocess

# {in} is a folder of inputs, a or b, of two days of one street, whose LiDAR is mounted higher on the second; {out}
# gets the outputs. Left out is what is written in the same way as another output here, --stream, which grows in place,
# and --record: the times of a live drive are other ones each time.
COMMANDS = {line.split(": ")[0]: line.split(": ")[1].split() for line in """
simulate-scans: pole-simulate --config demo.ini --length 40 --day {day} --set simulation.spacing_m=20 --output {out}/scans
simulate-poles: pole-simulate --config demo.ini --length 40 --day {day} --set simulation.detections=hdl32e.json --poles {out}/drive.rawlog
import: pole-import folder --input {in}/scans --output {out}/scans.rawlog --embed
extract: pole-extract --config demo.ini --input {in}/scans.rawlog --output {out}/poles.rawlog --csv {out}/poles.csv --png {out}/scan.png
extract-steps: pole-extract --config demo.ini --set extraction.method=range_image --input {in}/scans.rawlog --output {out}/poles.rawlog --range-image {out}/steps.png
inspect: pole-extract --inspect {in}/scans.rawlog --write-config {out}/my.ini
labels: pole-labels --input {in}/scans --output {out}/truth.polemap --stems 1 2 3 4 5 6 7 8 9 10 11 12 --min-scans 1 --min-points 3
map-build: pole-map build --config demo.ini --input {in}/drive.rawlog --truth {in}/drive.tum --output {out}/street.polemap --csv {out}/street.csv --png {out}/street.png --scene {out}/street.3Dscene --keep-scans
map-drives: pole-map build --config demo.ini --input {in}/drive.rawlog --output {out}/found.polemap --trajectory {out}/found.tum
map-update: pole-map update --config demo.ini --map {in}/street.polemap --input {in}/drive.rawlog --truth {in}/drive.tum --output {out}/newer.polemap --json {out}/newer.json
map-convert: pole-map convert {in}/session.polemap --output {out}/street.polemap
map-csv: pole-map convert {in}/session.polemap --output {out}/street.csv
map-geojson: pole-map convert {in}/city.polemap --output {out}/city.geojson
map-diff: pole-map diff {in}/truth.polemap {in}/street.polemap --csv {out}/changes.csv --png {out}/changes.png --scene {out}/changes.3Dscene
map-import: pole-map import --input {in}/trees.csv --columns lon,lat --sigma-m 1 --output {out}/city.polemap
localize: pole-localize --config demo.ini --input {in}/drive.rawlog --map {in}/street.polemap --truth {in}/drive.tum --particles 100 --output {out}/run --mcap {out}/run.mcap --scenes 30
localize-frames: pole-localize --config demo.ini --input {in}/drive.rawlog --map {in}/street.polemap --truth {in}/drive.tum --particles 100 --output {out}/run --frames {out}/frames --frame-every 40
eval-trajectory: pole-eval trajectory --truth {in}/drive.tum --estimate {in}/run/run_00.tum --map {in}/street.polemap --png {out}/run.png --json {out}/run.json
eval-map: pole-eval map --truth {in}/scans/poles_gt.csv --map {in}/street.polemap --json {out}/map.json
eval-detections: pole-eval detections --scans {in}/scans --poles {in}/poles.rawlog --visible {out}/seen.csv --json {out}/found.json
eval-sightings: pole-eval sightings --poles {in}/drive.rawlog --output {out}/sightings.csv
eval-features: pole-eval features --config demo.ini --scans {in}/scans --poles {in}/scans/poles_gt.csv --output {out}/features.csv
eval-global: pole-eval global --config demo.ini --map {in}/street.polemap --input {in}/drive.rawlog --truth {in}/drive.tum --trials 1 --metres 5 --json {out}/global.json
batch: pole-batch {in}/batch.ini --output {out}/batch --jobs 1 --resume
""".strip().splitlines()}
# In place of a map that is there: for two at once only.
UPDATE = "pole-map update --config demo.ini --map {out}/street.polemap --input {in}/drive.rawlog --truth {in}/drive.tum --output {out}/street.polemap"

INPUTS = """
pole-simulate --config demo.ini --length 40 --day {day} --set simulation.spacing_m=20 sensor.height_m=1.{day} --output {in}/scans
pole-simulate --config demo.ini --length 40 --day {day} --set simulation.detections=hdl32e.json --poles {in}/drive.rawlog
pole-import folder --input {in}/scans --output {in}/scans.rawlog --embed
pole-extract --config demo.ini --input {in}/scans.rawlog --output {in}/poles.rawlog
pole-map build --config demo.ini --input {in}/drive.rawlog --truth {in}/drive.tum --output {in}/street.polemap
pole-map build --config demo.ini --input {in}/drive.rawlog --truth {in}/drive.tum --output {in}/session.polemap --keep-scans
pole-localize --config demo.ini --input {in}/drive.rawlog --map {in}/street.polemap --truth {in}/drive.tum --output {in}/run
pole-labels --input {in}/scans --output {in}/truth.polemap --stems 1 2 3 4 5 6 7 8 9 10 11 12 --min-scans 1 --min-points 3
pole-map import --input {in}/trees.csv --columns lon,lat --sigma-m 1 --output {in}/city.polemap
"""
BATCH = """[batch]
title = Two drives
runs = 1
settings = once
[sessions]
names = mapped later_drive
source = simulated
input = demo.ini
set = simulation.detections=hdl32e.json world.length_m=60 world.day={day}
[setting once]
config = demo.ini
map_sessions = mapped
sessions = later
"""
TREES = "lon,lat\n13.4,52.5\n13.4001,52.500{day}\n"

# Temporary names, as share/doc/files.md has them.
TEMPORARY = re.compile(r"\.[0-9-]+\.tmp(/|$)|(^|/)\.incomplete-\w{6}(/|$)|\.part(/|$)")
# Times and logs differ from run to run; the lock of a batch is empty.
CHANGING = re.compile(r"timings\.json$|^batch/(times|logs|report\.html|\.lock)")


def arguments(programs, command, inputs, version, out):
    """The command line with the inputs of a version."""
    values = {"in": inputs / version, "day": int(version == "b"), "out": out}
    program, *rest = [word.format(**values) for word in command]
    return [str(programs / program), "--quiet", "--threads", "1", *rest]


def make_inputs(programs, folder):
    for version in "ab":
        here = folder / version
        here.mkdir(parents=True)
        (here / "batch.ini").write_text(BATCH.format(day=int(version == "b")))
        (here / "trees.csv").write_text(TREES.format(day=1 + int(version == "b")))
        for line in INPUTS.strip().splitlines():
            subprocess.run(arguments(programs, line.split(), folder, version, here), check=True,
                           stdout=subprocess.DEVNULL)
            (here / "scans/calib.txt").write_text("Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n")  # for pole-labels


def unit(name, names):
    """What must be complete together with a file: the folder that holds it, or the file alone."""
    folder = name.split("/")[0]
    if folder in ("scans", "frames"):
        return folder
    if folder == "run":  # complete while it has a summary
        return "run" if "run/summary.json" in names else name
    task = re.match("batch/tasks/[^/]+", name)
    return task[0] if task else name
