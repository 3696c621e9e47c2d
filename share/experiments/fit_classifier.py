#!/usr/bin/python3
"""Fits the confidence of poles and the scale of their covariance to tables of `pole-eval features`.

Confidence: gradient-boosted trees on the terms, and fewer on those that are known before the fit of a cylinder.
Covariance: a scale, log-linear in its terms. Squared errors divided by the true covariance are chi-square of
two degrees of freedom, an exponential distribution: a gamma regression.
Drives of one sensor share one weight, so that all sensors weigh alike. Needs python3-sklearn.
"""
import argparse
import csv
import json
import pathlib

import numpy as np
from sklearn.ensemble import HistGradientBoostingClassifier
from sklearn.linear_model import GammaRegressor
from sklearn.metrics import average_precision_score, log_loss

KNOWN_AFTER_FIT = {"clutter", "excess", "radius", "density"}  # terms that the rough trees do not see
HIGHEST_ODDS = 7  # that the covariance distinguishes
FAR_ERROR = 13.8  # one in 1000 squared errors is greater; more are not those of the pole's own centre
# More of these never speaks for a pole, or always does. PoleClassifier relies on that of clutter.
DIRECTIONS = {"clutter": -1, "wide": -1, "notWhole": -1, "scatter": -1, "lowTop": -1, "excess": -1, "extent": 1}
REAL_WEIGHT = 6  # of a candidate of a real drive: simulated worlds are many
TREES = {"max_iter": 150, "learning_rate": 0.15, "max_leaf_nodes": 16, "max_depth": 4, "l2_regularization": 20,
         "min_samples_leaf": 80, "early_stopping": False}  # PoleClassifier.cpp has room for this depth
ROUGH_TREES = {"max_iter": 40, "learning_rate": 0.3}  # otherwise the same
WRITTEN_BY = "written by\n# share/experiments/fit_classifier.py (train-classifier.sh).\n"


class Drive:
    """The table of one drive."""

    def __init__(self, path):
        lines = pathlib.Path(path).read_text().splitlines()
        head = dict(line[2:].split(" ", 1) for line in lines if line.startswith("# "))
        columns, *rows = csv.reader(line for line in lines if not line.startswith("#"))
        values = np.array([[float(cell or "nan") for cell in row] for row in rows])
        self.name, self.sensor = pathlib.Path(path).stem, head["sensor"]
        self.real = head["labels"] == "many_scans"
        first = columns.index("odds") + 1
        between = next(i for i, name in enumerate(columns) if name.startswith("covariance_"))
        self.names, self.terms = columns[first:between], values[:, first:between]
        self.scale_names, self.scale_terms = columns[between:], values[:, between:]
        self.poles = values[:, columns.index("pole")]
        self.errors = values[:, columns.index("squared_error")]
        self.built_in = values[:, columns.index("odds")]


def sample_weights(drives):
    """One array: all sensors weigh alike, and so do all candidates of a sensor but for REAL_WEIGHT."""
    sensors = np.concatenate([[drive.sensor] * len(drive.poles) for drive in drives])
    names, index, counts = np.unique(sensors, return_inverse=True, return_counts=True)
    real = np.concatenate([[REAL_WEIGHT if drive.real else 1] * len(drive.poles) for drive in drives])
    return real * len(sensors) / (len(names) * counts[index])


def rows_of_tree(nodes, names):
    """Rows of a table: (term, value, step), the left child behind its parent."""
    rows = []

    def append(index):
        node, row = nodes[index], len(rows)
        rows.append(None)
        if node["is_leaf"]:
            rows[row] = ("one", node["value"], None)
            return
        append(node["left"])
        rows[row] = (names[node["feature_idx"]], node["num_threshold"], len(rows) - row)
        append(node["right"])

    append(0)
    return [(term, value, row - len(rows) if step is None else step) for row, (term, value, step) in enumerate(rows)]


class Trees:
    """Boosted trees, and the terms that they see."""

    def __init__(self, drives, unseen, options):
        self.unseen = unseen
        self.names = [name for name in drives[0].names if name not in unseen]
        directions = [DIRECTIONS.get(name, 0) for name in self.names]
        self.model = HistGradientBoostingClassifier(monotonic_cst=directions, **options)
        poles = np.concatenate([drive.poles for drive in drives])
        self.model.fit(np.concatenate([self.terms(drive) for drive in drives]), poles, sample_weights(drives))

    def terms(self, drive):
        return drive.terms[:, [name not in self.unseen for name in drive.names]]

    def odds(self, drive):
        return self.model.decision_function(self.terms(drive))

    def write(self, path):
        rows = [("one", float(np.ravel(self.model._baseline_prediction)[0]), -1)]
        for [tree] in self.model._predictors:
            rows += rows_of_tree(tree.nodes, self.names)
        path.write_text("# Trees of PoleClassifier.cpp, " + WRITTEN_BY + "term,value,step\n"
                        + "".join("%s,%.9g,%d\n" % row for row in rows))


class Classifier:
    def __init__(self, drives, **options):
        self.trees = Trees(drives, set(), {**TREES, **options})
        self.rough = Trees(drives, KNOWN_AFTER_FIT, {**TREES, **ROUGH_TREES, **options})

    def odds(self, drive):
        return self.trees.odds(drive)

    def write(self, folder):
        self.trees.write(folder / "trees.csv")
        self.rough.write(folder / "rough_trees.csv")


def write_covariance(path, drives, classifier):
    """Fits the scale to the poles with a known error that the classifier accepts."""
    odds = np.concatenate([classifier.odds(drive) for drive in drives])
    errors = np.concatenate([drive.errors for drive in drives])
    terms = np.concatenate([drive.scale_terms for drive in drives])
    terms = np.c_[np.clip(odds, 0, HIGHEST_ODDS), terms]
    used = (np.concatenate([drive.poles for drive in drives]) == 1) & (odds >= 0) & (errors >= 0)
    if not used.any():
        raise SystemExit("fit_classifier.py: no pole has a known error; a simulated drive is needed")
    scale = GammaRegressor(alpha=1e-7, solver="newton-cholesky", tol=1e-8)
    weights, near = sample_weights(drives), used
    for _ in range(5):
        # The mean of chi-square of two degrees of freedom is 2. The regression refuses zeros.
        scale.fit(terms[near], np.maximum(errors[near], 1e-9) / 2, weights[near])
        near = used & (errors <= FAR_ERROR * scale.predict(terms))
    names = ["one", "odds"] + [name[len("covariance_") :] for name in drives[0].scale_names]
    rows = zip(names, np.r_[scale.intercept_, scale.coef_])
    path.write_text("# Log-linear scale of the covariance of poles, " + WRITTEN_BY + "term,weight\n"
                                  + "".join("%s,%.6g\n" % row for row in rows))


def score(drive, odds):
    probabilities = 1 / (1 + np.exp(-odds))
    return {"log_loss": log_loss(drive.poles, probabilities, labels=[0, 1]),
            "average_precision": average_precision_score(drive.poles, odds)}


def report(drive, classifier, left_out):
    return {"drive": drive.name, "real": drive.real, "left_out": left_out, "candidates": len(drive.poles),
            "poles": int(drive.poles.sum()), "built_in": score(drive, drive.built_in),
            "new": score(drive, classifier.odds(drive))}


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("tables", nargs="+", help="tables to fit to, one per drive")
    options.add_argument("--test", nargs="*", default=[], help="tables that are only scored")
    options.add_argument("--output", required=True, type=pathlib.Path,
                         help="folder of trees.csv, rough_trees.csv, covariance.csv to write")
    options.add_argument("--json", help="scores to write; each real drive also by a fit to the others")
    options = options.parse_args()
    drives = [Drive(table) for table in options.tables]
    classifier = Classifier(drives)
    write_covariance(options.output / "covariance.csv", drives, classifier)
    classifier.write(options.output)
    if not options.json:
        return
    scores = [report(drive, classifier, False) for drive in map(Drive, options.test)]
    for drive in drives:
        if drive.real:
            others = [other for other in drives if other is not drive]
            scores.append(report(drive, Classifier(others), True))
    pathlib.Path(options.json).write_text(json.dumps({"scores": scores}, indent=2) + "\n")
    for row in scores:
        print("%-24s %5d of %5d  log loss %.4f now, %.4f new" % (
            row["drive"], row["poles"], row["candidates"], row["built_in"]["log_loss"], row["new"]["log_loss"]))


if __name__ == "__main__":
    main()
