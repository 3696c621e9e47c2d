"""Report of a batch: tables, plots and page that share/report/report.py makes of sample.json.

sample.json holds scoredBatch() of tests/support/SampleBatches.h; test_BatchJson.cpp keeps it so.
"""

import contextlib
import copy
import csv
import html.parser
import io
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

HERE = pathlib.Path(__file__).parent
SHARE = HERE.parents[2] / "share"
sys.path.insert(0, str(SHARE / "report"))
import files  # noqa: E402
import quantities  # noqa: E402
import report  # noqa: E402
import summaries  # noqa: E402

WRITTEN = json.loads((HERE / "sample.json").read_text(encoding="utf-8"))
SAMPLE = summaries.summed_up(WRITTEN)
TIMES = {"machine": "2 cores & more", "wall_s": 100, "jobs": 2,
         "tasks": [{"kind": "extract", "seconds": [2, 1, 3]}, {"kind": "map", "seconds": []}]}


def batch(dataset="", timings=None, change=lambda results: None):
    results = copy.deepcopy(SAMPLE)
    results["dataset"] = dataset
    change(results)
    return report.Report(results, timings)


def page(*arguments, **named):
    return report.page(batch(*arguments, **named))


PLAIN = page()


def maps_alone(results):
    for one in results["results"]:
        one["runs"] = []
    for one in results["summary"]:
        one.update(runs=0, lost=0, failed=0)
        for session in one["sessions"]:
            session.update(runs=0, lost=0, failed=0)
    results["failures"] = []


class Page(html.parser.HTMLParser):
    """Every start tag, checked to be closed in order, and the rows of tables by section."""

    void = {"meta"}

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.rows, self.section, self.text = [], [], {}, "", {}
        self.feed(text)
        self.close()
        assert not self.open, self.open

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.tags.append((tag, attributes))
        self.open.append(tag)
        if tag == "section" and "id" in attributes:
            self.section = attributes["id"]
        if tag == "tr":
            self.rows.setdefault(self.section, []).append([])
        if tag in ("th", "td"):
            self.rows[self.section][-1].append("")
        if tag in self.void:
            self.open.pop()

    def handle_startendtag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        for tag in self.open:
            self.text[tag] = self.text.get(tag, "") + data
        if "td" in self.open or "th" in self.open:
            self.rows[self.section][-1][-1] += data

    def row(self, section, name):
        """The first row of a section with that name."""
        return next((row for row in self.rows[section] if row[0] == name), None)


class Pages(unittest.TestCase):
    def test_are_well_formed_and_point_only_to_themselves(self):
        for text in (PLAIN, page("nclt", TIMES), page("kitti-0009"), page("mulran-kaist"),
                     page("semantickitti", change=maps_alone)):
            read = Page(text)
            ids = [attributes["id"] for _, attributes in read.tags if "id" in attributes]
            self.assertEqual(len(ids), len(set(ids)))
            used = re.findall(r'(?:href="|url\()#([^")]*)', text)
            used += " ".join(attributes.get("aria-labelledby", "") for _, attributes in read.tags).split()
            self.assertGreater(len(used), 20)
            self.assertEqual(set(used) - set(ids), set())
            for way in ("http:", "https:", "src=", "@import", "<script", "<link", "<img", "<iframe"):
                self.assertNotIn(way, text)
            self.assertIsNone(re.search(r"\b(nan|inf|None|null)\b", text))
            plots = [attributes for tag, attributes in read.tags if "plot" in attributes.get("class", "")]
            self.assertTrue(plots or "mapping" in text)
            self.assertTrue(all(one["role"] == "img" for one in plots))

    def test_rows_are_as_wide_as_their_table(self):
        for table in re.findall("<table.*?</table>", page("nclt", TIMES), re.DOTALL):
            widths = {sum(int((re.search(r'colspan="(\d+)"', cell) or [0, 1])[1])
                          for cell in re.findall("<t[hd][^>]*>", row)) for row in
                      re.findall("<tr.*?</tr>", table, re.DOTALL)}
            self.assertEqual(len(widths), 1, table)

    def test_hostile_texts_are_text(self):
        evil = "$x$<script>alert('x')</script>&\"]]>-->\x01"

        def change(results):
            old, new = "plain", evil + "plain"
            results.update(json.loads(json.dumps(results).replace(
                json.dumps(old), json.dumps(new)).replace(json.dumps("two_2"), json.dumps(evil))))
            results["title"] = results["command"] = results["results"][1]["runs"][1]["failure"] = evil
            results["settings"][0].update(description=evil, protocol=evil, config=f"[a]\nkey = {evil}\n")

        text = page("nclt", {**TIMES, "machine": evil}, change)
        self.assertNotIn("script", [tag for tag, _ in Page(text).tags])
        self.assertIn(">$x$&lt;script&gt;alert…</text>", text)  # no formula of Matplotlib
        self.assertEqual(Page(text).text["h1"], evil.replace("\x01", "\ufffd"))

    def test_only_timings_change_with_the_time(self):
        def rest(text):
            return re.sub('<section id="timings">.*?</section>', "", text, flags=re.DOTALL)
        made = []
        for seconds in (100, 6000):
            with tempfile.TemporaryDirectory() as folder:
                folder = pathlib.Path(folder)
                (folder / "results.json").write_text(json.dumps(SAMPLE if made else WRITTEN))
                (folder / "timings.json").write_text(json.dumps({**TIMES, "wall_s": seconds}))
                subprocess.run([sys.executable, "-B", SHARE / "report/report.py", folder], check=True)
                made.append((folder / "report.html").read_text() + (folder / "table.tex").read_text())
                self.assertEqual({one.name for one in folder.iterdir()}, {
                    "report.html", "table.tex", "results.json", "timings.json", "runs.csv", "sessions.csv",
                    "maps.csv"})
                self.assertEqual((folder / "results.json").read_text(), files.json_text(SAMPLE) + "\n")
                self.assertEqual((folder / "sessions.csv").read_text(), files.sessions_csv(SAMPLE))
        self.assertNotEqual(*made)
        self.assertEqual(*map(rest, made))
        self.assertEqual(Page(page(timings=TIMES)).row("timings", "extract"),
                         ["extract", "3", "6.0 s", "2.0 s", "3.0 s"])

    def test_warn_of_what_was_lost(self):
        alarm = re.search('<p class="alarm">.*?</p>', PLAIN, re.DOTALL)[0]
        for words in ("2 of 7 runs had a wrong pose, 1 failed", "No run got through: three (plain)"):
            self.assertIn(words, alarm)
        self.assertEqual(len(Page(PLAIN).rows["troubles"]), 2 + 4)
        text = page(change=maps_alone)
        self.assertIn("Maps only: no session was to be localized.", text)
        self.assertNotIn('class="alarm"', text)

    def test_of_a_long_batch_stay_below_ten_megabytes(self):
        def change(results):
            plots = results["results"][0]["plots"]
            plots["map_poles_xy"] = [250 * math.cos(1.3 * i) for i in range(6000)]
            plots["truth_xy"] = [300 * math.sin(0.017 * i) for i in range(3000)]
        text = page(change=change)
        dots = re.search(r'<path d="([^"]*)"[^>]*stroke-linecap: round"', text)[1]
        self.assertEqual((dots.count("M"), dots.count("L")), (3000, 3000))
        self.assertLess(54 * (len(text) - len(PLAIN)), 10e6)


class Tables(unittest.TestCase):
    def test_sessions_are_in_the_papers_layout(self):
        read = Page(page(change=lambda results: results["published_sessions"].clear()))
        self.assertEqual(read.row("sessions", "one<&\">"), [
            "one<&\">", "100.0", "0.200 ± 0.141", "0.400 ± 0.283", "0.300 ± 0.141", "0.600 ± 0.283", "2"])
        self.assertEqual(read.row("sessions", "three")[1], "–")
        self.assertEqual(read.row("sessions", "Mean of sessions"), [
            "Mean of sessions", "62.5", "1.533", "3.067", "0.700", "1.400", "6, 2 wrong, 1 failed in all"])

    def test_published_sessions_stand_beside_ours(self):
        read = Page(PLAIN)
        self.assertEqual(read.row("sessions", "two_2"), [
            "two_2", "25.0", "50.0", "0.400", "0.120", "0.130", "0.800", "0.146", "0.178", "0.800",
            "0.626", "0.663", "1.600", "0.810", "0.857", "2, 1 failed"])
        mean = read.row("sessions", "Mean of sessions")  # over the sessions that both have
        self.assertEqual((mean[2], mean[4], mean[5]), ("37.5", "0.183", "0.130"))

        def change(results):  # session three without a figure of ours
            results["summary"][0]["sessions"][2]["figures"]["pos_mean"].update(
                mean=None, deviation=None, count=0)
        self.assertEqual(Page(page(change=change)).row("sessions", "Mean of sessions")[4], "0.120")

    def test_published_figures_stand_beside_ours_for_their_dataset(self):
        self.assertNotIn("published", Page(PLAIN).rows)
        read = Page(page("nclt"))
        self.assertEqual(read.row("published", "Dong et al. 2021"),
                         ["Dong et al. 2021", "0.174", "0.293", "0.761", "1.016"])
        self.assertEqual(read.row("published", "polemcl, up_keep 100 %"),
                         ["polemcl, up_keep 100 %", "0.200", "0.400", "0.500", "1.000"])

    def test_scores_stand_below_those_published(self):
        read = Page(page("semantickitti"))
        self.assertEqual(read.row("scores", "Dong et al. 2021"),
                         ["Dong et al. 2021", "0.687", "0.439", "0.515"] + 7 * ["–"])
        self.assertEqual(read.row("scores", "polemcl, plain"), [
            "polemcl, plain", "0.750", "0.600", "0.667", "0.625", "0.500", "0.556", "0.500", "0.400",
            "0.444", "1"])
        self.assertIsNone(read.row("scores", "three"))  # one map each: nothing more to tell

    def test_changed_keys_are_side_by_side(self):
        def change(results):
            first, second = results["settings"]
            first["config"] = "[map]\ncount = 6 ; detections\nsame = 1\n[filter]\ncount = 500\n"
            second["config"] = "[map]\nsame = 1 # as there\ncount = 9\n"
        rows = Page(page(change=change)).rows["configuration"]
        self.assertEqual(rows[1:], [["filter.count", "500", "–"], ["map.count", "6", "9"]])

    def test_latex_rows(self):
        text = report.tables(batch("mulran-kaist"))
        for row in (
                r"two\_2 & 25.0 & 0.400 & 0.120 & 0.130 & 0.800 & 0.146 & 0.178 & 0.800 & 0.626 & 0.663 "
                r"& 1.600 & 0.810 & 0.857",
                "Dong et al. 2021 & -- & 48.0 & 0.270", r"polemcl, up\_keep 100 \% & 0.400 & 7.1 & 1.000",
                "polemcl, plain & 0.750 & 0.600 & 0.667 & 0.625 & 0.500 & 0.556 & 0.500 & 0.400 & 0.444"):
            self.assertIn(f"    {row} \\\\\n", text)
        self.assertIn(r"$\mathrm{RMSE}_\mathrm{axis}$ [cm]", text)
        self.assertIn("3 sessions, runs: 6, 2 wrong, 1 failed. paper: own data in the map.", text)
        for table in text.split(r"\begin{tabular}")[1:]:
            columns = len(re.match("{([lr]+)}", table)[1])
            for row in re.findall(r"^    (.*) \\\\$", table, re.MULTILINE):
                self.assertEqual(len(re.findall(r"(?<!\\)&", row)) + 1, columns, row)


class Plots(unittest.TestCase):
    def test_maps_keep_shapes_with_north_up(self):
        def change(results):  # higher than the plot may be
            results["results"][0]["plots"]["truth_xy"] = [0, 0, 40, 0, 40, 300]

        svg = re.search('<svg class="plot map.*?</svg>', page(change=change), re.DOTALL)[0]
        path = re.search(r'<path d="([^"]*)"[^>]*stroke: var\(--truth\)', svg)[1]
        (x0, y0), (x1, y1), (x2, y2) = [map(float, point) for point in
                                        re.findall(r"[ML] ([\d.]+) ([\d.]+)", path)]
        self.assertAlmostEqual(y1, y0, delta=0.11)
        self.assertAlmostEqual(x2, x1, delta=0.11)
        self.assertAlmostEqual((y1 - y2) / (x1 - x0), 7.5, delta=0.05)  # 40 m east, 300 m north

    def test_gaps_in_the_error_are_gaps_in_its_line(self):
        svg = re.search('aria-labelledby[^>]*>\n<title[^>]*>Position error over.*?</svg>', PLAIN,
                        re.DOTALL)[0]
        line = re.findall(r'<path d="([^"]*)"[^>]*stroke: var\(--s0\)', svg)[-1]
        self.assertEqual(line.count("M"), 2)

    def test_every_session_with_figures_has_its_mark_and_arrows_are_told(self):
        hint = "<title>three, plain: 4.000 m</title>"
        self.assertIn(hint, PLAIN)
        self.assertEqual(PLAIN.count("<title>two_2, up_keep 100 %: "), 2)

        def change(results):  # twenty sessions of 0.2 m: one of 4 m is far above
            summary = results["summary"][0]["sessions"]
            for i in range(20):
                results["sessions"].append({**results["sessions"][0], "name": f"more {i}"})
                summary.append({**summary[0], "session": f"more {i}"})
        self.assertIn("Arrows: above the plot, three, plain: 4.000 m.", page(change=change))


class Quantities(unittest.TestCase):
    def test_short_lengths_are_centimetres_with_two_significant_digits(self):
        for value, text in ((0.0072, "0.72 cm"), (0.00004, "0.004 cm"), (0.0724, "7.2 cm"),
                            (0.0996, "10 cm"), (0.009951, "1.0 cm"), (0.1, "10.0 cm"), (0, "0.0 cm"),
                            (0.1744, "17.4 cm"), (5.48, "5.480 m"), (None, "– m")):
            self.assertEqual(quantities.metres(value, " "), text)

    def test_a_column_has_one_unit(self):
        large = report.column("pos_mean", [0.174, None, 2.47])
        self.assertEqual((large.html, large.text(0.0123), large.text(None)),
                         ("Δ<sub>pos</sub> (m)", "0.012", "–"))
        mixed = report.column("pos_mean", [0.174, 0.0072])
        self.assertEqual(mixed.tex, r"$\Delta_\mathrm{pos}$ [cm]")
        self.assertEqual([mixed.text(value) for value in (0.0072, 0.00031, 2.47)], ["0.72", "0.031", "247.0"])
        self.assertEqual(report.column("ang_mean_deg", [0.02]).text(0.0212), "0.021")

    def test_words(self):
        self.assertEqual([quantities.change(one) for one in (1.08, 0.97, 1, 17, None)],
                         ["+8 %", "−3 %", "±0 %", "17 times", "–"])
        self.assertEqual([quantities.duration(one) for one in (1.25, 12, 200, 7500, None)],
                         ["1.2 s", "12 s", "3 min 20 s", "2 h 5 min", "–"])
        self.assertEqual(quantities.number(-0.0001, 3), "0.000")
        self.assertEqual(quantities.count(12345), "12\u2009345")
        self.assertEqual(quantities.tex("a_b & 5 % #1 $x$ {y}"), r"a\_b \& 5 \% \#1 \$x\$ \{y\}")
        self.assertEqual(quantities.tex("\\~^<>| --jobs ''\n"), r"\textbackslash{}\textasciitilde{}"
                         r"\textasciicircum{}\textless{}\textgreater{}\textbar{} -{}-jobs '{}' ")


class Published(unittest.TestCase):
    tables = json.loads((SHARE / "published/tables.json").read_text(encoding="utf-8"))

    def test_means_agree_with_their_parts(self):
        for dataset in self.tables.values():
            for one in dataset["figures"]:
                self.assertLessEqual(one.get("pos_mean", 0), one.get("pos_rmse", math.inf))
                self.assertLessEqual(one.get("ang_mean_deg", 0), one.get("ang_rmse_deg", math.inf))
                self.assertLessEqual(one.get("pos_mean", 0),
                                     one.get("lat_mean", math.inf) + one.get("lon_mean", math.inf))
            for one in dataset["maps"]:  # a mean over maps is not far from the F1 of the means
                f1 = 2 * one["precision"] * one["recall"] / (one["precision"] + one["recall"])
                self.assertAlmostEqual(f1, one["f1"], delta=0.03)

    def test_sessions_of_nclt_agree_with_their_means(self):
        lines = (SHARE / "published/nclt-table3.csv").read_text(encoding="utf-8").splitlines()
        rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
        for system in self.tables["nclt"]["figures"]:
            own = [row for row in rows if row["system"] == system["system"]]
            self.assertEqual(len(own), 27)
            for key in report.SESSION_KEYS:  # half of the last digit, and what rounding of 27 adds
                self.assertAlmostEqual(sum(float(row[key]) for row in own) / 27, system[key], delta=7e-4)

    def test_keys_are_those_of_columns(self):
        for dataset in self.tables.values():
            for one in dataset["figures"]:
                self.assertLessEqual(set(one) - {"system", "remark"}, set(report.COLUMNS))


class Usage(unittest.TestCase):
    def run_script(self, *arguments):
        said = io.StringIO()
        with contextlib.redirect_stderr(said), unittest.mock.patch("sys.argv", ["report.py", *arguments]):
            return report.main(), said.getvalue()

    def test_reads_standard_input(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-B", SHARE / "report/report.py", folder, "-"], check=True,
                           input=json.dumps(WRITTEN).encode())
            self.assertEqual((pathlib.Path(folder) / "results.json").read_text(), files.json_text(SAMPLE) + "\n")

    def test_writes_all_files_or_none(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "results.json").write_text(json.dumps(WRITTEN))
            (folder / "runs.csv.part").symlink_to(folder / "results.json")  # is not followed
            (folder / "report.html.part").mkdir()
            code, said = self.run_script(str(folder))
            self.assertEqual((code, said.count("\n")), (1, 1))
            self.assertEqual({one.name for one in folder.iterdir()}, {"results.json", "report.html.part"})
            self.assertEqual((folder / "results.json").read_text(), json.dumps(WRITTEN))

    def test_says_what_is_wrong_in_one_line(self):
        self.assertEqual(self.run_script()[0], 2)
        self.assertEqual(self.run_script("folder", "results.json")[0], 2)
        code, said = self.run_script("/not/there")
        self.assertEqual((code, said.count("\n")), (1, 1))
        self.assertIn("/not/there/results.json", said)

    def test_writes_nothing_of_results_that_it_cannot_read(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "results.json"
            file.write_text(json.dumps(WRITTEN)[:-1])
            code, said = self.run_script(folder)
            self.assertEqual((code, said.count("\n"), list(file.parent.iterdir())), (1, 1, [file]))

    def test_replaces_characters_that_turn_text_around(self):
        marks = "".join(map(chr, (0x80, 0x9f, 0x202a, 0x202e, 0x2066, 0x2069)))
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            text = json.dumps(WRITTEN, ensure_ascii=False).replace('"plain"', f'"pl{marks}ain"')
            (folder / "results.json").write_text(text, encoding="utf-8")
            self.assertEqual(self.run_script(str(folder))[0], 0)
            for name in ("table.tex", "runs.csv", "sessions.csv", "maps.csv", "report.html"):
                text = (folder / name).read_text(encoding="utf-8")
                self.assertFalse(set(marks) & set(text), name)
                self.assertIn("pl" + "\ufffd" * len(marks) + "ain", text)

    def test_refuses_results_nested_too_deeply(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "results.json").write_text("[" * 200000)
            code, said = self.run_script(folder)
            self.assertEqual((code, said.count("\n")), (1, 1))
            self.assertIn("nested too deeply", said)

    def test_refuses_results_that_pole_batch_did_not_write(self):
        without = [{key: value for key, value in WRITTEN.items() if key != gone}
                   for gone in ("dataset", "sessions", "settings", "results")]
        for foreign in [[], 7, "text", {}, {"settings": 3}, {**WRITTEN, "results": [None]}, *without]:
            with self.subTest(str(foreign)[:40]), tempfile.TemporaryDirectory() as folder:
                file = pathlib.Path(folder) / "results.json"
                file.write_text(json.dumps(foreign))
                code, said = self.run_script(folder)
                self.assertEqual((code, said.count("\n"), list(file.parent.iterdir())), (1, 1, [file]))
                self.assertIn("results.json", said)

    def test_leaves_no_part_of_a_file_that_it_cannot_write(self):
        with tempfile.TemporaryDirectory() as folder:
            file, table = pathlib.Path(folder) / "results.json", pathlib.Path(folder) / "runs.csv"
            file.write_text(json.dumps(WRITTEN))
            table.mkdir()
            code, said = self.run_script(folder)
            self.assertEqual((code, said.count("\n"), set(file.parent.iterdir())), (1, 1, {file, table}))
            self.assertIn("runs.csv", said)


if __name__ == "__main__":
    unittest.main()
