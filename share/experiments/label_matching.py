"""Labelled poles and poles of a map, one to one, as `pole-eval map --one-to-one` counts them."""
import csv

import numpy as np

MATCH = 1.0  # m, the greatest distance of a pair


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def places(path):
    rows = table(path)
    return np.array([[float(row["x"]), float(row["y"])] for row in rows]).reshape(-1, 2)


def distance(a, b):
    return np.hypot(a[..., 0] - b[..., 0], a[..., 1] - b[..., 1])


def matching(labels, poles):
    """Greatest one-to-one matching within MATCH; pairs begin with the nearest."""
    near = [[j for j in np.argsort(distance(poles, label), kind="stable") if distance(poles[j], label) <= MATCH]
            for label in labels]
    owner = {}

    def assign(label, tried):
        for pole in near[label]:
            if pole not in tried:
                tried.add(pole)
                if pole not in owner or assign(owner[pole], tried):
                    owner[pole] = label
                    return True
        return False

    order = sorted((k for k in range(len(labels)) if near[k]),
                   key=lambda k: (distance(poles[near[k][0]], labels[k]), k))
    for k in order:
        assign(k, set())
    return set(owner.values())
