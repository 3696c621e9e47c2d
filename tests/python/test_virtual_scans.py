"""Virtual scans of a cloud: share/experiments/virtual_scans.py."""
import importlib.util
import pathlib
import struct
import tempfile
import unittest

import numpy as np

SCRIPT = pathlib.Path(__file__).parents[2] / "share" / "experiments" / "virtual_scans.py"
spec = importlib.util.spec_from_file_location("virtual_scans", SCRIPT)
virtual_scans = importlib.util.module_from_spec(spec)
spec.loader.exec_module(virtual_scans)


def pcd_file(folder: str, points: np.ndarray, kind: str) -> pathlib.Path:
    """A PCD file with the fields intensity, x, y, z."""
    if kind == "binary_compressed":
        plain = points.T.astype(np.float32).tobytes()  # LZF: pieces of up to 32 bytes as they are
        pieces = [plain[i : i + 32] for i in range(0, len(plain), 32)]
        packed = b"".join(bytes([len(piece) - 1]) + piece for piece in pieces)
        body = struct.pack("<II", len(packed), len(plain)) + packed
    elif kind == "binary":
        body = points.astype(np.float32).tobytes()
    else:
        body = "\n".join(" ".join(f"{value:g}" for value in row) for row in points).encode()
    head = f"""# .PCD v0.7
VERSION 0.7
FIELDS intensity x y z
SIZE 4 4 4 4
TYPE F F F F
COUNT 1 1 1 1
WIDTH {len(points)}
HEIGHT 1
POINTS {len(points)}
DATA {kind}
"""
    file = pathlib.Path(folder) / f"{kind}.pcd"
    file.write_bytes(head.encode() + body)
    return file


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

    def test_pcd_clouds_are_read(self) -> None:
        points = np.array([[7, 1, 2, 3], [8, 4, 5.5, 6], [9, np.nan, 0, 0], [7, -1, -2, -3.5]])
        for kind in ("ascii", "binary", "binary_compressed"):
            with self.subTest(kind), tempfile.TemporaryDirectory() as folder:
                read = virtual_scans.read_pcd(pcd_file(folder, points, kind))
                np.testing.assert_array_equal(read, points[[0, 1, 3], 1:])

    def test_a_level_lidar_keeps_place_and_yaw(self) -> None:
        c, s = np.cos(0.3), np.sin(0.3)
        yaw = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        pitch = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = yaw @ pitch, [1, 2, 3]
        level = virtual_scans.levelled(pose)
        np.testing.assert_allclose(level[:3, :3], yaw, atol=1e-12)
        np.testing.assert_array_equal(level[:3, 3], [1, 2, 3])


if __name__ == "__main__":
    unittest.main()
