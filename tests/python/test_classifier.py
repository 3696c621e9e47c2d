"""share/experiments/fit_classifier.py finds the weights that made up a table of features."""

import importlib.util
import pathlib
import tempfile
import unittest

import numpy as np

SOURCE = pathlib.Path(__file__).resolve().parents[2]
HAS_SKLEARN = importlib.util.find_spec("sklearn") is not None
TERMS = ["extent", "clutter", "tilt"]
SCALE_TERMS = ["covariance_tilt", "covariance_range"]


def script():
    specification = importlib.util.spec_from_file_location(
        "fit_classifier", SOURCE / "share/experiments/fit_classifier.py")
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def odds_of_rows(rows, terms):
    """The sum of the trees, as PoleClassifier.cpp makes it; terms by their names."""
    odds, at = 0, 0
    while at < len(rows):
        while rows[at][2] > 0:
            term, value, step = rows[at]
            at += 1 if terms[term] <= value else step
        odds += rows[at][1]
        at -= rows[at][2]
    return odds


@unittest.skipUnless(HAS_SKLEARN, "python3-sklearn is not installed")
class FitClassifier(unittest.TestCase):
    """Labels drawn with odds -0.5 + 2 extent - clutter + 0.8 extent * tilt; errors of the scale exp(-1 + tilt)."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.fit = script()

    def table(self, name, seed, rows=30000):
        random = np.random.default_rng(seed)
        terms, scale_terms = random.normal(size=(rows, 3)), random.uniform(size=(rows, 2))
        odds = -0.5 + 2 * terms[:, 0] - terms[:, 1] + 0.8 * terms[:, 0] * terms[:, 2]
        poles = random.uniform(size=rows) < 1 / (1 + np.exp(-odds))
        errors = np.exp(-1 + scale_terms[:, 0]) * random.chisquare(2, size=rows)
        lines = ["# sensor hdl32e", "# labels true_poles",
                 ",".join(["scan,x,y,pole,squared_error,odds", *TERMS, *SCALE_TERMS])]
        for i in range(rows):
            cells = [0, 1, 2, int(poles[i]), errors[i] if poles[i] else "", odds[i], *terms[i], *scale_terms[i]]
            lines.append(",".join(map(str, cells)))
        (self.folder / name).write_text("\n".join(lines) + "\n")
        return self.fit.Drive(self.folder / name)

    def test_finds_the_odds_that_drew_the_labels(self):
        drive = self.table("a.csv", 1)
        classifier = self.fit.Classifier([drive])
        test = self.table("b.csv", 2, 5000)
        self.assertLess(self.fit.score(test, classifier.odds(test))["log_loss"],
                        self.fit.score(test, test.built_in)["log_loss"] + 0.012)

    def test_odds_never_grow_with_clutter(self):
        classifier = self.fit.Classifier([self.table("a.csv", 1)])
        test = self.table("b.csv", 2, 1000)
        less = classifier.odds(test)
        test.terms[:, 1] += 0.5
        self.assertTrue((classifier.odds(test) <= less).all())
        self.assertLess(classifier.odds(test).mean(), less.mean() - 0.2)

    def test_finds_the_scale_of_the_errors(self):
        drive = self.table("a.csv", 3)
        classifier = self.fit.Classifier([drive], max_iter=20)
        self.fit.write_covariance(self.folder / "covariance.csv", [drive], classifier)
        rows = (self.folder / "covariance.csv").read_text().split("term,weight\n")[1].split()
        fitted = dict(row.split(",") for row in rows)
        self.assertEqual(list(fitted), ["one", "odds", "tilt", "range"])
        np.testing.assert_allclose([float(value) for value in fitted.values()], [-1, 0, 1, 0], atol=0.12)

    def test_tables_that_are_read_again_have_the_same_odds(self):
        drive = self.table("a.csv", 4, 2000)
        classifier = self.fit.Classifier([drive])
        classifier.write(self.folder)
        for name, trees in ("trees.csv", classifier.trees), ("rough_trees.csv", classifier.rough):
            lines = (self.folder / name).read_text().splitlines()
            rows = [line.split(",") for line in lines[lines.index("term,value,step") + 1 :]]
            rows = [(term, float(value), int(step)) for term, value, step in rows]
            odds = [odds_of_rows(rows, dict(zip(TERMS, terms))) for terms in drive.terms[:300]]
            np.testing.assert_allclose(odds, trees.odds(drive)[:300], atol=1e-6)
        self.assertNotIn("clutter", {row[0] for row in rows})  # it is not known before the fit

    def test_sensors_weigh_alike(self):
        drives = [self.table("a.csv", 5, 300), self.table("b.csv", 6, 100), self.table("c.csv", 7, 200)]
        drives[2].sensor = "vlp16"
        weights = self.fit.sample_weights(drives)
        np.testing.assert_allclose(weights[:400], 0.75)
        np.testing.assert_allclose(weights[400:], 1.5)
        drives[1].real = True
        np.testing.assert_allclose(self.fit.sample_weights(drives)[300:400], 0.75 * self.fit.REAL_WEIGHT)

    def test_refuses_tables_without_known_errors(self):
        drive = self.table("a.csv", 8, 500)
        drive.errors[:] = np.nan
        classifier = self.fit.Classifier([drive], max_iter=5)
        with self.assertRaisesRegex(SystemExit, "no pole has a known error"):
            self.fit.write_covariance(self.folder / "covariance.csv", [drive], classifier)
        self.assertFalse((self.folder / "covariance.csv").exists())


if __name__ == "__main__":
    unittest.main()
