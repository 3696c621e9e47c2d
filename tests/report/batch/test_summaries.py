"""Sums and tables of a batch: what share/report/summaries.py and files.py make of sample.json."""

import copy
import csv
import io
import json
import math
import pathlib
import re
import sys
import unittest

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE.parents[2] / "share/report"))
import files  # noqa: E402
import summaries  # noqa: E402

SAMPLE = json.loads((HERE / "sample.json").read_text(encoding="utf-8"))


def batch(change=lambda results: None):
    results = copy.deepcopy(SAMPLE)
    change(results)
    return summaries.summed_up(results)


def setting(i, change=lambda results: None):
    return batch(change)["summary"][i]


def without_scores(results):
    for one in results:
        one["map_score"] = None


class Summaries(unittest.TestCase):
    def near(self, value, expected):
        self.assertAlmostEqual(value, expected, delta=1e-12)

    def test_spread_of_a_handful_of_numbers(self):
        # Mean 5, squares 9 + 1 + 1 + 1 + 0 + 0 + 4 + 16 = 32, over 7.
        spread = summaries.spread([2.0, 4.0, 4.0, 4.0, 5.0, None, 5.0, 7.0, 9.0])
        self.near(spread.pop("deviation"), math.sqrt(32 / 7))
        self.assertEqual(spread, {"mean": 5, "largest": 9, "count": 8})

    def test_one_value_has_no_deviation_and_none_has_nothing(self):
        self.assertEqual(summaries.spread([3.0]), {"mean": 3, "deviation": None, "largest": 3, "count": 1})
        self.assertEqual(summaries.spread([None]),
                         {"mean": None, "deviation": None, "largest": None, "count": 0})

    def test_digits_are_those_of_one_sum_after_the_other(self):
        self.assertEqual(summaries.total([0.1] * 10), 0.9999999999999999)  # sum() of Python 3.12: 1.0

    def test_sessions_are_means_over_their_runs(self):
        first, second, _ = setting(0)["sessions"]
        figures = first["figures"]
        self.near(figures["pos_mean"]["mean"], 0.2)
        self.near(figures["pos_mean"]["deviation"], math.sqrt(0.02))
        self.near(figures["pos_rmse"]["mean"], 0.4)
        self.near(figures["ang_mean_deg"]["mean"], 0.3)
        self.near(figures["ang_rmse_deg"]["mean"], 0.6)
        self.near(figures["pos_max"]["largest"], 0.9)
        # Per axis: sqrt((0.09 + 0.16) / 2) times 0.1 and 0.3.
        self.near(figures["axis_rmse"]["mean"], 0.2 * math.sqrt(0.125))
        self.near(figures["ok_share"]["mean"], 0.9)
        self.assertEqual((first["relocalizations"], first["map_poles"]), (1, 210))
        self.assertEqual((second["runs"], second["lost"], second["failed"]), (2, 0, 1))
        self.near(second["figures"]["pos_mean"]["mean"], 0.4)
        self.assertEqual(second["figures"]["pos_mean"]["count"], 1)

    def test_settings_are_means_over_their_sessions(self):
        plain = setting(0)
        # Each session once, however many runs it has; lost runs with a pose are in: 0.2, 0.4, 4.
        self.near(plain["figures"]["pos_mean"]["mean"], 4.6 / 3)
        self.near(plain["figures"]["pos_max"]["largest"], 12)
        self.near(plain["last_over_first"], 4 / 0.2)
        self.near(plain["f_map"]["mean"], 0.625)
        self.assertEqual([plain[key] for key in ("setting", "runs", "lost", "failed")], ["plain", 6, 2, 1])
        self.assertEqual((plain["localized_sessions"], plain["lost_sessions"]), (3, 1))

    def test_largest_is_that_of_all_runs_and_lost_sessions_have_no_good_run(self):
        def first_alone(results):
            for one in results["results"][1:3]:
                one["runs"] = []

        def second_lost(results):
            results["results"][1]["runs"][0]["state"] = "lost"
        self.near(setting(0, first_alone)["figures"]["pos_max"]["largest"], 0.9)  # their mean is 0.6
        self.assertEqual(setting(0, second_lost)["lost_sessions"], 2)

    def test_scores_are_means_over_the_maps(self):
        def change(results):  # P 1, R 0.8, F1 16/18
            results["results"][0]["map_score"] = results["results"][3]["map_score"]

        plain, kept = batch(change)["summary"]
        near = plain["map_score"]["near_1m"]
        self.near(near["precision"], (0.75 + 1) / 2)
        self.near(near["recall"], (0.6 + 0.8) / 2)
        # 6 of 8 and of 10: F1 = 12/18. A mean of F1, not the F1 of the means.
        self.near(near["f1"], (12 / 18 + 16 / 18) / 2)
        self.near(plain["map_score"]["one_to_one_1m"]["precision"], 5 / 8)
        self.near(plain["map_score"]["one_to_one_0.5m"]["recall"], 0.4)
        self.assertEqual((plain["scored_maps"], kept["scored_maps"]), (2, 1))
        none = setting(0, lambda results: without_scores(results["results"]))
        self.assertEqual((none["scored_maps"], none["map_score"]["near_1m"]["f1"]), (0, None))

    def test_shares_of_the_map_are_those_of_the_localized_sessions(self):
        def mapped_only(results):
            results["results"][0]["runs"] = []

        def maps_alone(results):
            for one in results["results"]:
                one["runs"] = []
        self.assertEqual(setting(0, mapped_only)["f_map"]["mean"], 0.25)
        self.assertEqual(setting(0, maps_alone)["f_map"]["mean"], 0.625)

    def test_one_session_has_nothing_to_compare_the_last_with(self):
        kept = setting(1)
        self.assertEqual([one["session"] for one in kept["sessions"]], ["two_2"])
        self.assertIsNone(kept["last_over_first"])


class Files(unittest.TestCase):
    def rows(self, text):
        return list(csv.DictReader(io.StringIO(text)))

    def test_json_has_plain_lists_on_one_line_and_keeps_all_digits(self):
        value = {"a": [], "b": {}, "c": [1, None, "é\"\n"], "d": [{"x": 0.1 + 0.2}, 2**64 - 1], "e": {"f": 2.0}}
        self.assertEqual(files.json_text(value), r'''{
  "a": [],
  "b": {},
  "c": [1,null,"é\"\n"],
  "d": [
    {
      "x": 0.30000000000000004
    },
    18446744073709551615
  ],
  "e": {
    "f": 2.0
  }
}''')
        self.assertEqual(json.loads(files.json_text(batch())), batch())

    def test_runs_as_a_table(self):
        text = files.runs_csv(batch())
        self.assertEqual(text.splitlines()[4],
                         'plain,two_2,1,1001,failed,"disk full, ""really""",,,,,,,,,,,,,,0,0,,,,,0')
        rows = self.rows(text)
        self.assertEqual(len(rows), 7)
        self.assertEqual((rows[0]["session"], rows[5]["state"]), ("one<&\">", "lost"))
        self.assertEqual((rows[2]["pos_rmse"], rows[2]["first_pose_scan"]), ("0.8", "0"))
        self.assertEqual((rows[6]["setting"], rows[6]["degraded_share"]), ("up_keep 100 %", "0.1"))

    def test_sessions_as_a_table(self):
        rows = self.rows(files.sessions_csv(batch()))
        self.assertEqual(len(rows), 4)
        self.assertEqual((rows[0]["pos_mean"], rows[0]["pos_mean_sd"]), ("0.2", "0.141421356"))
        self.assertEqual((rows[0]["axis_rmse"], rows[0]["ok_share"]), ("0.0707106781", "0.9"))
        self.assertEqual((rows[0]["date"], rows[0]["scans"]), ("2012-01-08", "700"))
        self.assertEqual([rows[1][key] for key in ("pos_mean_sd", "length_m", "failed")], ["", "", "1"])
        self.assertEqual((rows[3]["f_map"], rows[3]["map_poles"]), ("0", "210"))

        def mapped_only(results):
            results["results"][3]["runs"] = []
        self.assertEqual(self.rows(files.sessions_csv(batch(mapped_only)))[3]["map_poles"], "")

    def test_maps_as_a_table(self):
        rows = self.rows(files.maps_csv(batch()))
        self.assertEqual(len(rows), 2)
        expected = {"setting": "plain", "session": "three", "truth": "truth.csv", "map_poles": "8",
                    "truth_poles": "10", "near_1m_precision": "0.75", "one_to_one_1m_matches": "5",
                    "one_to_one_0.5m_recall": "0.4"}
        self.assertEqual({key: rows[0][key] for key in expected}, expected)
        self.assertEqual(rows[1]["near_1m_recall"], "0.8")
        none = files.maps_csv(batch(lambda results: without_scores(results["results"])))
        self.assertEqual(none.count("\n"), 1)

    def test_texts_are_fields_of_one_line(self):
        self.assertEqual(files.table(["a b", " a", "a ", "a#", "a\r\nb", "", None, 1e-7 / 3, 7]),
                         'a b," a","a ","a#",a  b,,,3.33333333e-08,7\n')

    def test_no_figure_is_never_printed(self):
        results = batch()
        for text in (files.json_text(results), files.runs_csv(results), files.sessions_csv(results),
                     files.maps_csv(results)):
            self.assertIsNone(re.search(r"\b(nan|inf|none)\b", text, re.IGNORECASE))


if __name__ == "__main__":
    unittest.main()
