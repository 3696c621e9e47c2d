"""Pictures of the programs: a PNG from what libpolemcl/src/report/picture/Pictures.cpp writes.

Usage: draw.py < PICTURE.json > PICTURE.png

Needs the Debian package python3-matplotlib. The same picture gives the same bytes.
"""

import io
import json
import sys

try:
    import matplotlib
    import numpy as np
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.colors import to_rgb
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D
    from matplotlib.patheffects import withStroke
    from matplotlib.ticker import MultipleLocator

    from style import INK, MUTED, round_steps, value_limit
except ImportError as error:
    sys.exit(f"{error}; install the package python3-matplotlib")

# Told apart by colour-blind eyes (Okabe and Ito 2008).
ORANGE, BLUE, GREEN, PINK, SKY, YELLOW = "#d55e00", "#0072b2", "#009e73", "#cc79a7", "#56b4e9", "#e6b800"
NAVY, OCHRE, BROWN, GREY, FRAME = "#0b4a86", "#e69f00", "#8a5a2b", "#aab2bd", "#b8bfc8"
LAYERS = [  # of a scan: from this height above ground on, colour, size, name
    (-np.inf, "#d0d5db", 1.4, "below 0.3 m"), (0.3, "#7aa6cf", 1.7, "0.3 to 2 m"),
    (2, NAVY, 1.7, "2 to 4 m"), (4, GREEN, 1.7, "above 4 m")]
TESTS = {  # that refuse segments, in their order
    "shape": "#c9ced6", "foreground": SKY, "height": GREEN, "circle": YELLOW, "free space": PINK}
SEGMENTS = [NAVY, OCHRE, GREEN, PINK, SKY, BROWN]
NO_RETURN, NEAR, FAR = "#f3f4f6", "#08306b", "#cfe1f2"

matplotlib.rcParams.update({
    "axes.edgecolor": FRAME, "axes.facecolor": "#f6f7f9", "axes.labelcolor": MUTED, "font.size": 14,
    "grid.color": "#dfe3e8", "text.color": INK, "xtick.major.pad": 6, "ytick.major.pad": 6})


class Page:
    """A white picture. Places are in pixels from its upper left corner, frames (x, y, width, height)."""

    def __init__(self, width, height):
        self.width, self.height = width, height
        self.figure = Figure(figsize=(width / 72, height / 72), dpi=72, facecolor="white")
        self.renderer = FigureCanvasAgg(self.figure).get_renderer()

    def at(self, x, y):
        """As shares of the page, from its lower left corner."""
        return x / self.width, 1 - y / self.height

    def axes(self, frame, **properties):
        x, y, width, height = frame
        axes = self.figure.add_axes((*self.at(x, y + height), width / self.width, height / self.height))
        axes.set(**properties)
        axes.xaxis.set_label_coords(0.5, -33 / height)
        axes.yaxis.set_label_coords(-58 / width, 0.5)
        return axes

    def map_axes(self, frame, places, margin):
        """Axes of equal scales round all places. Returns them and the pixels of a metre."""
        size, room = np.array(frame[2:]), np.array(frame[2:]) - 2 * margin
        low, high = np.min(places, axis=0), np.max(places, axis=0)
        metre = min(room / np.maximum(high - low, room / min(room)))  # a single place gets one metre
        (left, bottom), (right, top) = (low + high - size / metre) / 2, (low + high + size / metre) / 2
        axes = self.axes(frame, xlim=(left, right), ylim=(bottom, top), xlabel="x (m)", ylabel="y (m)")
        step = max(step_of(left, right, frame[2] // 80), step_of(bottom, top, frame[3] // 60))
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(MultipleLocator(step))
        axes.ticklabel_format(style="plain", useOffset=False)
        return axes, metre

    def pixels(self, axes, places):
        """Places of a plot as those of the page."""
        return axes.transData.transform(np.reshape(places, (-1, 2))) * (1, -1) + (0, self.height)

    def text(self, x, y, text, room=None, **style):
        """One line; smaller rather than wider than its room."""
        made = self.figure.text(*self.at(x, y), " ".join(text.split()), **style)
        if room and self.width_of(made) > room:
            made.set_fontsize(made.get_fontsize() * room / self.width_of(made))
        return made

    def width_of(self, artist):
        return artist.get_window_extent(self.renderer).width

    def legend(self, x, y, entries, side="left", handle=1):
        """Marks with their words in a row, from x on, or up to it. Returns its width."""
        return self.width_of(self.figure.legend(
            handles=entries, loc=f"center {side}", bbox_to_anchor=self.at(x, y), ncol=len(entries),
            fontsize=17, frameon=False, borderpad=0, borderaxespad=0, columnspacing=1.5, handletextpad=0.6,
            handlelength=handle))

    def png(self):
        out = io.BytesIO()
        self.figure.savefig(out, format="png", dpi=72, metadata={"Software": None})
        return out.getvalue()


def step_of(low, high, most):
    """Distance of the grid lines."""
    return np.diff(round_steps(max(3, most)).tick_values(low, high))[0]


def dot(name, color, rim="white", width=1.2, marker="o", size=12):
    return Line2D([], [], color="none", marker=marker, markersize=size, markerfacecolor=color,
                  markeredgecolor=rim, markeredgewidth=width, label=name)


def stroke(name, color, width):
    return Line2D([], [], color=color, linewidth=width, solid_capstyle="round", label=name)


def discs(axes, places, radius, color, rim="white", width=1.0):
    """Filled circles, their radii in pixels."""
    x, y = np.reshape(places, (-1, 2)).T
    axes.scatter(x, y, (2 * np.asarray(radius)) ** 2, color, edgecolors=rim, linewidths=width, zorder=3)


def lines(axes, paths, color, width):
    for path in paths:
        axes.plot(*np.transpose(path), color=color, linewidth=width, solid_capstyle="round", zorder=3)


def overlap(a, b):
    """Whether two frames share a pixel."""
    return a[0] < b[0] + b[2] and b[0] < a[0] + a[2] and a[1] < b[1] + b[3] and b[1] < a[1] + a[3]


HALO = [withStroke(linewidth=4, foreground="white")]


# Maps and paths


def layout(page, spread, with_errors):
    """Frames of map and errors. These go below the map (long streets) or to its right (others), whichever
    shows the map larger; title and legend are above."""
    left, top, width, height = 92, 96, page.width - 124, page.height - 158
    if not with_errors:
        return [(left, top, width, height)]
    x, y = np.maximum(spread, 1)
    free = height - 110  # without labels and the words above a strip
    map_height = np.clip(1.15 * width * y / x, 0.45 * free, 0.70 * free)
    strip, first = (free - map_height) / 2, top + map_height + 78
    below = [(left, top, width, map_height), (left, first, width, strip),
             (left, first + strip + 32, width, strip)]
    free = width - 96
    map_width = np.clip(1.15 * height * x / y, 0.40 * free, 0.60 * free)
    strip, column = height / 2 - 32, left + map_width + 96
    beside = [(left, top, map_width, height), (column, top + 32, free - map_width, strip),
              (column, top + strip + 64, free - map_width, strip)]
    return max(below, beside, key=lambda frames: min(frames[0][2] / x, frames[0][3] / y))


def ends(page, axes, frame, first, last):
    """Where the way begins and ends."""
    for place, name, color in ((first, "start", "white"), (last, "end", INK)):
        discs(axes, [place], 7, color, INK, 2)
        x, y = page.pixels(axes, place)[0]
        label = page.text(x, y + 28, name, fontsize=15, weight="bold", ha="center", path_effects=HALO)
        half = page.width_of(label) / 2 + 6
        label.set_x(np.clip(x, frame[0] + half, frame[0] + frame[2] - half) / page.width)


def scale_bar(page, axes, frame, metre, places):
    """In the corner where it hides least."""
    length = step_of(*axes.get_xlim(), 12)
    size = np.array((length * metre + 20, 42))
    x, y, width, height = frame
    shown = page.pixels(axes, places)
    corners = [(left, top) for top in (y + height - 52, y + 10) for left in (x + 10, x + width - size[0] - 10)]
    corner = min(corners, key=lambda one: np.sum(np.all((shown > np.array(one) - 8) &
                                                        (shown < one + size + 8), axis=1)))
    bar = page.axes((*corner, *size), xlim=(0, size[0]), ylim=(42, 0), xticks=[], yticks=[], zorder=3)
    bar.patch.set(facecolor="white", alpha=0.85)
    bar.spines[:].set_visible(False)
    bar.plot([10, size[0] - 10], [28, 28], color=INK, linewidth=3, marker="|", markersize=10, markeredgewidth=2)
    bar.text(size[0] / 2, 19, f"{length:g} m", fontsize=15, ha="center")


def significant(value):
    return f"{value:#.3g}".rstrip(".") if value < 1000 else f"{value:.0f}"


def thinned(x, y, columns):
    """The least and the largest value of each column of pixels, where there are many more."""
    if len(x) < 6 * columns:
        return x, y
    column = ((x - x[0]) / max(x[-1] - x[0], 1e-9) * columns).astype(int)
    starts = np.flatnonzero(np.diff(column, prepend=-1))
    both = np.transpose([np.minimum.reduceat(y, starts), np.maximum.reduceat(y, starts)])
    return np.repeat(x[starts], 2), both.ravel()


def error_strip(page, frame, name, unit, color, x, y, mean):
    """An error over the distance driven, with its mean; words above."""
    length = max(x[-1] - x[0], 1)
    limit = value_limit(y)
    axes = page.axes(frame, xlim=(x[0], x[0] + length), ylim=(0, limit), ylabel=f"{name} ({unit.strip()})")
    axes.xaxis.set_major_locator(round_steps(max(3, frame[2] // 80)))
    axes.yaxis.set_major_locator(round_steps(max(3, frame[3] // 60)))
    note = f"{name} error: mean {significant(mean)}{unit}, largest {significant(max(y))}{unit}"
    note += f" (above the strip, at {x[np.argmax(y)]:.0f} m)" if max(y) > limit else ""
    page.text(frame[0] + frame[2], frame[1] - 8, note, ha="right")
    x, y = thinned(x, y, frame[2])
    axes.fill_between(x, y, color=color, alpha=0.18, linewidth=0)
    axes.plot(x, y, color=color, linewidth=1.8)
    axes.axhline(mean, color=INK, linewidth=1.4, linestyle=(0, (5.6, 4.2)))
    return axes


def draw_errors(page, frames, errors):
    distance = np.array(errors["distance"])
    position, heading = errors["means"]
    rmse = errors["rmse"]
    page.text(92, 76, f"{errors['poses']} poses over {distance[-1]:.0f} m · position error: mean {position:.3f} m, "
              f"RMSE {rmse[0]:.3f} m · heading error: mean {heading:.3f}°, RMSE {rmse[1]:.3f}°",
              page.width - 124, fontsize=17, color=MUTED)
    error_strip(page, frames[0], "position", " cm", BLUE, distance, 100 * np.array(errors["position"]),
                100 * position).tick_params(labelbottom=False)
    error_strip(page, frames[1], "heading", "°", GREEN, distance, np.array(errors["heading"]),
                heading).set_xlabel("distance driven (m)")


def draw_map(picture):
    poles = np.reshape(picture["poles"], (-1, 3))
    loops = np.reshape(picture["loops"], (-1, 2, 2))
    truth, estimate = picture["truth"], picture["estimate"]
    places = np.concatenate([np.reshape(one, (-1, 2)) for one in (poles[:, :2], *truth, *estimate)])
    page = Page(1600, 1000)
    frame, *strips = layout(page, np.ptp(places, axis=0), picture["errors"])
    entries = [dot(f"poles of the map ({len(poles)})", ORANGE)] if len(poles) else []
    entries += [stroke("truth", GREY, 9)] if truth else []
    entries += [stroke("estimate", BLUE, 2.6)] if estimate else []
    entries += [stroke(f"loops ({len(loops)})", PINK, 5)] if len(loops) else []
    used = page.legend(page.width - 32, 36, entries, "right", 2)
    page.text(92, 44, picture["title"], page.width - 124 - 30 - used, fontsize=26, weight="bold")

    axes, metre = page.map_axes(frame, places, 28)
    # Thinner on large maps, so that both sides of a street stay apart.
    lines(axes, truth, GREY, np.clip(2.5 * metre, 5, 9))
    lines(axes, estimate, BLUE, np.clip(0.8 * metre, 1.8, 2.6))
    least = np.clip(1.5 * metre, 2.6, 4.5)
    discs(axes, poles[:, :2], np.maximum(least, poles[:, 2] * metre), ORANGE, width=0.25 * least)
    lines(axes, loops, PINK, 2)
    discs(axes, loops[:, 1], 5, PINK)
    if way := truth or estimate:
        ends(page, axes, frame, way[0][0], way[-1][-1])
    scale_bar(page, axes, frame, metre, places)
    if picture["errors"]:
        draw_errors(page, strips, picture["errors"])
    return page


def draw_diff(picture):
    same, moved = (np.reshape(picture[key], (-1, 2, 2)) for key in ("same", "moved"))
    new, vanished = (np.reshape(picture[key], (-1, 3))[:, :2] for key in ("new", "vanished"))
    places = np.concatenate([same.reshape(-1, 2), moved.reshape(-1, 2), new, vanished])
    page = Page(1600, 1000)
    used = page.legend(page.width - 32, 36, [
        dot(f"new ({len(new)})", GREEN), dot(f"vanished ({len(vanished)})", "white", ORANGE, 3),
        dot(f"moved ({len(moved)})", BLUE), dot(f"the same ({len(same)})", GREY)], "right")
    page.text(92, 44, picture["title"], page.width - 124 - 30 - used, fontsize=26, weight="bold")
    frame = layout(page, None, False)[0]
    axes, metre = page.map_axes(frame, places, 28)
    size = np.clip(1.5 * metre, 2.6, 4.5)
    discs(axes, same[:, 1], size, GREY)
    discs(axes, vanished, 1.6 * size, "white", ORANGE, 0.8 * size)
    lines(axes, moved, BLUE, 2)
    discs(axes, moved[:, 0], size, "white", BLUE, 0.5 * size)
    discs(axes, moved[:, 1], 1.6 * size, BLUE)
    discs(axes, new, 1.6 * size, GREEN)
    scale_bar(page, axes, frame, metre, places)
    return page


# Scans


def draw_labels(page, frame, rings, labels):
    """Beside the ring, above or below it, where no other text or ring is; else where it was tried last."""
    taken = [(x - ring, y - ring, 2 * ring, 2 * ring) for x, y, ring in rings]
    for (x, y, ring), label in zip(rings, labels):
        text = page.text(0, 0, label, fontsize=13, va="center", path_effects=HALO)
        width = page.width_of(text)
        tried = [(left, top, width, 15) for top in (y - 7.5, y - ring - 15, y + ring)
                 for left in (x + ring + 4, x - ring - 4 - width) if left + width <= frame[0] + frame[2]]
        place = next((one for one in tried if not any(overlap(one, other) for other in taken)), tried[-1])
        text.set_position(page.at(place[0], place[1] + 7.5))
        taken.append(place)


def draw_scan(picture):
    points, poles = np.reshape(picture["points"], (-1, 3)), np.reshape(picture["poles"], (-1, 5))
    page, reach = Page(1500, 1500), picture["reach"]
    frame = (80, 84, 1396, 1356)
    page.text(80, 38, picture["title"], 1396, fontsize=22, weight="bold")
    page.legend(80, 64, [*(dot(name, color, color, 0, "s", 10) for _, color, _, name in LAYERS), dot(
        f"{len(poles)} poles: top above ground · confidence", "none", ORANGE, 2.4, size=14)])
    axes, metre = page.map_axes(frame, [(-reach, -reach), (reach, reach)], 0)
    upper = [*(layer[0] for layer in LAYERS[1:]), np.inf]
    for (low, color, size, _), high in zip(LAYERS, upper):
        x, y, _ = points[(points[:, 2] >= low) & (points[:, 2] < high)].T
        axes.scatter(x, y, size ** 2, color, marker="s", linewidths=0, zorder=3)
    discs(axes, [(0, 0)], 6, INK, "white", 1.5)
    rings = np.maximum(9, poles[:, 2] * metre + 5)
    discs(axes, poles[:, :2], rings, "none", ORANGE, 2.4)
    draw_labels(page, frame, np.column_stack([page.pixels(axes, poles[:, :2]), rings]),
                [f"{top:.1f} m · {confidence:.2f}" for top, confidence in poles[:, 3:]])
    return page


def draw_range_image(picture):
    rows, columns, segments = picture["rows"], picture["columns"], picture["segments"]
    ranges = np.array(picture["ranges"])[:, None]
    share = np.minimum(1, ranges / picture["max_range"])
    images = [np.tile(to_rgb(NO_RETURN), (rows * columns, 1)) for _ in range(3)]
    images[0] = np.where(ranges > 0, (1 - share) * to_rgb(NEAR) + share * to_rgb(FAR), images[0])
    tests = {**TESTS, "none": ORANGE}
    for i, segment in enumerate(segments):
        images[1][segment["pixels"]] = to_rgb(SEGMENTS[i % len(SEGMENTS)])
        images[2][segment["pixels"]] = to_rgb(tests[segment["refused_by"]])

    width, height = columns * max(1, 1500 // columns), rows * max(2, 220 // rows)
    tops = [92 + i * (height + 44) for i in range(3)]
    page = Page(width + 48, tops[2] + height + 24)
    page.text(24, 38, picture["title"], width, fontsize=22, weight="bold")
    refused = [one["refused_by"] for one in segments]
    captions = ["1. Range: dark is near, grey has no return that is used. The middle looks ahead, the first "
                "quarter to the left", f"2. Segments: {len(segments)}, in changing colours",
                "3. Refused by the test of"]
    for top, image, caption in zip(tops, images, captions):
        axes = page.axes((24, top, width, height), xticks=[], yticks=[])
        axes.imshow(image.reshape(rows, columns, 3), aspect="auto", interpolation="nearest")
        said = page.text(24, top - 12, caption, width, fontsize=17)
    entries = [dot(f"{name} {refused.count(name)}", color, color, 0, "s", 13) for name, color in TESTS.items()]
    entries.append(dot(f"none: {refused.count('none')} poles", ORANGE, ORANGE, 0, "s", 13))
    page.legend(24 + page.width_of(said) + 18, tops[2] - 18, entries)
    return page


DRAWN = {"map": draw_map, "diff": draw_diff, "scan": draw_scan, "range image": draw_range_image}


def main():
    if len(sys.argv) > 1:
        print(__doc__.split("\n\n")[1], file=sys.stderr)
        return 2
    try:
        picture = json.loads(sys.stdin.buffer.read())
        png = DRAWN[picture["kind"]](picture).png()
        with open(sys.stdout.fileno(), "wb", closefd=False) as out:  # all or an error, also with PYTHONUNBUFFERED
            out.write(png)
    except (OSError, ValueError) as error:
        print(f"draw.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
