#!/usr/bin/python3
"""Fits the confidence of poles and the scale of their covariance to tables of `pole-eval features`.

Confidence: logistic regression on the terms and on the products of two terms that raise its likelihood most.
Covariance: a scale, log-linear in its terms. Squared errors divided by the true covariance are chi-square of
two degrees of freedom, an exponential distribution: a gamma regression.
Drives of one sensor share one weight, so that all sensors weigh alike. Terms are brought to mean 0 and variance
1 and cut off at 3, as PoleClassifier.cpp does. Needs python3-sklearn.
"""
import argparse
import csv
import json
import pathlib

import numpy as np
from sklearn.linear_model import GammaRegressor, LogisticRegression
from sklearn.metrics import average_precision_score, log_loss

KNOWN_AFTER_FIT = {"clutter", "excess", "radius", "density"}  # terms that the rough odds do not have
FARTHEST_TERM = 3  # standard deviations
HIGHEST_ODDS = 7  # that the covariance distinguishes
FAR_ERROR = 100  # a squared error beyond is not that of the pole's own centre
RIDGE = 100
PRODUCTS = 20
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


def sample_weights(drives, real_weight):
    """One array: all sensors weigh alike, a candidate of a real drive real_weight times a simulated one."""
    each = [np.full(len(drive.poles), float(real_weight if drive.real else 1)) for drive in drives]
    for sensor in {drive.sensor for drive in drives}:
        own = [weights for drive, weights in zip(drives, each) if drive.sensor == sensor]
        total = sum(weights.sum() for weights in own)
        for weights in own:
            weights /= total
    weights = np.concatenate(each)
    return weights * len(weights) / weights.sum()


def logistic(terms, poles, weights, ridge):
    return LogisticRegression(C=1 / ridge, tol=1e-6, max_iter=1000).fit(terms, poles, weights)


def best_product(terms, poles, weights, probabilities, taken):
    """The pair with the greatest score statistic: gradient squared by information."""
    residuals = weights * (poles - probabilities)
    information = weights * probabilities * (1 - probabilities)
    gradients = terms.T @ (terms * residuals[:, None])
    squares = (terms**2).T @ (terms**2 * information[:, None])
    score = np.divide(gradients**2, squares, out=np.zeros_like(squares), where=squares > 0)
    score[np.tril_indices(len(score))] = -1
    for pair in taken:
        score[pair] = -1
    return np.unravel_index(np.argmax(score), score.shape)


class Classifier:
    """Weights of both regressions, as in classifier.csv."""

    def __init__(self, drives, real_weight, ridge=RIDGE, products=PRODUCTS):
        self.names = drives[0].names
        terms = np.concatenate([drive.terms for drive in drives])
        poles = np.concatenate([drive.poles for drive in drives])
        weights = sample_weights(drives, real_weight)
        self.mean = np.average(terms, axis=0, weights=weights)
        deviation = np.sqrt(np.average((terms - self.mean) ** 2, axis=0, weights=weights))
        self.scale = np.divide(1, deviation, out=np.zeros_like(deviation), where=deviation > 1e-9)
        terms = self.standardized(terms)
        known = np.array([name not in KNOWN_AFTER_FIT for name in self.names])
        rough = logistic(terms * known, poles, weights, ridge)
        self.rough = np.r_[rough.intercept_, rough.coef_[0] * known]
        self.pairs, columns = [], terms
        full = logistic(columns, poles, weights, ridge)
        for _ in range(products):
            pair = best_product(terms, poles, weights, full.predict_proba(columns)[:, 1], self.pairs)
            self.pairs.append(pair)
            columns = np.c_[columns, terms[:, pair[0]] * terms[:, pair[1]]]
            full = logistic(columns, poles, weights, ridge)
        self.full = np.r_[full.intercept_, full.coef_[0]]

    def standardized(self, terms):
        return np.clip((terms - self.mean) * self.scale, -FARTHEST_TERM, FARTHEST_TERM)

    def odds(self, drive):
        terms = self.standardized(drive.terms)
        products = [terms[:, a] * terms[:, b] for a, b in self.pairs]
        return self.full[0] + np.column_stack([terms, *products]) @ self.full[1:]

    def write(self, path):
        lines = ["one,0,1,%.6g,%.6g" % (self.full[0], self.rough[0])]
        for row in zip(self.names, self.mean, self.scale, self.full[1:], self.rough[1:]):
            lines.append("%s,%.6g,%.6g,%.6g,%.6g" % row)
        for (a, b), weight in zip(self.pairs, self.full[1 + len(self.names) :]):
            lines.append("%s*%s,%.6g" % (self.names[a], self.names[b], weight))
        pathlib.Path(path).write_text(
            "# Weights of PoleClassifier, " + WRITTEN_BY + "# Rows \"a*b\": products of two terms brought to mean 0 "
            "and variance 1, and their weight.\nterm,mean,scale,full,rough\n" + "\n".join(lines) + "\n")


def write_covariance(path, drives, real_weight, classifier):
    """Fits the scale to the poles with a known error that the classifier accepts."""
    odds = np.concatenate([classifier.odds(drive) for drive in drives])
    errors = np.concatenate([drive.errors for drive in drives])
    terms = np.concatenate([drive.scale_terms for drive in drives])
    terms = np.c_[np.clip(odds, 0, HIGHEST_ODDS), terms]
    used = (np.concatenate([drive.poles for drive in drives]) == 1) & (odds >= 0) & (errors <= FAR_ERROR)
    if not used.any():
        raise SystemExit("fit_classifier.py: no pole has a known error; a simulated drive is needed")
    scale = GammaRegressor(alpha=1e-7, tol=1e-7, max_iter=10000)
    # The mean of chi-square of two degrees of freedom is 2; its density at 0 is finite, that of gamma is not.
    scale.fit(terms[used], np.maximum(errors[used], 1e-9) / 2, sample_weights(drives, real_weight)[used])
    names = ["one", "odds"] + [name[len("covariance_") :] for name in drives[0].scale_names]
    rows = zip(names, np.r_[scale.intercept_, scale.coef_])
    pathlib.Path(path).write_text("# Log-linear scale of the covariance of poles, " + WRITTEN_BY + "term,weight\n"
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
    options.add_argument("--real-weight", type=float, default=4,
                         help="weight of a candidate of a real drive; one of a simulated drive has 1")
    options.add_argument("--products", type=int, default=PRODUCTS, help="products of two terms")
    options.add_argument("--classifier", required=True, help="weights to write (CSV)")
    options.add_argument("--covariance", required=True, help="scale of the covariances to write (CSV)")
    options.add_argument("--json", help="scores to write; each real drive also by a fit to the others")
    options = options.parse_args()
    drives = [Drive(table) for table in options.tables]
    weight = options.real_weight
    classifier = Classifier(drives, weight, products=options.products)
    write_covariance(options.covariance, drives, weight, classifier)
    classifier.write(options.classifier)
    if not options.json:
        return
    scores = [report(drive, classifier, False) for drive in map(Drive, options.test)]
    for drive in drives:
        if drive.real:
            others = [other for other in drives if other is not drive]
            scores.append(report(drive, Classifier(others, weight, products=options.products), True))
    pathlib.Path(options.json).write_text(json.dumps({"real_weight": weight, "scores": scores}, indent=2) + "\n")
    for row in scores:
        print("%-24s %5d of %5d  log loss %.4f now, %.4f new" % (
            row["drive"], row["poles"], row["candidates"], row["built_in"]["log_loss"], row["new"]["log_loss"]))


if __name__ == "__main__":
    main()
