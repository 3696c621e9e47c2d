"""Plots of the report: Matplotlib's SVG, in the colours of the page, which follow light and dark."""

import io
import itertools
import math
import re

import matplotlib
from markupsafe import Markup, escape
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from quantities import metres, number, plural
from style import INK, MUTED, PANEL, PAPER, RULE, SERIES, TRUTH, round_steps, value_limit

# What Matplotlib draws with, and the variable of report.css that takes its place.
VARIABLES = {
    TRUTH: "truth", INK: "ink", MUTED: "muted", RULE: "rule", PANEL: "panel", PAPER: "paper",
    **{color: f"s{i}" for i, color in enumerate(SERIES)},
}
DASHES = ["-", (0, (7, 3)), (0, (2, 3)), (0, (9, 3, 2, 3)), (0, (12, 4)), (0, (4, 2))]
MARKS = "os^D"
ARROW = Path([(-0.5, 0), (0, 0.6), (0.5, 0), (0, 0.6), (0, -0.8)])  # a value above the plot
EXPONENTS = [-3 + i / 10 for i in range(51)]  # edges of the histograms' bins: 1 mm to 100 m
LONGEST_NAME, MOST_NAMES = 16, 60  # characters, labels


def dashes(i):
    """Of setting i: from the seventh on, colours come again with other dashes."""
    return DASHES[(i + i // 6) % 6]


class Plot:
    """A figure with one pair of axes; sizes in pixels."""

    _ids = itertools.count(1)

    def __init__(self, width, height, x, y):
        self.size, self.hints = (width, height), []
        self.figure = Figure(figsize=(width / 72, height / 72), dpi=72, layout="constrained")
        self.figure.patch.set_visible(False)
        self.axes = self.figure.subplots()
        self.axes.set(xlabel=x, ylabel=y)
        for axis, most in ((self.axes.xaxis, width // 90), (self.axes.yaxis, height // 45)):
            axis.set_major_locator(round_steps(most))

    def errors_from_zero(self, limit, name, unit):
        """Titles the axis of y: centimetres for lengths below 0.1 m. Returns how many a unit has."""
        scale, shown = (100, "cm") if unit == "m" and limit <= 0.1 else (1, unit)
        self.axes.set(ylim=(0, scale * limit), ylabel=f"{name} ({shown})")
        return scale

    def hint(self, text):
        """The id of a shape that shows this text under the pointer."""
        self.hints.append(text)
        return f"hint{len(self.hints) - 1}"

    def svg(self, classes, title, description):
        name = f"p{next(self._ids)}"
        out = io.StringIO()
        with matplotlib.rc_context({"svg.hashsalt": name}):
            self.figure.savefig(out, format="svg")
        # What comes before, with the date, and the style for the whole page are left out.
        shapes = re.search(r"</style>\s*</defs>(.*)</svg>", out.getvalue(), re.DOTALL)[1]
        shapes = re.sub(r"<!--.*?-->|(?<=\n) +", "", shapes, flags=re.DOTALL)
        shapes = re.sub(r"<[^>]*>", lambda tag: self._tag(tag[0]), shapes)
        return Markup(
            '<svg class="plot {}" viewBox="0 0 {:g} {:g}" role="img" aria-labelledby="{}t {}d">\n'
            '<title id="{}t">{}</title>\n<desc id="{}d">{}</desc>\n{}</svg>').format(
                classes, *self.size, name, name, name, title, name, description, Markup(shapes))

    def _tag(self, tag):
        """A tag as the page has it: its colours, tenths of a pixel, no ids of Matplotlib's groups."""
        hint = re.match(r'<g id="hint(\d+)">', tag)
        if hint:
            return f"<g><title>{escape(self.hints[int(hint[1])])}</title>"
        tag = re.sub(r'<g id="[^"]*"/>| transform="rotate\(-0 [^"]*"', "", tag)
        tag = re.sub(r'<g id="[^"]*">', "<g>", tag)
        tag = re.sub(r"(?<=\d\.\d)\d+", "", tag)
        tag = re.sub(r"'DejaVu Sans'[^;\"]*", "var(--sans)", tag)
        return re.sub(r"#[0-9a-f]{6}\b", lambda color: f"var(--{VARIABLES[color[0]]})", tag)


def sessions_figure(report, key, name, unit):
    """Mean and deviation of every session, settings side by side. Returns the SVG and what is above it."""
    names = [one["name"] for one in report.sessions]
    labels = [one if len(one) <= LONGEST_NAME else one[:LONGEST_NAME] + "…" for one in names]
    turned = 8 * max(map(len, labels)) > 880 / len(labels)
    plot = Plot(960, 330 + turned * 5 * max(map(len, labels)), "session", "")
    figures = [{one["session"]: one["figures"][key] for one in setting["summary"]["sessions"]
                if one["figures"][key]["count"]} for setting in report.settings]
    limit = value_limit([one["mean"] + (one["deviation"] or 0)
                         for sessions in figures for one in sessions.values()])
    scale = plot.errors_from_zero(limit, name, unit)
    step = -(-len(names) // MOST_NAMES)
    plot.axes.set_xticks(range(0, len(names), step), labels[::step], rotation=45 if turned else 0,
                         ha="right" if turned else "center", rotation_mode="anchor")
    plot.axes.set_xlim(-0.5, len(names) - 0.5)
    apart = min(0.0125 * len(names), 1 / (len(figures) + 1))  # at most 11 pixels
    above = []
    for i, (setting, sessions) in enumerate(zip(report.settings, figures)):
        color, points = SERIES[i % 6], []
        for k, session in enumerate(names):
            one = sessions.get(session, {"mean": math.nan, "deviation": None})
            x, mean, deviation = k + (i - (len(figures) - 1) / 2) * apart, one["mean"], one["deviation"]
            points.append((x, scale * mean))
            if session not in sessions:
                continue
            figure = metres(mean, " ") if unit == "m" else f"{number(mean, 3)} {unit}"
            hint = f"{session}, {setting['name']}: {figure}"
            mark = {"marker": MARKS[i % 4], "ms": 8, "mfc": color, "mec": PAPER}
            if mean > limit:
                above.append(hint)
                mark = {"marker": ARROW, "ms": 14, "mfc": "none", "mec": color, "mew": 2.2}
            elif deviation:
                plot.axes.vlines(x, scale * max(0, mean - deviation), scale * (mean + deviation),
                                 color=color, linewidth=2, alpha=0.5)
            plot.axes.plot([x], [scale * min(mean, limit)], color=color, clip_on=False, zorder=3,
                           gid=plot.hint(hint), **mark)
        plot.axes.plot(*zip(*points), color=color, linewidth=1.4, linestyle=dashes(i), alpha=0.75)
    description = (f"Mean over the runs of each session, bars of one standard deviation, for "
                   f"{plural(len(figures), 'setting')}.")
    return plot.svg("wide", f"{name} per session", description), above


def decade(power, unit):
    """-2 as "1 cm" or "0.01°"."""
    if unit == "°":
        return f"{number(10.0 ** power, max(0, -power))}°"
    shift, prefix = (3, "m") if power == -3 else (2, "c") if power < 0 else (0, "")
    return f"{10 ** (power + shift)} {prefix}m"


def histogram_figure(report, key, name, unit):
    """Shares of the poses of all runs and sessions."""
    plot = Plot(480, 300, name, "share of poses (%)")
    used = []
    for i, setting in enumerate(report.settings):
        counts = [sum(bins) for bins in zip(*(one["plots"][key] for one in setting["results"]))]
        used += [k for k, one in enumerate(counts) if one]
        shares = [100 * one / (sum(counts) or math.nan) for one in counts]
        style = {"baseline": None, "color": SERIES[i % 6]}
        plot.axes.stairs(shares, EXPONENTS, fill=True, alpha=0.13, color=SERIES[i % 6])
        plot.axes.stairs(shares, EXPONENTS, linewidth=2, linestyle=dashes(i), **style)
    low = min(used) // 10 - 3
    plot.axes.set(xlim=(low, max(low + 2, max(used) // 10 - 2)), ylim=(0, None))
    plot.axes.set_xticks(ticks := range(low, round(plot.axes.get_xlim()[1]) + 1),
                         [decade(power, unit) for power in ticks])
    return plot.svg("", f"Histogram of the {name}", "Share of the compared poses of all runs and "
                    "sessions over the error on a logarithmic scale.")


def distance_figure(report, session):
    """Errors of run 0 over the distance driven. Returns the SVG, the bin and the largest; or None."""
    curves = [(i, result["plots"]["position_bin_m"], result["plots"]["position_largest_m"])
              for i, setting in enumerate(report.settings) for result in setting["results"]
              if result["session"] == session["name"]]
    values = [value for _, _, largest in curves for value in largest if value is not None]
    if not values:
        return None
    plot = Plot(960, 252, "distance driven (m)", "")
    scale = plot.errors_from_zero(value_limit(values), "position error", "m")
    for i, width, largest in curves:
        plot.axes.stairs([math.nan if value is None else scale * value for value in largest],
                         [k * width for k in range(len(largest) + 1)], baseline=None,
                         color=SERIES[i % 6], linewidth=1.3)
    plot.axes.set_xlim(0, max(width * len(largest) for _, width, largest in curves))
    width = max(width for _, width, _ in curves)
    return (plot.svg("wide", "Position error over distance", "Position error of run 0 over the distance "
                     f"driven, the largest in every {number(width, 0)} m."), width, max(values))


def map_figure(result):
    """Map, true path and estimate of run 0, north up; None when there is nothing to draw."""
    plots = result["plots"]
    poles, truth, estimate = (list(zip(plots[key][::2], plots[key][1::2]))
                              for key in ("map_poles_xy", "truth_xy", "estimate_xy"))
    # Poles far from any path are of other sessions; the plot shows where this one went.
    content = truth or estimate or poles
    if not content:
        return None
    (left, right), (low, high) = ((min(axis), max(axis)) for axis in zip(*content))
    rim = max(20, 0.05 * max(right - left, high - low))
    left, right, low, high = left - rim, right + rim, low - rim, high + rim
    plot = Plot(480, 60 + min(max(400 * (high - low) / (right - left), 180), 440), "x (m)", "y (m)")
    plot.axes.set_aspect("equal", adjustable="datalim")
    plot.axes.ticklabel_format(style="plain", useOffset=False)
    plot.axes.axis((left, right, low, high))
    plot.axes.plot(*zip(*truth), color=TRUTH, linewidth=5)
    # A line of no length with round ends is a dot.
    path = Path([pole for pole in poles for _ in range(2)] or [(left, low)] * 2,
                [Path.MOVETO, Path.LINETO] * max(1, len(poles)))
    path.should_simplify = False
    plot.axes.add_patch(PathPatch(path, fill=False, edgecolor=SERIES[1], linewidth=3.2,
                                  capstyle="round", zorder=2))
    plot.axes.plot(*zip(*estimate), color=SERIES[0], linewidth=1.6)
    plot.axes.plot(*zip(*truth[:1]), color=INK, marker="o", markersize=9)
    return plot.svg("map", f"Map and paths of {result['session']}", "Map poles, true path and the path "
                    f"estimated by run 0 with the setting {result['setting']}, seen from above.")
