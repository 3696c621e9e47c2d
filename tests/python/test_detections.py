"""share/experiments/fit_detections.py finds the model that detections are drawn from."""

import importlib.util
import itertools
import pathlib
import tempfile
import unittest

import numpy as np
from street import program

SOURCE = pathlib.Path(__file__).resolve().parents[2]
HAS_SCIPY = importlib.util.find_spec("scipy") is not None
NORMAL = [-2.878, -2.326, -1.645, -1.036, -0.5244, 0, 0.5244, 1.036, 1.645, 2.326, 2.878]  # at LEVELS
SETTINGS = """[sensor]
model = hdl32e
height_m = 1
[simulation]
spacing_m = 0.5
detections = {model}
[world]
seed = 11
length_m = 1200
removed_share = 0
"""
HEAD = {"sensor": "hdl32e", "height_m": 1, "max_range_m": 40, "spacing_m": 0.5, "seed": 11, "day": 0, "track": "",
        "street_m": 100, "driven_m": 98}
FOUND = [0.05, 0.05, 0.6, 0.8, 0.75, 0, 0.2, 3, 20]  # 3 cm too far and 4 cm to the left


def script():
    specification = importlib.util.spec_from_file_location(
        "fit_detections", SOURCE / "share/experiments/fit_detections.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


@unittest.skipUnless(HAS_SCIPY, "python3-scipy is not installed")
class FitDetections(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.fit = script()

    def plain_model(self):
        """Poles are found with 0.8 at 5 m and 0.4 at 35 m; errors of 5 cm in both directions."""
        fit, zeros = self.fit, np.zeros(5)
        reported = {name: np.full((1, 11), float(value))
                    for name, value in zip(fit.REPORTED, [0.05, 0.05, 0, 0, 0.7, 0, 0.2, 3, 20])}
        reported["error_along"] = reported["error_across"] = np.array([NORMAL])
        return {
            "format": "polemcl detection model 1", "fitted_on": "nothing", "sensor": "hdl32e", "height_m": 1,
            "max_range_m": 40, "points_per_scan": 5000, "behind_houses": 0, "error_exponent": 1.0,
            "detected_range_m": [5, 35], "reported_range_m": [20], "levels": fit.LEVELS, "reach_m": fit.REACH,
            "clutter_per_m": {"always": 0.03, "today": 0.02}, "clutter_lateral_m": np.full(11, 8.0),
            "passing_per_scan": 0.2, "passing_range_m": np.full(11, 15.0),
            "persistence": {name: {"always": zeros, "today": zeros} for name in ["poles", "clutter", *fit.REPORTED]},
            "classes": {kind: {**reported, **({} if kind == "passing" else {"detected": [0.8, 0.4]})}
                        for kind in fit.KINDS}}

    def drawn_drive(self, model, day):
        (self.folder / "model.json").write_text(self.fit.text_of(model))
        (self.folder / "street.ini").write_text(SETTINGS.format(model=self.folder / "model.json"))
        rawlog, table = self.folder / f"{day}.rawlog", self.folder / f"{day}.csv"
        program("simulate", "--quiet", "--config", self.folder / "street.ini", "--day", day, "--poles", rawlog)
        program("eval", "sightings", "--poles", rawlog, "--output", table)
        return self.fit.Drive(table)

    def table(self, rows, scans=20, **head):
        """A drive of rows (kind, object, x, scan, range, hidden, found)."""
        lines = [f"# {key} {value}" for key, value in {**HEAD, **head}.items()]
        lines += ["# points_per_scan " + " ".join(["5000"] * scans),
                  "kind,object,x,y,aside_m,scan,range_m,hidden," + ",".join(self.fit.REPORTED)]
        for kind, number, x, scan, range_m, hidden, found in rows:
            cells = [kind, number, x, 0, 8, scan, range_m, hidden, *(FOUND if found else [""] * len(FOUND))]
            lines.append(",".join(map(str, cells)))
        file = self.folder / "table.csv"
        file.write_text("\n".join(lines) + "\n")
        return self.fit.Drive(file)

    def test_finds_the_model_that_the_detections_are_drawn_from(self):
        truth = self.plain_model()
        truth["persistence"]["poles"] = {"always": [0, 0, 0.3, 0, 0.2], "today": [0, 0.2, 0, 0, 0]}
        truth["persistence"]["error_along"]["always"] = [0, 0, 0, 0, 0.5]
        model = self.fit.fit([self.drawn_drive(truth, day) for day in (0, 1)])
        self.assertEqual(model["sensor"], "hdl32e")
        self.assertEqual(model["points_per_scan"], 5000)
        self.assertRegex(model["fitted_on"], "^worlds 11; 4[0-9]{3} scans over 2[0-9]{3} m, two days each$")
        score = self.fit.ndtri
        expected = np.interp(model["detected_range_m"], [5, 35], score([0.8, 0.4]))
        for kind in ("sign", "tree"):
            np.testing.assert_allclose(score(model["classes"][kind]["detected"])[2:-2], expected[2:-2], atol=0.25)
        self.assertAlmostEqual(model["behind_houses"], 0, delta=0.01)
        tree = model["classes"]["tree"]
        np.testing.assert_allclose(tree["sigma_along_m"], 0.05, atol=1e-6)
        np.testing.assert_allclose(tree["error_across"][2][3:8], NORMAL[3:8], atol=0.15)
        shares = {name: {when: sum(part) for when, part in both.items()}
                  for name, both in model["persistence"].items()}
        self.assertAlmostEqual(shares["poles"]["always"], 0.5, delta=0.12)
        self.assertAlmostEqual(shares["poles"]["today"], 0.2, delta=0.12)
        self.assertAlmostEqual(shares["error_along"]["always"], 0.5, delta=0.08)
        self.assertAlmostEqual(shares["error_across"]["always"], 0, delta=0.05)
        self.assertAlmostEqual(model["clutter_per_m"]["always"], 0.03, delta=0.012)
        self.assertAlmostEqual(model["clutter_per_m"]["today"], 0.02, delta=0.012)
        self.assertAlmostEqual(model["passing_per_scan"], 0.2, delta=0.04)
        self.assertAlmostEqual(model["clutter_lateral_m"][5], 8, delta=0.5)
        self.assertAlmostEqual(model["passing_range_m"][5], 15, delta=0.3)
        self.drawn_drive(model, 2)  # it can be read

    def test_clutter_of_both_days_is_one_object(self):
        first = self.table([("clutter", number, 10 * number, scan, 9, 0, 1) for number in (0, 1) for scan in range(4)])
        second = self.table([("clutter", 0, 10.4, 1, 9, 0, 1), ("clutter", 1, 30, 1, 9, 0, 1)], day=1)
        street = self.fit.Street(first, second)
        self.assertEqual(street.on_both, 1)
        [pairs] = street.pairs(0, same_day=False)
        np.testing.assert_array_equal(pairs, [[5], [0]])
        both_days = list(street.pairs(2, same_day=True))
        np.testing.assert_array_equal(both_days[0], [[4, 5, 0, 1], [6, 7, 2, 3]])
        self.assertEqual(both_days[1].size, 0)

    def test_sums_up_a_drive(self):
        found = [1] * 2 + [0] * 10 + [1] * 4 + [0] * 4
        rows = [("lamp_post", 7, 0, scan, 12, 0, seen) for scan, seen in enumerate(found)]
        rows += [("sign", 8, 5, scan, 12, 0, scan < 6) for scan in range(10) if scan != 3]  # no whole run
        rows += [("tree", 9, 5, scan, 12, 1, 0) for scan in range(20)]
        rows += [("clutter", 0, 20, scan, 22, 0, scan < 3) for scan in range(20)] + [("passing", 0, 30, 4, 9, 0, 1)]
        figures = self.fit.summary(self.table(rows))
        self.assertEqual((figures["scans"], figures["detections"], figures["per_scan"]), (20, 15, 0.75))
        self.assertEqual((figures["false_per_scan"], figures["lasting_false_per_scan"]), (0.2, 0.15))
        self.assertEqual(figures["range_edges_m"], [0, 5, 10, 15, 20, 25, 30, 35, 40])
        self.assertEqual(figures["recall"], [None, None, 11 / 29, None, None, None, None, None])
        self.assertEqual((figures["found_run_m"], figures["missed_run_m"]), (2, 5))
        self.assertAlmostEqual(figures["centre_median_m"], 0.05)
        self.assertAlmostEqual(figures["nees_mean"], 1)
        self.assertEqual(figures["confidence"], 0.75)

    def test_refuses_drives_that_do_not_belong_together(self):
        rows = [("tree", 9, 5, scan, 12, 0, 0) for scan in range(20)]

        def refusal(*heads):
            with self.assertRaises(SystemExit) as raised:
                self.fit.fit([self.table(rows, **head) for head in heads])
            return str(raised.exception)

        self.assertIn("one day", refusal({}, {}))
        self.assertIn("two streets", refusal({}, {"seed": 4, "day": 1}))
        self.assertIn("3 tables", refusal({}, {"day": 1}, {}))
        for key in "spacing_m", "height_m", "sensor":
            self.assertIn("differ in " + key, refusal({}, {"day": 1, key: 2}))
        self.assertIn("max_range_m is below", refusal({"max_range_m": 1.5}, {"max_range_m": 1.5, "day": 1}))
        self.assertIn("hardly any pole", refusal({}, {"day": 1}))

    def test_of_many_equal_values_the_middle_score_is_meant(self):
        quantiles = np.array([0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 4.0])
        levels = self.fit.ndtri(self.fit.LEVELS)
        expected = [levels[0], (levels[4] + levels[6]) / 2, (levels[9] + levels[10]) / 2, levels[10]]
        np.testing.assert_allclose(self.fit.scores_of(quantiles, np.array([-1, 1, 3, 9.0])), expected)

    def test_noise_correlates_as_the_sampler_draws_it(self):
        # The same numbers as in tests/sim/detections/test_PersistentNoise.cpp, which counts what is drawn.
        always, today = [0.1, 0, 0.2, 0, 0.1], [0, 0.2, 0, 0.1, 0.1]
        for distance, same_day, other_day in (
                (0, 0.8, 0.4), (0.7, 0.76751, 0.375181), (3, 0.577639, 0.278822), (12, 0.307175, 0.131912)):
            parts = [self.fit.noise_correlation(reach, distance) for reach in self.fit.REACH]
            self.assertAlmostEqual(np.dot(np.add(always, today), parts), same_day, places=6)
            self.assertAlmostEqual(np.dot(always, parts), other_day, places=6)

    def test_spectrum_of_correlations_that_one_made(self):
        always, today = [0, 0, 0.3, 0, 0.2], [0, 0.2, 0, 0, 0]
        correlations = []
        for distance, same_day in itertools.product([0.5, 1, 2, 4, 8, 16, 32], [True, False]):
            parts = [self.fit.noise_correlation(reach, distance) for reach in self.fit.REACH]
            correlations.append((distance, same_day, np.dot(np.add(always, np.multiply(today, same_day)), parts)))
        spectrum = self.fit.fit_spectrum(correlations)
        np.testing.assert_allclose(spectrum["always"], always, atol=1e-6)
        np.testing.assert_allclose(spectrum["today"], today, atol=1e-6)
        self.assertEqual(sum(self.fit.fit_spectrum([])["always"]), 0)
        more = self.fit.fit_spectrum([(distance, True, 1.2) for distance in (0.5, 1, 2)])
        self.assertAlmostEqual(sum(more["always"]) + sum(more["today"]), 1)

    def test_correlation_of_hits(self):
        for correlation in (-0.8, 0.0, 0.5, 0.95):
            quadrant = self.fit.bivariate_cdf(np.zeros(1), np.zeros(1), correlation)
            self.assertAlmostEqual(quadrant[0], 0.25 + np.arcsin(correlation) / (2 * np.pi), places=7)
        from scipy.stats import multivariate_normal
        share = multivariate_normal(cov=[[1, 0.6], [0.6, 1]]).cdf([0.7, -0.2])
        both = np.arange(100000) < 100000 * share
        thresholds = np.full(len(both), 0.7), np.full(len(both), -0.2)
        self.assertAlmostEqual(self.fit.hit_correlation(*thresholds, both), 0.6, places=3)


if __name__ == "__main__":
    unittest.main()
