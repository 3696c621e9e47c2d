#!/usr/bin/env python3
"""Plots of results as SVG, for the pages of share/doc.

Usage: plots.py health RUN_HEALTH.csv OUT.svg    state and matched share over a drive
       plots.py year YEAR.json OUT.svg           the result of share/experiments/year.sh
"""
import csv
import json
import sys

WIDTH, LEFT, RIGHT = 900, 70, 20
STATES = {"ok": "#009e73", "degraded": "#e6b800", "lost": "#d55e00"}
LINES = {"upkeep": ("#0072b2", "kept up by the localizer's own poses"),
         "never": ("#d55e00", "the map of May, never changed")}


def text(x, y, content, anchor="middle", more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{more}>{content}</text>'


def line(points, color, width=2):
    path = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="{width}"/>'


class Panel:
    """Axes: from values to pixels, a grid line and a number for each tick of y."""

    def __init__(self, top, height, x_range, y_range):
        self.top, self.height, self.x_range, self.y_range = top, height, x_range, y_range

    def x(self, value):
        low, high = self.x_range
        return LEFT + (value - low) / (high - low) * (WIDTH - LEFT - RIGHT)

    def y(self, value):
        low, high = self.y_range
        return self.top + self.height - (value - low) / (high - low) * self.height

    def grid(self, title, ticks):
        parts = [text(LEFT, self.top - 10, title, "start", ' font-weight="bold"')]
        for tick in ticks:
            parts.append(line([(LEFT, self.y(tick)), (WIDTH - RIGHT, self.y(tick))], "#d8dce1", 1))
            parts.append(text(LEFT - 8, self.y(tick) + 5, f"{tick:g}", "end"))
        return parts


def legend(entries, y):
    parts, x = [], LEFT
    for color, name in entries:
        parts.append(f'<rect x="{x}" y="{y - 11}" width="13" height="13" fill="{color}"/>')
        parts.append(text(x + 19, y, name, "start"))
        x += 19 + 8.2 * len(name) + 24
    return parts


def page(parts, height):
    return "\n".join([f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" '
                      'font-family="sans-serif" font-size="15" fill="#1f2328">',
                      f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>', *parts,
                      "</svg>", ""])


def spans(rows):
    """Stretches of one state and reason: first time, last time, state, reason."""
    found = []
    for row in rows:
        key = row["state"], row["reason"]
        if found and tuple(found[-1][2:]) == key:
            found[-1][1] = row["time"]
        else:
            if found:
                found[-1][1] = row["time"]
            found.append([row["time"], row["time"], *key])
    return found


def health(source):
    with open(source, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    begin = float(rows[0]["timestamp"])
    for row in rows:
        row["time"] = float(row["timestamp"]) - begin
    panel = Panel(70, 200, (0, rows[-1]["time"]), (0, 1))
    parts = panel.grid("Share of the observed poles that stand on the map", [0, 0.25, 0.5, 0.75, 1])
    parts += legend([(color, name) for name, color in STATES.items()], 30)
    before = "none"
    ends = [0, 0]  # of the last word in each of two lines
    for first, last, state, reason in spans(rows):
        left, right = panel.x(first), panel.x(last)
        for top, height, opacity in ((panel.top, panel.height, 0.16), (280, 16, 1)):
            parts.append(f'<rect x="{left:.1f}" y="{top}" width="{right - left:.1f}" '
                         f'height="{height}" fill="{STATES[state]}" fill-opacity="{opacity}"/>')
        middle, half = max((left + right) / 2, LEFT + 32), 4.2 * len(reason)
        free = [k for k in (0, 1) if ends[k] < middle - half]
        if reason not in ("none", before) and free:  # there is no room for all that are short
            parts.append(text(middle, 315 + 18 * free[0], reason))
            ends[free[0]] = middle + half
        before = reason
    parts.append(line([(panel.x(row["time"]), panel.y(float(row["matched_share"])))
                       for row in rows], "#1f2328", 1.5))
    for tick in range(0, int(rows[-1]["time"]) + 1, 20):
        parts.append(text(panel.x(tick), 358, str(tick)))
    parts.append(text((LEFT + WIDTH - RIGHT) / 2, 380, "time (s)"))
    return page(parts, 392)


def year(source):
    with open(source, encoding="utf-8") as file:
        result = json.load(file)
    months = [row["session"] for row in result["sessions"] if row["setting"] == "never"]
    across = (-0.5, len(months) - 0.5)
    errors, scores = Panel(80, 150, across, (0, 0.12)), Panel(280, 150, across, (0.4, 1))
    parts = legend(LINES.values(), 30)
    parts += errors.grid("Mean error of the position (m)", [0, 0.04, 0.08, 0.12])
    parts += scores.grid("Score F1 of the map after that month (1: all poles right, no other)",
                         [0.4, 0.6, 0.8, 1])
    for setting, (color, _) in LINES.items():
        for panel, key, rows, name in ((errors, "pos_mean_m", result["sessions"], "session"),
                                       (scores, "f1", result["maps"], "month")):
            points = [(panel.x(months.index(row[name])), panel.y(row[key])) for row in rows
                      if row["setting"] == setting and row[name] in months]
            parts.append(line(points, color))
            parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{color}"/>'
                      for x, y in points]
    for place, month in enumerate(months):
        parts.append(text(errors.x(place), 455, month[:3].capitalize()))
    return page(parts, 470)


def main():
    plots = {"health": health, "year": year}
    if len(sys.argv) != 4 or sys.argv[1] not in plots:
        sys.exit(__doc__)
    with open(sys.argv[3], "w", encoding="utf-8") as file:
        file.write(plots[sys.argv[1]](sys.argv[2]))


if __name__ == "__main__":
    main()
