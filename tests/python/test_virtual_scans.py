"""Virtual scans of a cloud: share/experiments/virtual_scans.py."""
import importlib.util
import pathlib
import unittest

import numpy as np

SCRIPT = pathlib.Path(__file__).parents[2] / "share" / "experiments" / "virtual_scans.py"
spec = importlib.util.spec_from_file_location("virtual_scans", SCRIPT)
virtual_scans = importlib.util.module_from_spec(spec)
spec.loader.exec_module(virtual_scans)


class VirtualScans(unittest.TestCase):
    def test_the_nearer_point_hides_the_farther(self) -> None:
        cloud = np.array([[5.0, 0, 0], [10.0, 0, 0], [12.0, 12.0, 0]], np.float32)
        seen = virtual_scans.view(cloud, np.eye(4))
        np.testing.assert_allclose(sorted(np.hypot(seen[:, 0], seen[:, 1])), [5, 16.9706], atol=1e-4)

    def test_points_are_seen_from_the_pose(self) -> None:
        pose = np.array([[0.0, -1, 0, 100], [1, 0, 0, 50], [0, 0, 1, 2], [0, 0, 0, 1]])
        seen = virtual_scans.view(np.array([[100.0, 57, 2]], np.float32), pose)
        np.testing.assert_allclose(seen[0, :2], [7, 0], atol=1e-4)

    def test_a_turn_is_corrected_for_motion(self) -> None:
        motion = np.eye(4)
        motion[0, 3] = 4  # forward during a turn; a point on the left is measured a quarter of a turn before
        np.testing.assert_allclose(virtual_scans.corrected(np.array([[0.0, 10, 1]]), motion), [[-1, 10, 1]])


if __name__ == "__main__":
    unittest.main()
