"""PoleMap, PoleMapBuilder, PoleLikelihood: the maps of pole-map, searches and likelihoods by hand."""

import gc
import os
import subprocess
import sys
import unittest

import numpy as np
import polemcl
import street


def made_poles(places, **fields):
    poles = np.zeros(len(places), polemcl.map_pole_type)
    poles["x"], poles["y"] = np.transpose(places)
    poles["radius"], poles["top"], poles["confidence"] = 0.1, 4, 1
    poles["cov_xx"] = poles["cov_yy"] = 0.01
    poles["count"] = 3
    for name, value in fields.items():
        poles[name] = value
    return poles


def made_detections(places, confidence=1.0):
    poles = np.zeros(len(places), polemcl.detection_type)
    poles["x"], poles["y"] = np.transpose(places)
    poles["radius"], poles["top"], poles["confidence"] = 0.1, 4, confidence
    poles["cov_xx"] = poles["cov_yy"] = 0.01
    return poles


class MapFiles(unittest.TestCase):
    def test_keep_poles_and_facts(self):
        poles = made_poles([(1, 2), (3, 4.5)], cov_xy=0.001, count=[2, 7])
        made = polemcl.PoleMap(poles, {"town": "Łódź"})
        file = street.temporary_folder() / "made.polemap"
        made.save(file)
        loaded = polemcl.PoleMap.load(str(file))
        np.testing.assert_array_equal(loaded.poles, poles)
        self.assertEqual(loaded.info, {"town": "Łódź"})
        self.assertEqual(len(loaded), 2)

    def test_keep_all_that_another_program_wrote(self):
        copy = street.temporary_folder() / "copy.polemap"
        polemcl.PoleMap.load(street.map_file()).save(copy)
        self.assertEqual(copy.read_bytes(), street.map_file().read_bytes())

    def test_are_those_of_pole_map_convert(self):
        loaded = polemcl.PoleMap.load(street.map_file())
        ours, theirs = (street.temporary_folder() / name for name in ("ours.csv", "theirs.csv"))
        loaded.save(ours)
        street.program("map", "convert", "--quiet", street.map_file(), "--output", theirs)
        self.assertEqual(ours.read_bytes(), theirs.read_bytes())
        self.assertEqual(len(polemcl.PoleMap.load(ours)), len(loaded))

    def test_go_to_numpy_and_back(self):
        poles = made_poles([(1, 2), (3, 4.5)], radius=[0.1, 0.25])
        file = street.temporary_folder() / "made.npz"
        polemcl.PoleMap(poles).save(file)
        with np.load(file) as arrays:
            np.testing.assert_array_equal(arrays["polemeans"], [(1, 2, 0.1), (3, 4.5, 0.25)])
        loaded = polemcl.PoleMap.load(file).poles
        for name in ("x", "y", "radius"):
            np.testing.assert_array_equal(loaded[name], poles[name])

    def test_that_are_wrong_are_named(self):
        for name in ("missing.polemap", "map.txt"):
            with self.subTest(name), self.assertRaisesRegex(polemcl.Error, name):
                polemcl.PoleMap.load(name)
        with self.assertRaisesRegex(polemcl.Error, "nowhere"):
            polemcl.PoleMap(made_poles([(1, 2)])).save("/nowhere/map.polemap")


class MapPoles(unittest.TestCase):
    def test_are_copies(self):
        given = made_poles([(1, 2)])
        made = polemcl.PoleMap(given)
        given["x"] = 99
        made.poles["y"] = 99
        poles = made.poles
        del made
        gc.collect()
        np.testing.assert_array_equal(poles, made_poles([(1, 2)]))

    def test_may_have_any_order_of_fields_and_strides(self):
        poles = made_poles([(1, 2), (3, 4), (5, 6)], count=[1, 2, 3])
        other = np.zeros(6, [("note", "U3"), ("count", "i2")] +
                         [(name, ">f8") for name in reversed(poles.dtype.names[:-1])])
        for name in poles.dtype.names:
            other[name][::2] = poles[name]
        np.testing.assert_array_equal(polemcl.PoleMap(other[::2]).poles, poles)

    def test_that_are_wrong_are_refused(self):
        good = made_poles([(1, 2)])
        wrong = {
            r"\(2,\) of float64": np.zeros(2),
            r"\(1, 1\) of ": good.reshape(1, 1),
            "'count' is missing": good[list(good.dtype.names[:-1])],
            r"poles\['count'\].*-1": made_poles([(1, 2)], count=-1),
            "not finite": made_poles([(np.nan, 2)]),
        }
        for message, poles in wrong.items():
            with self.subTest(message), self.assertRaisesRegex(polemcl.Error, message):
                polemcl.PoleMap(poles)

    def test_that_are_nearest_are_found(self):
        made = polemcl.PoleMap(made_poles([(0, 0), (10, 0)]))
        indices, distances = made.nearest([(1, 0), (9, 1), (5, 40)], radius=2)
        np.testing.assert_array_equal(indices, [0, 1, -1])
        np.testing.assert_allclose(distances, [1, np.sqrt(2), np.inf])
        self.assertEqual(made.nearest([(5, 40)])[0][0], 0)
        for radius in (0, -1, np.nan):
            with self.assertRaisesRegex(polemcl.Error, "radius"):
                made.nearest([(0, 0)], radius)
        with self.assertRaisesRegex(polemcl.Error, r"places: \(n, 2\).*\(2,\)"):
            made.nearest((0, 0))


# A thread that nobody waits for is inside the library when Python ends.
ENDS_MEANWHILE = """
import threading, time
import numpy, polemcl
poles = numpy.zeros(1000, polemcl.map_pole_type)
poles["x"], poles["confidence"], poles["cov_xx"], poles["cov_yy"] = range(1000), 1, 1, 1
street, places = polemcl.PoleMap(poles), numpy.zeros((20000, 2))
builder, seen = polemcl.PoleMapBuilder(), numpy.zeros(1000, polemcl.detection_type)
def ask():
    while True:
        street.nearest(places)
def fail():
    while True:
        try:
            builder.add((numpy.nan, 0, 0), seen)
        except polemcl.Error:
            pass
for work in ask, fail:
    threading.Thread(target=work, daemon=True).start()
time.sleep(0.3)
"""


class MadeMaps(unittest.TestCase):
    def test_refuse_what_no_file_may_hold(self):
        for name, value in (("radius", np.nan), ("confidence", 5), ("cov_xx", -1)):
            with self.assertRaisesRegex(polemcl.Error, r"^pole 1 \(counted from 0\): "):
                polemcl.PoleMap(made_poles([(1, 2), (3, 4)], **{name: [0, value]}))


class Processes(unittest.TestCase):
    def test_end_while_a_thread_is_busy(self):
        paths = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
        for _ in range(5):
            ended = subprocess.run([sys.executable, "-c", ENDS_MEANWHILE], env=paths, timeout=60,
                                   capture_output=True, text=True, check=False)
            self.assertEqual((ended.returncode, ended.stderr), (0, ""))


class BuiltMaps(unittest.TestCase):
    def test_are_those_of_pole_map_build(self):
        extractor = polemcl.PoleExtractor(street.CONFIG)
        builder = polemcl.PoleMapBuilder(street.CONFIG)
        for pose, points in zip(street.true_poses(), street.points(), strict=True):
            builder.add(pose, extractor.extract(points))
        poles, expected = builder.build().poles, polemcl.PoleMap.load(street.map_file()).poles
        self.assertGreater(len(expected), 3)
        for name in polemcl.map_pole_type.names:
            # The programs turn the quaternion of the truth into a heading in another way.
            np.testing.assert_allclose(poles[name], expected[name], rtol=1e-9, atol=1e-12)

    def test_correct_poles_measured_on_the_way(self):
        late = made_detections([(10, 3)])
        late["time_offset"] = 0.05
        builder = polemcl.PoleMapBuilder(settings={"map.min_count": 1})
        for i in range(4):
            builder.add((2.0 * i, 0, 0), moved(late, -2.0 * i), velocity=(20, 0, 0))
        self.assertAlmostEqual(builder.build().poles["x"][0], 11, places=6)

    def test_are_built_while_other_threads_run(self):
        builder = polemcl.PoleMapBuilder()
        seen = made_detections([(x, 5) for x in range(20)])
        for i in range(100):
            builder.add((i, 0, 0), moved(seen, -i))
        self.assertTrue(street.lets_others_run(builder.build))

    def test_need_poses_and_detections(self):
        builder = polemcl.PoleMapBuilder()
        self.assertEqual(len(builder.build()), 0)
        with self.assertRaisesRegex(polemcl.Error, r"pose: \(3,\)"):
            builder.add((1, 2), made_detections([(1, 2)]))
        with self.assertRaisesRegex(polemcl.Error, "'points' is missing"):
            builder.add((1, 2, 3), made_poles([(1, 2)]))

    def test_refuse_a_bad_scan_and_go_on(self):
        builder = polemcl.PoleMapBuilder(settings={"map.min_count": 1})
        seen = made_detections([(10, 5)])
        for i in range(4):
            builder.add((i, 0, 0), moved(seen, -i))
        with self.assertRaisesRegex(polemcl.Error, "the pose of scan 4 is not finite"):
            builder.add((np.nan, 0, 0), seen)
        seen["x"] = np.nan
        with self.assertRaisesRegex(polemcl.Error, "pole 0 of scan 4 has"):
            builder.add((4, 0, 0), seen)
        self.assertEqual(len(builder.build()), 1)


def moved(poles, x):
    result = poles.copy()
    result["x"] += x
    return result


class Likelihoods(unittest.TestCase):
    def test_are_those_of_the_formula(self):
        made = polemcl.PoleMap(made_poles([(5, 0), (0, 5)]))
        settings = {"likelihood.model": "paper", "likelihood.weighted": False,
                    "likelihood.sigma_m": 0.2, "likelihood.gate_m": 1}
        likelihood = polemcl.PoleLikelihood(made, settings=settings)
        seen = made_detections([(5, 0), (0, 5)])
        values = likelihood.log_likelihoods(seen, [(0, 0, 0), (0.3, 0, 0), (0, 0, np.pi)])
        np.testing.assert_allclose(values, [0, -2 * 0.3**2 / (2 * 0.2**2), -2 / (2 * 0.2**2)],
                                   atol=1e-12)

    def test_of_many_poses_are_those_of_each(self):
        made = polemcl.PoleMap.load(street.map_file())
        likelihood = polemcl.PoleLikelihood(made, street.CONFIG)
        seen = polemcl.PoleExtractor(street.CONFIG).extract(street.points()[5])
        poses = street.true_poses()[5] + np.random.default_rng(1).normal(0, 0.1, (100, 3))
        values = likelihood.log_likelihoods(seen, poses)
        self.assertEqual(values.shape, (100,))
        single = [likelihood.log_likelihoods(seen, pose[None])[0] for pose in poses]
        np.testing.assert_array_equal(values, single)
        strided = np.zeros((200, 6))
        strided[::2, ::2] = poses
        np.testing.assert_array_equal(likelihood.log_likelihoods(seen, strided[::2, ::2]), values)

    def test_are_computed_while_other_threads_run(self):
        likelihood = polemcl.PoleLikelihood(polemcl.PoleMap(made_poles([(5, 0), (0, 5)])))
        seen, poses = street.no_poles(), np.zeros((100000, 3))
        self.assertTrue(street.lets_others_run(lambda: likelihood.log_likelihoods(seen, poses)))

    def test_refuse_other_shapes(self):
        likelihood = polemcl.PoleLikelihood(polemcl.PoleMap(made_poles([(5, 0)])))
        seen = made_detections([(5, 0)])
        for poses in (np.zeros(3), np.zeros((2, 2)), [["a", "b", "c"]], None):
            with self.subTest(poses), self.assertRaisesRegex(polemcl.Error, "^poses: "):
                likelihood.log_likelihoods(seen, poses)
        with self.assertRaisesRegex(polemcl.Error, "confidence"):
            likelihood.log_likelihoods(made_detections([(5, 0)], confidence=2), [(0, 0, 0)])
        with self.assertRaises(TypeError):
            polemcl.PoleLikelihood(None)


if __name__ == "__main__":
    unittest.main()
