"""share/examples/python/drive.py: the poses of another day on the map of the first."""

import os
import pathlib
import subprocess
import sys
import unittest

import numpy as np
import street

EXAMPLE = pathlib.Path(__file__).parents[2] / "share" / "examples" / "python" / "drive.py"


def run(*arguments):
    return subprocess.run([sys.executable, EXAMPLE, *map(str, arguments)], capture_output=True,
                          text=True, check=False)


class Drive(unittest.TestCase):
    def test_is_localized_on_the_map_of_another_day(self):
        later = street.simulated("later", "--set", "world.day=1")
        truth = np.loadtxt(later / "poses.txt")
        for config in ([], [street.CONFIG]):
            done = run(street.scans_folder(), later, street.temporary_folder() / "example.polemap",
                       *config)
            self.assertEqual(done.returncode, 0, done.stderr)
            rows = [line.split() for line in done.stdout.splitlines()]
            self.assertEqual(len(rows), len(truth))
            estimates = np.array([row[1:3] for row in rows], float)
            errors = np.hypot(*(estimates - truth[:, [3, 7]]).T)
            self.assertLess(errors[-10:].max(), 0.15)
            self.assertEqual(rows[-1][4], "ok")

    def test_says_what_is_wrong(self):
        self.assertIn("usage:", run().stderr)
        done = run(street.scans_folder(), street.scans_folder(), os.devnull)
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, "^drive.py: .*/dev/null: unknown kind of map")


if __name__ == "__main__":
    unittest.main()
