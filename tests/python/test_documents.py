"""The code of share/doc/python.md runs and reads what the programs wrote."""

import contextlib
import io
import os
import pathlib
import re
import unittest

import numpy as np
import polemcl
import street

PAGE = pathlib.Path(__file__).parents[2] / "share" / "doc" / "python.md"


def blocks():
    """The code of the page: text, one for each block."""
    return re.findall(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.M | re.S)


def folder_of_results():
    """A folder with the files that the page names."""
    folder = street.temporary_folder() / "page"
    if folder.exists():
        return folder
    folder.mkdir()
    for name, source in {"street.polemap": street.map_file(), "map.polemap": street.map_file(),
                         "poles.csv": street.pole_table(),
                         "out": street.localized(),
                         "odometry.txt": street.scans_folder() / "odometry.txt",
                         "velodyne": street.scans_folder() / "velodyne"}.items():
        (folder / name).symlink_to(source)
    street.program("map", "convert", "--quiet", street.map_file(),
                   "--output", folder / "street.csv")
    return folder


def run(code, **given):
    """The names that the code leaves, and what it prints. given: names that it finds."""
    names, printed, before = dict(given), io.StringIO(), os.getcwd()
    os.chdir(folder_of_results())
    try:
        with contextlib.redirect_stdout(printed):
            exec(compile(code, str(PAGE), "exec"), names)  # pylint: disable=exec-used
    finally:
        os.chdir(before)
    return names, printed.getvalue()


class Readme(unittest.TestCase):
    def test_localizes(self):
        text = (PAGE.parents[2] / "README.md").read_text(encoding="utf-8")
        (code,) = re.findall(r"^```python\n(.*?)^```", text, re.M | re.S)
        folder = folder_of_results()
        motions = np.loadtxt(folder / "odometry.txt")
        drive = []
        scans = len(list((folder / "velodyne").glob("*.bin")))
        for i in range(scans):
            points = np.fromfile(folder / f"velodyne/{i:06}.bin", np.float32).reshape(-1, 4)
            motion, sigmas = (motions[i - 1, :3], motions[i - 1, 3:]) if i else (None, np.zeros(3))
            drive.append((0.1 * i, points, motion, np.diag(sigmas**2)))
        names, _ = run(code, drive=drive, pose=street.true_poses()[0])
        last = names["updates"][-1]
        self.assertIsNotNone(last.estimate)
        self.assertLess(np.hypot(*(last.estimate.mean - street.true_poses()[scans - 1])[:2]), 0.2)


class Page(unittest.TestCase):
    def block(self, text):
        found = [code for code in blocks() if text in code]
        self.assertEqual(len(found), 1, text)
        return run(found[0])

    def test_has_no_code_that_is_not_tested_here(self):
        self.assertEqual(len(blocks()), 6)

    def test_localizes(self):
        names, printed = self.block("polemcl.Localizer(")
        self.assertEqual(len(printed.splitlines()), 5)
        error = names["update"].estimate.mean - street.true_poses()[4]
        self.assertLess(np.hypot(*error[:2]), 0.2)

    def test_reads_trajectories_and_health(self):
        names, _ = self.block("run_00.tum")
        expected = np.genfromtxt(street.localized() / "run_00_cov.csv", delimiter=",", names=True)
        np.testing.assert_allclose(names["x"], expected["x_m"], atol=1e-6)
        np.testing.assert_allclose(np.cos(names["yaw"]), np.cos(expected["yaw_rad"]), atol=1e-6)
        np.testing.assert_allclose(np.sin(names["yaw"]), np.sin(expected["yaw_rad"]), atol=1e-6)
        self.assertTrue(names["ok"][-1])
        self.assertFalse(names["ok"][0])

    def test_reads_errors_and_the_summary(self):
        errors, _ = self.block("run_00_errors.csv")
        summary, _ = self.block("summary.json")
        self.assertAlmostEqual(errors["mean"], summary["summary"]["pos_mean"], places=6)
        self.assertAlmostEqual(errors["heading"], summary["summary"]["ang_mean_deg"], places=5)
        self.assertEqual(summary["per_run"], [summary["summary"]["pos_mean"]])

    def test_reads_maps(self):
        names, _ = self.block("street.csv")
        poles = polemcl.PoleMap.load(street.map_file()).poles
        np.testing.assert_allclose(names["positions"][:, 0], poles["x"], atol=1e-6)
        np.testing.assert_allclose(names["positions"][:, 1], poles["y"], atol=1e-6)
        variance = (poles["cov_xx"] + poles["cov_yy"]) / 2
        np.testing.assert_allclose(names["sigma"] ** 2, variance, rtol=1e-6)
        self.assertEqual(len(names["tall"]), np.sum(poles["top"] > 3))

    def test_reads_poles_of_scans(self):
        names, _ = self.block("poles.csv")
        self.assertEqual(len(names["counts"]), len(street.points()))
        self.assertEqual(sum(names["counts"]), len(street.pole_table().read_text().splitlines()) - 1)


if __name__ == "__main__":
    unittest.main()
