"""Localizer: the poses of pole-localize, threads, wrong arguments."""

import csv
import gc
import itertools
import threading
import unittest

import numpy as np
import polemcl
import street


def detections():
    extractor = polemcl.PoleExtractor(street.CONFIG)
    return [extractor.extract(points) for points in street.points()]


def started(seed=street.SEED, settings=None):
    localizer = polemcl.Localizer(polemcl.PoleMap.load(street.map_file()), street.CONFIG,
                                  settings or {}, seed)
    x, y, yaw, radius, heading = street.START
    localizer.start((x, y, np.radians(yaw)), radius, np.radians(heading))
    return localizer


def drive(localizer, poles):
    """The first scans of the street, one for each item of poles."""
    return [localizer.step(time, *motion, seen) for time, motion, seen in
            zip(street.truth()[:, 0], street.motions(), poles)]


def rows_of(updates):
    """Rows as pole-localize writes them."""
    for index, update in enumerate(updates):
        x, y, yaw = update.estimate.mean
        covariance = update.estimate.covariance[np.triu_indices(3)]
        yield ",".join([str(index), f"{update.time:.9f}", f"{x:.6f}", f"{y:.6f}", f"{yaw:.9f}",
                        *(f"{value:.9g}" for value in covariance)])


class Poses(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.poles = detections()

    def test_are_those_of_pole_localize(self):
        updates = drive(started(), self.poles)
        expected = (street.localized() / "run_00_cov.csv").read_text().splitlines()[1:]
        self.assertEqual(list(rows_of(updates)), expected)
        with open(street.localized() / "run_00_health.csv", encoding="utf-8") as file:
            for update, row in zip(updates, csv.DictReader(file), strict=True):
                self.assertEqual((update.health.state, update.health.reason, update.poles),
                                 (row["state"], row["reason"], int(row["poles"])))
                self.assertEqual(f"{update.health.matched_share:.4f}", row["matched_share"])
        error = np.hypot(*(updates[-1].estimate.mean - street.true_poses()[-1])[:2])
        self.assertLess(error, 0.1)
        self.assertEqual(updates[-1].health.state, "ok")

    def test_depend_on_the_seed_only(self):
        first, again, other = (list(rows_of(drive(started(seed), self.poles[:5])))
                               for seed in (1, 1, 2))
        self.assertEqual(first, again)
        self.assertNotEqual(first, other)
        seeded = started(None, {"runs.seed": 2})
        self.assertEqual(list(rows_of(drive(seeded, self.poles[:5]))), other)

    def test_are_the_same_in_two_threads(self):
        expected = list(rows_of(drive(started(), self.poles)))
        found = {}

        def work(name):
            found[name] = list(rows_of(drive(started(), self.poles)))

        threads = [threading.Thread(target=work, args=(name,)) for name in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, {0: expected, 1: expected})

    def test_are_found_while_other_threads_run(self):
        localizer, times = started(), itertools.count()
        arguments = (np.zeros(3), np.eye(3) * 1e-4, street.no_poles())
        self.assertTrue(street.lets_others_run(lambda: localizer.step(next(times), *arguments)))

    def test_are_none_until_the_global_search_finds_one(self):
        localizer = polemcl.Localizer(polemcl.PoleMap.load(street.map_file()), street.CONFIG,
                                      {}, 1)
        localizer.start_anywhere()
        first = localizer.step(0, None, None, self.poles[0])
        self.assertIsNone(first.estimate)
        self.assertEqual((first.health.state, first.health.reason), ("lost", "searching"))
        self.assertEqual(localizer.particles.shape, (0, 3))

    def test_outlive_the_localizer(self):
        localizer = started()
        update = localizer.step(0, None, None, self.poles[0])
        mean, covariance, particles = (update.estimate.mean, update.estimate.covariance,
                                       localizer.particles)
        copies = [array.copy() for array in (mean, covariance, particles)]
        estimate = update.estimate
        localizer.step(0.2, *street.motions()[1], self.poles[1])
        del localizer, update
        gc.collect()
        for array, copy in zip((mean, covariance, particles), copies, strict=True):
            np.testing.assert_array_equal(array, copy)
        np.testing.assert_array_equal(estimate.mean, mean)
        np.testing.assert_array_equal(covariance, covariance.T)
        self.assertEqual(particles.shape[1], 3)

    def test_take_the_covariance_from_the_settings(self):
        settings = {"motion.xy_per_m": 0.1, "motion.xy_per_rad": 0,
                    "motion.yaw_per_m_deg": 0, "motion.yaw_per_rad": 0}
        motion = (1.0, 0, 0)
        stated = np.diag([0.105**2, 0.105**2, 0.00087**2])  # with the floors of each motion
        means = []
        for covariance in (None, stated):
            localizer = started(settings=settings)
            localizer.step(0, None, None, self.poles[0])
            means.append(localizer.step(0.2, motion, covariance, self.poles[1]).estimate.mean)
        np.testing.assert_allclose(*means, rtol=1e-9)
        scaled = started(settings={"motion.covariance_factor": 4})
        scaled.step(0, None, None, self.poles[0])
        doubled = started()
        doubled.step(0, None, None, self.poles[0])
        np.testing.assert_array_equal(
            scaled.step(0.2, motion, stated, self.poles[1]).estimate.mean,
            doubled.step(0.2, motion, 4 * stated, self.poles[1]).estimate.mean)


class WrongArguments(unittest.TestCase):
    def test_are_refused(self):
        poles = np.zeros(0, polemcl.detection_type)
        good = ((1, 0, 0), np.eye(3) * 0.01, poles)
        wrong = {
            r"motion: \(3,\)": ((1, 2), good[1], poles),
            r"covariance: \(3, 3\)": (good[0], np.eye(2), poles),
            "not symmetric": (good[0], np.diag([1, 1, -1]), poles),
            "not finite": ((np.nan, 0, 0), good[1], poles),
            "needs odometry": (None, None, poles),
            "detection_type": (good[0], good[1], np.zeros(4)),
            "poles: a NumPy array is needed": (good[0], good[1], None),
        }
        localizer = started()
        localizer.step(0, None, None, poles)
        for message, arguments in wrong.items():
            with self.subTest(message), self.assertRaisesRegex(polemcl.Error, message):
                localizer.step(1, *arguments)
        with self.assertRaisesRegex(polemcl.Error, "time does not increase"):
            localizer.step(0, *good)
        localizer.step(1, *good)

    def test_of_the_start_are_refused(self):
        street_map = polemcl.PoleMap.load(street.map_file())
        with self.assertRaisesRegex(polemcl.Error, "has not been started"):
            polemcl.Localizer(street_map).step(0, None, None, np.zeros(0, polemcl.detection_type))
        with self.assertRaisesRegex(polemcl.Error, "from the nearest pole"):
            polemcl.Localizer(street_map).start((1e6, 0, 0))
        with self.assertRaisesRegex(polemcl.Error, "radius"):
            polemcl.Localizer(street_map).start((0, 0, 0), radius=-1)
        with self.assertRaisesRegex(polemcl.Error, "no poles"):
            polemcl.Localizer(polemcl.PoleMap(np.zeros(0, polemcl.map_pole_type)))
        with self.assertRaises(TypeError):
            polemcl.Localizer(None)


if __name__ == "__main__":
    unittest.main()
