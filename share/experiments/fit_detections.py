#!/usr/bin/python3
"""Fits a model of detections ([simulation] detections) to tables of `pole-eval sightings`, or sums up such a table.

The model: share/doc/simulation.md, and DetectionModel.h for its parts. All of them come from counting. Two drives of
one street on two days tell what lasts for good and what for a day. Needs python3-scipy.
"""
import argparse
import csv
import json
import pathlib
import types

import numpy as np
from scipy.optimize import nnls
from scipy.special import ndtr, ndtri

POLES = ["lamp_post", "sign", "traffic_light", "tree"]
CLUTTER, PASSING = len(POLES), len(POLES) + 1
KINDS = POLES + ["clutter", "passing"]
REPORTED = ["sigma_along_m", "sigma_across_m", "error_along", "error_across", "confidence", "radius_m", "bottom_m",
            "top_m", "points"]
LEVELS = [0.002, 0.01, 0.05, 0.15, 0.3, 0.5, 0.7, 0.85, 0.95, 0.99, 0.998]  # as in DetectionModel.h
REACH = [1.5, 4.0, 10.0, 25.0, 0.0]  # m, as in PersistentNoise.h
DETECTED_RANGE = np.array([2, 4.5, 7, 10, 13, 16, 20, 24, 28, 32, 36, 39.5])
REPORTED_RANGE = np.array([3.0, 8, 14, 22, 33])
LAGS = [0, 1, 2, 4, 8, 16, 32, 64]  # scans
SAME_PLACE = 0.6  # m: nearer clutter of two days is one object
FEW_SAMPLES = 40  # fewer are not enough for a distribution
FEW_PAIRS = 100
THRESHOLD_STEP = 0.1


def refuse(why):
    raise SystemExit("fit_detections.py: " + why)


class Drive:
    """The table of one drive: arrays with an element for each sighting."""

    def __init__(self, path):
        lines = pathlib.Path(path).read_text().splitlines()
        self.head = dict(line[2:].split(" ", 1) for line in lines if line.startswith("# "))
        names, *rows = csv.reader(line for line in lines if not line.startswith("#"))
        columns = dict(zip(names, zip(*rows)))
        values = {name: np.array([float(cell or "nan") for cell in columns[name]]) for name in names if name != "kind"}
        self.kind = np.array([KINDS.index(kind) for kind in columns["kind"]])
        self.is_pole, self.lasts = self.kind < len(POLES), self.kind != PASSING
        # Poles have the same ids on both days. Clutter gets negative numbers.
        self.object = np.where(self.is_pole, values["object"], -1 - values["object"]).astype(int)
        self.place = np.stack([values["x"], values["y"]], axis=1)
        self.aside, self.range, self.hidden = values["aside_m"], values["range_m"], values["hidden"] == 1
        self.scan = values["scan"].astype(int)
        self.reported = np.stack([values[name] for name in REPORTED], axis=1)
        self.found = ~np.isnan(self.reported[:, 0])
        self.points = [int(count) for count in self.head["points_per_scan"].split()]
        self.start = 0  # row in the joined tables

    def number(self, key):
        return float(self.head[key])

    def clutter(self):
        """The first row of each object."""
        rows = np.flatnonzero(self.kind == CLUTTER)
        return rows[np.unique(self.object[rows], return_index=True)[1]]


class Street:
    """Two drives of a street, on two days. Clutter that both have gets one number."""

    def __init__(self, first, second):
        if any(first.head[key] != second.head[key] for key in ("seed", "track", "street_m")):
            refuse("the two drives of a pair are on two streets; each pair must be one street on two days")
        if first.head["day"] == second.head["day"]:
            refuse("the two drives of a pair are on one day; each pair must be one street on two days")
        self.drives = first, second
        self.on_both = 0
        known, objects = first.clutter(), second.object.copy()
        for row in second.clutter():
            same = second.object == second.object[row]
            far = np.linalg.norm(first.place[known] - second.place[row], axis=1)
            near = len(known) > 0 and far.min() < SAME_PLACE
            objects[same] = first.object[known[far.argmin()]] if near else second.object[row] - 1000000
            self.on_both += near
        second.object = np.where(second.kind == CLUTTER, objects, second.object)

    def pairs(self, lag, same_day):
        """Rows of two sightings of one object, this number of scans apart. Hidden ones are left out."""
        objects = np.unique(np.concatenate([drive.object for drive in self.drives]))
        scans = max(len(drive.points) for drive in self.drives)
        grids = []
        for drive in self.drives:
            rows = np.flatnonzero(drive.lasts & ~drive.hidden)
            grids.append(np.full((len(objects), scans + lag), -1))
            grids[-1][np.searchsorted(objects, drive.object[rows]), drive.scan[rows]] = drive.start + rows
        for a, b in zip(grids, grids) if same_day else [grids]:
            a, b = a[:, :scans], b[:, lag:]
            both = (a >= 0) & (b >= 0)
            yield np.stack([a[both], b[both]])


def joined(drives):
    return types.SimpleNamespace(**{name: np.concatenate([getattr(drive, name) for drive in drives]) for name in (
        "kind", "is_pole", "lasts", "range", "hidden", "reported", "found")})


def quantiles_of(values):
    if len(values) < 5:
        refuse("hardly any pole is found on these streets; nothing can be fitted")
    return np.quantile(values, LEVELS, axis=0)


def nearest(nodes, values):
    return np.abs(np.subtract.outer(values, nodes)).argmin(axis=1)


def counted(kind, node, nodes, weights=None):
    """Sums of weights by kind and node."""
    counts = np.bincount(kind * nodes + node, weights, len(KINDS) * nodes)
    return counts.reshape(len(KINDS), nodes)


def scores_of(quantiles, values):
    """Standard normal numbers of values; where several have this value, the middle one."""
    levels, last = ndtri(LEVELS), len(LEVELS) - 1
    scores = []
    for side in ("left", "right"):
        place = np.searchsorted(quantiles, values, side)
        above = np.clip(place, 1, last)
        width = quantiles[above] - quantiles[above - 1]
        share = np.clip((values - quantiles[above - 1]) / np.where(width > 0, width, 1), 0, 1)
        share = np.where(width > 0, share, place > last)
        scores.append(levels[above - 1] + share * (levels[above] - levels[above - 1]))
    return np.mean(scores, axis=0)


def noise_correlation(reach, distance):
    """Correlation of a part of PersistentNoise.h between places at this distance, averaged over directions."""
    if reach <= 0:
        return 1.0
    middles = (np.arange(12) + 0.5) / 12
    x, y, angle = np.meshgrid(middles, middles, np.pi / 2 * middles)
    there = x + distance / reach * np.cos(angle), y + distance / reach * np.sin(angle)
    nodes = [(column, row) for column in (0, 1) for row in (0, 1)]

    def weights(x, y):
        left, below = x - np.floor(x), y - np.floor(y)
        each = np.stack([np.abs(1 - column - left) * np.abs(1 - row - below) for column, row in nodes])
        return each / np.sqrt((each ** 2).sum(axis=0))

    total = 0
    for here, (column, row) in zip(weights(x, y), nodes):
        for other, (east, north) in zip(weights(*there), nodes):
            same = (np.floor(there[0]) + east == column) & (np.floor(there[1]) + north == row)
            total += (here * other)[same].sum()
    return total / x.size


def fit_spectrum(correlations):
    """Shares of noise that lasts, by reach: least squares over (distance in m, same day, correlation). No share is
    negative, and their sum is at most 1."""
    shares = np.zeros(2 * len(REACH))
    if correlations:
        columns = [[noise_correlation(reach, distance) * on for on in (1, same_day) for reach in REACH]
                   for distance, same_day, _ in correlations]
        shares = nnls(np.array(columns), np.array([correlation for *_, correlation in correlations]))[0]
    shares /= max(1.0, shares.sum())
    return {"always": shares[:len(REACH)], "today": shares[len(REACH):]}


def bivariate_cdf(h, k, correlation):
    """P(a < h and b < k) of normal numbers: integral over the correlation (Drezner and Wesolowsky 1990)."""
    nodes, weights = np.polynomial.legendre.leggauss(16)
    half = 0.5 * np.arcsin(correlation)
    s = np.sin(half * (1 + nodes))[:, None]
    integrand = np.exp(-(h * h + k * k - 2 * h * k * s) / (2 * (1 - s * s)))
    return ndtr(h) * ndtr(k) + half * weights @ integrand / (2 * np.pi)


def hit_correlation(h, k, both):
    """Correlation of normal numbers if only "below or above a threshold" is known (tetrachoric, Pearson 1900): that
    for which the expected number of pairs below both thresholds h, k is the counted one."""
    cells, pairs = np.unique(np.rint(np.stack([h, k]) / THRESHOLD_STEP), axis=1, return_counts=True)
    low, high = -0.9, 0.999
    for _ in range(30):
        middle = 0.5 * (low + high)
        expected = pairs @ bivariate_cdf(*(cells * THRESHOLD_STEP), middle)
        low, high = (middle, high) if expected < both.sum() else (low, middle)
    return 0.5 * (low + high)


def correlation_of(a, b):
    """Of numbers with the mean 0."""
    return a @ b / np.sqrt((a @ a) * (b @ b)) if a.any() and b.any() else 0.0


class Fit:
    """The parts of a model."""

    def __init__(self, streets, max_range):
        self.streets, self.max_range = streets, max_range
        self.drives = [drive for street in streets for drive in street.drives]
        self.all = joined(self.drives)
        for drive, later in zip(self.drives, self.drives[1:]):
            later.start = drive.start + len(drive.kind)
        self.ranges = DETECTED_RANGE[DETECTED_RANGE <= max_range]
        self.fit_detected()
        self.fit_reported()  # gives the usual sigmas
        self.fit_error_exponent()
        self.scale_errors()
        self.fit_reported()
        self.fit_noise()

    def thresholds(self):
        """Of all sightings, on a standard normal number: linear between the ranges."""
        rows = ndtri(self.detected)
        return np.choose(self.all.kind, [np.interp(self.all.range, self.ranges, row) for row in rows])

    def fit_detected(self):
        """Counts by range, then thresholds (linear between the ranges) that reproduce the counts."""
        seen, nodes = self.all, len(self.ranges)
        open_way = ~seen.hidden & seen.lasts
        self.behind_houses = seen.found[seen.hidden].mean() if seen.hidden.any() else 0.0
        kind, node = seen.kind[open_way], nearest(self.ranges, seen.range[open_way])
        chances = counted(kind, node, nodes)
        found = counted(kind, node, nodes, seen.found[open_way])
        few = (chances < FEW_SAMPLES) & (np.arange(len(KINDS)) < len(POLES))[:, None]
        pooled = [counts[:len(POLES)].sum(axis=0) for counts in (found, chances)]
        self.detected = (np.where(few, pooled[0], found) + 0.5) / (np.where(few, pooled[1], chances) + 1)
        enough = chances >= FEW_SAMPLES
        for _ in range(20):
            expected = counted(kind, node, nodes, ndtr(self.thresholds()[open_way]))
            step = ndtri((found + 0.5) / (chances + 1)) - ndtri((expected + 0.5) / (chances + 1))
            self.detected = np.where(enough, ndtr(ndtri(self.detected) + 0.7 * step), self.detected)

    def fit_reported(self):
        """Quantiles, by kind, value, range and level. Rare poles are taken for all poles at that range."""
        seen, node = self.all, nearest(REPORTED_RANGE, self.all.range)
        self.reported = np.empty((len(KINDS), len(REPORTED), len(REPORTED_RANGE), len(LEVELS)))
        for kind in range(len(KINDS)):
            own = seen.found & (seen.kind == kind)
            for i in range(len(REPORTED_RANGE)):
                use = own & (node == i)
                if use.sum() < FEW_SAMPLES:
                    alone = kind >= len(POLES) and own.sum() >= FEW_SAMPLES
                    use = own if alone else seen.found & seen.is_pole & (node == i)
                self.reported[kind, :, i] = quantiles_of(seen.reported[use]).T

    def usual_sigmas(self):
        """Medians of the two reported sigmas at the range of each sighting."""
        medians = self.reported[:, :2, :, LEVELS.index(0.5)]
        rows = [[np.interp(self.all.range, REPORTED_RANGE, row) for row in medians[:, i]] for i in range(2)]
        return np.stack([np.choose(self.all.kind, row) for row in rows], axis=1)

    def fit_error_exponent(self):
        """Slope of log(error) over log(sigma), both relative to the usual sigma (Harvey 1976)."""
        sigma, usual = self.all.reported[:, :2], self.usual_sigmas()
        error = np.abs(self.all.reported[:, 2:4] * sigma)
        used = (error >= 1e-6) & self.all.is_pole[:, None]
        x, y = np.log((sigma / usual)[used]), np.log((error / usual)[used])
        spread = ((x - x.mean()) ** 2).sum()
        self.error_exponent = np.clip((x - x.mean()) @ y / spread, 0, 1) if spread > 1e-9 else 1.0

    def scale_errors(self):
        """Errors as multiples of DetectionModel::errorScale(), not of the reported sigma."""
        sigma, usual = self.all.reported[:, :2], self.usual_sigmas()
        self.all.reported[:, 2:4] *= sigma / (usual * (sigma / usual) ** self.error_exponent)

    def pairs(self):
        """Rows of two sightings of one object, by their distance in m and whether they are of one day."""
        result, spacing = {}, self.drives[0].number("spacing_m")
        for same_day in (True, False):
            for lag in LAGS[same_day:]:  # a sighting makes no pair with itself
                parts = [pairs for street in self.streets for pairs in street.pairs(lag, same_day)]
                result[lag * spacing, same_day] = np.concatenate(parts, axis=1)
        return result

    def fit_noise(self):
        seen, thresholds, pairs = self.all, self.thresholds(), self.pairs()

        def spectrum(used, correlation):
            """Of the sightings that are used; correlation of pairs, from two arrays of rows."""
            correlations = []
            for (distance, same_day), (a, b) in pairs.items():
                both = used[a] & used[b]
                if both.sum() >= FEW_PAIRS:
                    correlations.append((distance, same_day, correlation(a[both], b[both])))
            return fit_spectrum(correlations)

        def hits(a, b):
            return hit_correlation(thresholds[a], thresholds[b], seen.found[a] & seen.found[b])

        self.persistence = {"poles": spectrum(seen.is_pole, hits), "clutter": spectrum(~seen.is_pole, hits)}
        for r, name in enumerate(REPORTED):
            scores = self.scores(r)
            self.persistence[name] = spectrum(seen.is_pole & seen.found,
                                              lambda a, b: correlation_of(scores[a], scores[b]))

    def scores(self, r):
        """Standard normal numbers of a reported value, by the nearest of the ranges."""
        seen, node = self.all, nearest(REPORTED_RANGE, self.all.range)
        scores = np.zeros(len(seen.kind))
        for kind in range(len(POLES)):
            for i in range(len(REPORTED_RANGE)):
                used = seen.found & (seen.kind == kind) & (node == i)
                scores[used] = scores_of(self.reported[kind, r, i], seen.reported[used, r])
        return scores

    def false_detections(self):
        seen = self.all
        length = sum(street.drives[0].number("street_m") for street in self.streets)
        always = sum(street.on_both for street in self.streets)
        lateral = np.concatenate([drive.aside[drive.clutter()] for drive in self.drives])
        ranges = np.minimum(seen.range[seen.kind == PASSING], self.max_range)
        return {"clutter_per_m": {"always": always / length, "today": max(0, len(lateral) / 2 - always) / length},
                "clutter_lateral_m": quantiles_of(lateral) if len(lateral) >= 5 else np.zeros(len(LEVELS)),
                "passing_per_scan": len(ranges) / sum(len(drive.points) for drive in self.drives),
                "passing_range_m": quantiles_of(ranges) if len(ranges) >= 5 else np.zeros(len(LEVELS))}

    def model(self):
        """As DetectionModelFile.cpp reads it. Effects of seasons are not fitted."""
        head = self.drives[0].head
        scans = sum(len(drive.points) for drive in self.drives)
        driven = sum(drive.number("driven_m") for drive in self.drives)
        return {"format": "polemcl detection model 1",
                "fitted_on": "worlds %s; %d scans over %d m, two days each" % (
                    ", ".join(street.drives[0].head["seed"] for street in self.streets), scans, driven),
                "sensor": head["sensor"], "height_m": float(head["height_m"]), "max_range_m": self.max_range,
                "points_per_scan": int(np.median(np.concatenate([drive.points for drive in self.drives]))),
                "behind_houses": self.behind_houses, "error_exponent": self.error_exponent,
                "detected_range_m": self.ranges, "reported_range_m": REPORTED_RANGE, "levels": LEVELS, "reach_m": REACH,
                **self.false_detections(),
                "season": {"snow": np.zeros(4), "bare": np.zeros(4), "fence": 0.0, "site_clutter_per_m": 0.0},
                "persistence": self.persistence,
                "classes": {kind: {**({"detected": self.detected[c]} if c != PASSING else {}),
                                   **dict(zip(REPORTED, self.reported[c]))} for c, kind in enumerate(KINDS)}}


def fit(drives):
    """The model of drives, two for each street."""
    if len(drives) % 2 != 0:
        refuse("%d tables are given; two for each street are needed, of two days" % len(drives))
    streets = [Street(*pair) for pair in zip(drives[::2], drives[1::2])]
    for key in ("spacing_m", "height_m", "sensor", "max_range_m"):
        if len({drive.head[key] for drive in drives}) > 1:
            refuse("the drives differ in %s; a model is made for a single one" % key)
    max_range = drives[0].number("max_range_m")
    if max_range < DETECTED_RANGE[0]:
        refuse("max_range_m is below the nearest range of a model, 2 m")
    return Fit(streets, max_range).model()


def text_of(value, indent=""):
    """JSON: objects over several lines, lists of numbers on one line, three digits."""
    if isinstance(value, dict):
        lines = [json.dumps(key) + ": " + text_of(each, indent + "  ") for key, each in value.items()]
    elif np.ndim(value) == 2:
        lines = [text_of(row) for row in value]
    elif np.ndim(value) == 1:
        return "[" + ",".join(map(text_of, value)) + "]"
    else:
        return json.dumps(float("%.3g" % value) + 0.0 if isinstance(value, float) else value)
    begin, end = "{}" if isinstance(value, dict) else "[]"
    return begin + "\n" + ",\n".join(indent + "  " + line for line in lines) + "\n" + indent + end


def runs(drive):
    """Lengths in m of paths over which a pole is found in every scan, and in no scan. The first and the last run are
    left out, because they are cut off at the limits of visibility."""
    lengths = {True: [], False: []}
    for key in np.unique(drive.object[drive.is_pole]):
        rows = np.flatnonzero(drive.is_pole & (drive.object == key))
        start, whole = 0, False
        for i in range(1, len(rows)):
            before, now = drive.found[rows[i - 1]], drive.found[rows[i]]
            gap = drive.scan[rows[i]] != drive.scan[rows[i - 1]] + 1 or drive.hidden[rows[i]]
            if not gap and now == before:
                continue
            if not gap and whole:
                lengths[bool(before)].append(drive.number("spacing_m") * (i - start))
            start, whole = i, not gap
    return lengths[True], lengths[False]


def summary(drive):
    """Figures of a drive; None without data. Recall is of poles that no house hides, by ranges of 5 m."""
    edges = [*np.arange(0, drive.number("max_range_m"), 5), drive.number("max_range_m")]
    visible = drive.is_pole & ~drive.hidden
    near = [visible & (drive.range >= low) & (drive.range < high) for low, high in zip(edges, edges[1:])]
    right, scans = drive.found & drive.is_pole, len(drive.points)
    wrong, lasting = drive.found & ~drive.is_pole, drive.found & (drive.kind == CLUTTER)
    sigma, error = drive.reported[right, 0:2], drive.reported[right, 2:4]
    centre, nees = np.hypot(*(sigma * error).T), (error ** 2).sum(axis=1)
    found_runs, missed_runs = runs(drive)

    def of(values, function=np.mean):
        return float(function(values)) if len(values) else None
    return {"scans": scans, "detections": int(drive.found.sum()), "per_scan": drive.found.sum() / scans,
            "false_per_scan": wrong.sum() / scans, "lasting_false_per_scan": lasting.sum() / scans,
            "centre_median_m": of(centre, np.median), "centre_p90_m": of(centre, lambda c: np.quantile(c, 0.9)),
            "nees_mean": of(nees), "nees_median": of(nees, np.median),
            "found_run_m": of(found_runs), "missed_run_m": of(missed_runs),
            "confidence": of(drive.reported[right, REPORTED.index("confidence")]),
            "range_edges_m": edges, "recall": [of(drive.found[each]) for each in near]}


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("tables", nargs="+", help="to fit to: for each street two, of two days; to sum up: one")
    output = options.add_mutually_exclusive_group(required=True)
    output.add_argument("--model", type=pathlib.Path, help="model to write (JSON)")
    output.add_argument("--summary", type=pathlib.Path, help="figures of one drive to write (JSON)")
    options = options.parse_args()
    drives = [Drive(table) for table in options.tables]
    if options.model:
        options.model.write_text(text_of(fit(drives)) + "\n")
    elif len(drives) == 1:
        options.summary.write_text(json.dumps(summary(drives[0]), indent=2) + "\n")
    else:
        refuse("%d tables are given; --summary takes one" % len(drives))


if __name__ == "__main__":
    main()
