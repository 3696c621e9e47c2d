"""Style of all plots: colours, and how Matplotlib draws. Sizes are in pixels: 72 of them are an inch."""

import logging
import math

import matplotlib
from matplotlib.ticker import MaxNLocator

SERIES = ["#0072b2", "#c65102", "#00805d", "#a3447f", "#7d6608", "#4a5bd0"]
TRUTH, INK, MUTED, RULE, PANEL, PAPER = (
    "#b9bdc4", "#1d1f23", "#5d6269", "#d9d6ce", "#f4f2ec", "#fcfbf8")

# Newer versions tell for each map that equal scales widen its limits, which is meant.
logging.getLogger("matplotlib.axes").setLevel(logging.ERROR)
matplotlib.rcdefaults()  # whatever the user's own matplotlibrc says
matplotlib.rcParams.update({
    "axes.axisbelow": True, "axes.edgecolor": "none", "axes.facecolor": PANEL, "axes.grid": True,
    "axes.labelcolor": INK, "font.size": 13, "grid.color": RULE, "grid.linewidth": 1,
    "lines.scale_dashes": False, "svg.fonttype": "none", "text.parse_math": False,
    "xtick.color": MUTED, "xtick.major.size": 0, "ytick.color": MUTED, "ytick.major.size": 0,
})


def round_steps(most):
    """Grid lines in round steps, at most this number of them."""
    return MaxNLocator(most, steps=[1, 2, 5, 10])


def value_limit(values):
    """A little above the largest value, but not above 2.2 times the 95th percentile."""
    ranked = sorted(values) or [1]
    return max(1.1 * min(ranked[-1], 2 * ranked[math.ceil(0.95 * len(ranked)) - 1]), 1e-3)
