"""PoleExtractor: the same poles as pole-extract; arrays of any layout; settings."""

import gc
import threading
import unittest

import numpy as np
import polemcl
import street


def rows_of(index, time, poles):
    """Rows as pole-extract writes them."""
    for pole in poles:
        fixed = [f"{pole[name]:.6f}" for name in
                 ("x", "y", "radius", "bottom", "top", "confidence")]
        covariance = [f"{pole[name]:.9g}" for name in ("cov_xx", "cov_xy", "cov_yy")]
        yield ",".join([str(index), f"{time:.6f}", *fixed, str(pole["points"]), *covariance])


def all_poles(extractor):
    return [extractor.extract(points) for points in street.points()]


class PolesOfScans(unittest.TestCase):
    def setUp(self):
        self.extractor = polemcl.PoleExtractor(street.CONFIG)

    def test_are_those_of_pole_extract(self):
        times = np.loadtxt(street.scans_folder() / "times.txt")
        rows = []
        for index, poles in enumerate(all_poles(self.extractor)):
            rows += rows_of(index, times[index], poles)
        self.assertEqual(rows, street.pole_table().read_text().splitlines()[1:])
        self.assertGreater(len(rows), 100)

    def test_have_the_documented_type(self):
        poles = self.extractor.extract(street.points()[0])
        self.assertEqual(poles.dtype, polemcl.detection_type)
        self.assertEqual(poles.ndim, 1)
        self.assertTrue(poles.flags.owndata and poles.flags.writeable)

    def test_survive_the_extractor_and_later_scans(self):
        poles = self.extractor.extract(street.points()[0])
        before = poles.copy()
        self.extractor.extract(street.points()[20])
        del self.extractor
        gc.collect()
        np.testing.assert_array_equal(poles, before)

    def test_do_not_depend_on_the_layout_of_the_points(self):
        points = street.points()[0]
        expected = self.extractor.extract(points)
        wide = np.zeros((2 * len(points), 9), np.float32)
        wide[::2, 1:9:2] = points
        layouts = {
            "strided": wide[::2, 1:9:2],
            "Fortran": np.asfortranarray(points),
            "reversed": points[::-1][::-1],
            "three columns": points[:, :3],
            "big endian": points.astype(">f4"),
        }
        for name, layout in layouts.items():
            with self.subTest(name):
                np.testing.assert_array_equal(self.extractor.extract(layout), expected)

    def test_are_none_without_points(self):
        self.assertEqual(len(self.extractor.extract(np.zeros((0, 3), np.float32))), 0)

    def test_stand_in_the_frame_of_the_robot(self):
        points = street.points()[0]
        at_origin = self.extractor.extract(points)
        turned = polemcl.PoleExtractor(street.CONFIG, sensor_pose=(1, 2, 0, np.pi / 2, 0, 0))
        poles = turned.extract(points)
        np.testing.assert_allclose(poles["x"], 1 - at_origin["y"])
        np.testing.assert_allclose(poles["y"], 2 + at_origin["x"])
        np.testing.assert_allclose(poles["cov_xx"], at_origin["cov_yy"])

    def test_are_the_same_in_two_threads(self):
        expected = all_poles(self.extractor)
        found = {}

        def work(name, extractor):
            found[name] = all_poles(extractor)

        shared = polemcl.PoleExtractor(street.CONFIG)
        threads = [threading.Thread(target=work, args=(name, extractor)) for name, extractor in
                   [("own", polemcl.PoleExtractor(street.CONFIG)), ("a", shared), ("b", shared)]]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for name in ("own", "a", "b"):
            for poles, other in zip(found[name], expected, strict=True):
                np.testing.assert_array_equal(poles, other)

    def test_are_found_while_other_threads_run(self):
        points = street.points()[0]
        self.assertTrue(street.lets_others_run(lambda: self.extractor.extract(points)))

    def test_are_counted(self):
        points = street.points()[0].copy()
        points[:10, 0] = np.nan
        self.extractor.extract(points)
        report = self.extractor.report
        self.assertEqual(report["points"], len(points))
        self.assertEqual(report["invalid"], 10)
        self.assertGreater(report["candidates"], sum(report["rejected"].values()))


class WrongPoints(unittest.TestCase):
    def assert_refused(self, points, given):
        extractor = polemcl.PoleExtractor(street.CONFIG)
        with self.assertRaises(polemcl.Error) as caught:
            extractor.extract(points)
        self.assertIn("points: ", str(caught.exception))
        self.assertIn(given, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))

    def test_are_refused(self):
        self.assert_refused(np.zeros((5, 3)), "(5, 3) of float64")
        self.assert_refused(np.zeros((5, 3), np.int32), "(5, 3) of int32")
        self.assert_refused(np.zeros((5, 2), np.float32), "(5, 2) of float32")
        self.assert_refused(np.zeros((5, 5), np.float32), "(5, 5) of float32")
        self.assert_refused(np.zeros(6, np.float32), "(6,) of float32")
        self.assert_refused(None, "not NoneType")
        self.assert_refused([[1, 2, 3]], "(1, 3) of int64")
        self.assert_refused([[1], [2, 3]], "not list")

    def test_of_another_lidar_are_refused_with_the_message_of_the_programs(self):
        extractor = polemcl.PoleExtractor(street.CONFIG, {"sensor.model": "vlp16"})
        with self.assertRaisesRegex(polemcl.Error, "vlp16"):
            extractor.extract(street.points()[0])


class SettingsOfPython(unittest.TestCase):
    def test_are_those_of_the_file_unless_given(self):
        points = street.points()[0]
        few = polemcl.PoleExtractor(street.CONFIG, {"scan_line.max_range_m": 15}).extract(points)
        many = polemcl.PoleExtractor(street.CONFIG).extract(points)
        self.assertLess(len(few), len(many))
        self.assertLess(np.hypot(few["x"], few["y"]).max(), 16)
        same = {"sensor.model": "hdl32e", "sensor.height_m": 1.0, "sensor.min_range_m": 1.0,
                "sensor.max_range_m": 60}
        np.testing.assert_array_equal(polemcl.PoleExtractor(settings=same).extract(points), many)

    def test_may_be_flags_and_lists(self):
        table = {"sensor.model": "table", "sensor.elevations_deg": np.linspace(10, -30, 32).tolist(),
                 "sensor.columns": 2000, "sensor.check_beams": False, "sensor.height_m": 1}
        polemcl.PoleExtractor(settings=table).extract(street.points()[0])

    def test_that_are_wrong_are_named(self):
        wrong = {
            r"\[sensor\] modell = x: key is not known": {"sensor.modell": "x"},
            r"\[sensor\] height_m = tall": {"sensor.height_m": "tall"},
            r"\[sensor\] check_beams = 1": {"sensor.check_beams": 1},
            r"'height=1' is not an assignment": {"height": 1},
        }
        for message, settings in wrong.items():
            with self.subTest(message), self.assertRaisesRegex(polemcl.Error, message):
                polemcl.PoleExtractor(settings=settings)
        with self.assertRaisesRegex(polemcl.Error, "missing.ini"):
            polemcl.PoleExtractor("missing.ini")


if __name__ == "__main__":
    unittest.main()
