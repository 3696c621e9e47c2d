"""Looks of the pictures that share/report/draw.py makes; test_Pictures.cpp tests what the programs hand it."""

import io
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import unittest

import matplotlib.image
import numpy as np

SCRIPTS = pathlib.Path(__file__).parents[3] / "share/report"
sys.path.insert(0, str(SCRIPTS))
import draw  # noqa: E402

MAP = {"kind": "map", "title": "A street", "poles": [[0, 6, 0.1], [20, -6, 0.1]], "truth": [[[0, 0], [20, 0]]],
       "estimate": [[[0, 1], [20, 1]]], "loops": [[0, 1, 20, 1]], "errors": None}
ERRORS = {"poses": 3, "distance": [0, 10, 20], "means": [0.02, 0.5], "rmse": [0.03, 0.6],
          "position": [0.01, 0.03, 0.02], "heading": [0.5, 0.4, 0.6]}
DIFF = {"kind": "diff", "title": "a → b", "same": [[0, 0, 0, 0]], "moved": [[5, 5, 6, 6]], "new": [[9, 9, 0.1]],
        "vanished": []}
SCAN = {"kind": "scan", "title": "A scan", "reach": 12, "points": [[1, 2, 0.1], [3, 4, 5]],
        "poles": [[3, 4, 0.1, 4.56, 0.9]]}
RANGES = {"kind": "range image", "title": "", "rows": 2, "columns": 3, "max_range": 50,
          "ranges": [0, 5, 50, 0, 5, 50],
          "segments": [{"refused_by": "none", "pixels": [1, 4]}, {"refused_by": "height", "pixels": [2]}]}


def page(picture, **changes):
    picture = {**picture, **changes}
    return draw.DRAWN[picture["kind"]](picture)


def pixels(made):
    return np.round(255 * matplotlib.image.imread(io.BytesIO(made.png()))[..., :3]).astype(int)


def words(made):
    """All that is written on a page, below and in its plots and legends."""
    return [text.get_text() for text in made.figure.findobj(draw.matplotlib.text.Text) if text.get_text()]


class Drawing(unittest.TestCase):
    def test_every_kind_has_its_size_title_and_counts(self):
        for picture, size, said in (
                (MAP, (1000, 1600), ["A street", "poles of the map (2)", "truth", "estimate", "loops (1)"]),
                (DIFF, (1000, 1600), ["a → b", "new (1)", "vanished (0)", "moved (1)", "the same (1)"]),
                (SCAN, (1500, 1500), ["A scan", "1 poles: top above ground · confidence", "4.6 m · 0.90"]),
                (RANGES, (864, 1548), ["shape 0", "height 1", "none: 1 poles"])):
            with self.subTest(picture["kind"]):
                made = page(picture)
                self.assertLessEqual(set(said), set(words(made)))
                self.assertEqual(pixels(made).shape[:2], size)

    def test_what_is_not_there_is_not_in_the_legend(self):
        said = words(page(MAP, poles=[], truth=[], loops=[]))
        self.assertIn("estimate", said)
        for absent in ("truth", "poles of the map (0)", "loops (0)"):
            self.assertNotIn(absent, said)

    def test_one_pole_alone_is_a_picture(self):
        made = page(MAP, poles=[[4e5, 5.8e6, 0.1]], truth=[], estimate=[], loops=[])
        left, right = made.figure.axes[0].get_xlim()
        self.assertTrue(1 <= right - left < 3)
        self.assertTrue(left < 4e5 < right)

    def test_errors_are_below_a_long_street_and_beside_a_square_town(self):
        street, town = (page(MAP, errors=ERRORS, truth=[[[0, 0], place]]).figure.axes[:4]
                        for place in ([300, 20], [300, 300]))
        for axes, below in ((street, True), (town, False)):
            shown = axes[0].get_position()
            strips = [one.get_position() for one in axes if "(°)" in one.get_ylabel() or "(cm)" in one.get_ylabel()]
            self.assertEqual(len(strips), 2)
            for strip in strips:
                self.assertEqual(strip.y1 < shown.y0, below)
                self.assertEqual(strip.x0 > shown.x1, not below)

    def test_errors_are_told_in_words(self):
        said = words(page(MAP, errors=ERRORS))
        self.assertIn("3 poses over 20 m · position error: mean 0.020 m, RMSE 0.030 m · heading error: "
                      "mean 0.500°, RMSE 0.600°", said)
        self.assertIn("position error: mean 2.00 cm, largest 3.00 cm", said)

    def test_a_value_far_above_the_strip_is_told(self):
        said = words(page(MAP, errors={**ERRORS, "distance": list(range(100)), "position": [0.5] + 99 * [0.01],
                                       "heading": 100 * [0.1]}))
        self.assertIn("position error: mean 2.00 cm, largest 50.0 cm (above the strip, at 0 m)", said)

    def test_long_titles_end_before_the_legend(self):
        made = page(DIFF, title="a very long name of a map " * 6)
        title = next(text for text in made.figure.texts if "long" in text.get_text())
        legend = made.figure.legends[0]
        self.assertLess(title.get_window_extent(made.renderer).x1, legend.get_window_extent(made.renderer).x0)
        self.assertGreater(title.get_fontsize(), 5)

    def test_peaks_of_long_drives_stay(self):
        x = np.arange(100000.0)
        y = np.ones(100000)
        y[31415], y[27182] = 9, 0
        thin_x, thin_y = draw.thinned(x, y, 1000)
        self.assertLess(len(thin_x), 2100)
        self.assertEqual((max(thin_y), min(thin_y)), (9, 0))
        self.assertLess(abs(thin_x[np.argmax(thin_y)] - 31415), 110)

    def test_labels_of_poles_make_room_and_stay_inside(self):
        made = page(SCAN, poles=[*([0.05 * i, 2, 0.1, 3, 1] for i in range(3)), [11.9, -5, 0.1, 3, 1]])
        boxes = [text.get_window_extent(made.renderer) for text in made.figure.texts if " m · " in text.get_text()]
        self.assertEqual(len(boxes), 4)
        for i, box in enumerate(boxes):
            self.assertLess(box.x1, 1476)
            self.assertFalse(any(box.overlaps(other) for other in boxes[:i]))

    def test_segments_are_coloured_by_what_became_of_them(self):
        image = pixels(page(RANGES))
        height = 220
        row = 92 + 2 * (height + 44) + 20  # in the upper row of the third copy
        self.assertEqual([tuple(image[row, 24 + 500 * i + 250]) for i in range(3)],
                         [(0xf3, 0xf4, 0xf6), (0xd5, 0x5e, 0x00), (0x00, 0x9e, 0x73)])

    def test_the_scale_bar_goes_where_nothing_is(self):
        for first, last, left in (([0, -6], [20, 6], False), ([0, 6], [20, -6], True)):
            made = page(MAP, poles=[], truth=[], estimate=[[first, last]], loops=[])
            bar = next(axes for axes in made.figure.axes if not len(axes.get_xticks()))
            self.assertEqual(bar.get_position().x1 < 0.5, left)
            self.assertLess(bar.get_position().y1, 0.5)


class Usage(unittest.TestCase):
    def run_script(self, picture, path="", *arguments):
        return subprocess.run([sys.executable, "-B", SCRIPTS / "draw.py", *arguments], input=picture,
                              env={**os.environ, "PYTHONPATH": path}, capture_output=True, check=False)

    def test_same_picture_same_bytes_without_date_and_version(self):
        first, again = (self.run_script(json.dumps(MAP).encode()).stdout for _ in range(2))
        self.assertEqual(first, again)
        self.assertEqual(first[:4], b"\x89PNG")
        self.assertNotIn(b"Software", first)

    def test_says_what_is_wrong_in_its_last_line(self):
        done = self.run_script(b"{")
        self.assertEqual((done.returncode, done.stdout), (1, b""))
        self.assertTrue(done.stderr.splitlines()[-1].startswith(b"draw.py: "))
        self.assertEqual(self.run_script(b"", "", "more").returncode, 2)

    def test_a_picture_that_cannot_be_written_whole_is_a_failure(self):
        with tempfile.TemporaryFile() as out:
            done = subprocess.run(
                [sys.executable, "-B", SCRIPTS / "draw.py"], input=json.dumps(MAP).encode(), stdout=out,
                stderr=subprocess.PIPE, env={**os.environ, "PYTHONUNBUFFERED": "1"},
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (9000, 9000)), check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn(b"draw.py: ", done.stderr.splitlines()[-1])

    def test_names_the_package_that_is_missing(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "matplotlib.py").write_text("raise ImportError('None here')", encoding="utf-8")
            done = self.run_script(json.dumps(MAP).encode(), folder)
        self.assertEqual((done.returncode, done.stdout), (1, b""))
        self.assertEqual(done.stderr, b"None here; install the package python3-matplotlib\n")


if __name__ == "__main__":
    unittest.main()
