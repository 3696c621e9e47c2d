"""Report of a batch: from results.json to report.html, table.tex, runs.csv, sessions.csv and maps.csv.

Usage: report.py FOLDER [-]
  FOLDER  folder of the batch, with results.json; timings.json is shown where it is there
  -       the results are read from standard input, not from results.json

It also adds `summary` to results.json: means and spreads over runs and over sessions. Needs the Debian
packages python3-jinja2 and python3-matplotlib. The same results give the same bytes.
"""

import json
import os
import re
import sys
from pathlib import Path

try:
    import jinja2
    from markupsafe import Markup

    import figures
except ImportError as error:
    sys.exit(f"{error}; install the packages python3-jinja2 and python3-matplotlib")
import files
import quantities
import summaries
from quantities import Column

HERE = Path(__file__).parent
COLUMNS = {  # key of a figure: symbol and index
    "pos_mean": ("Δ", "pos"), "pos_rmse": ("RMSE", "pos"), "axis_rmse": ("RMSE", "axis"),
    "lat_mean": ("Δ", "lat"), "lat_std": ("σ", "lat"), "lon_mean": ("Δ", "lon"), "lon_std": ("σ", "lon"),
    "ang_mean_deg": ("Δ", "ang"), "ang_std_deg": ("σ", "ang"), "ang_rmse_deg": ("RMSE", "ang"),
    "pos_max": ("Largest", ""),
}
SESSION_KEYS = ("pos_mean", "pos_rmse", "ang_mean_deg", "ang_rmse_deg")
RUN_KEYS = ("pos_mean", "pos_rmse", "pos_max", "lat_mean", "lon_mean", "ang_mean_deg", "ang_rmse_deg")
WAYS = dict(zip(summaries.WAYS, ("authors' count, 1\u00a0m", "one to one, 1\u00a0m", "one to one, 0.5\u00a0m")))


def column(key, values):
    return Column(*COLUMNS[key], key, values)


def clean(value):
    """Characters that control a page or the direction of its text become U+FFFD."""
    if isinstance(value, str):
        return re.sub(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]", "\ufffd", value)
    if isinstance(value, list):
        return [clean(one) for one in value]
    if isinstance(value, dict):
        return {key: clean(one) for key, one in value.items()}
    return value


def ini_values(text):
    """The values of an INI text by section.key, without comments."""
    values, section = {}, ""
    for line in text.splitlines():
        line = re.split("[;#]|//", line)[0].strip()
        if line.startswith("[") and line.endswith("]"):
            section = line[1:-1] + "."
        elif "=" in line:
            key, value = line.split("=", 1)
            values[section + key.strip()] = value.strip()
    return values


class Report:
    """What the templates show: results that are summed up, all that belongs to a setting in one place."""

    def __init__(self, results, timings=None):
        self.results = results = clean(results)
        self.timings = clean(timings)
        self.sessions, self.settings = results["sessions"], results["settings"]
        for setting, summary in zip(self.settings, results["summary"]):
            setting["summary"] = summary
            setting["results"] = [one for one in results["results"] if one["setting"] == setting["name"]]
            setting["sessions"] = {one["session"]: one for one in summary["sessions"]}
        known = json.loads((HERE.parent / "published/tables.json").read_text(encoding="utf-8"))
        self.published = known.get(results["dataset"], {"figures": [], "maps": []})
        self.systems = list(dict.fromkeys(one["system"] for one in results["published_sessions"]))
        self.counts = {key: sum(setting["summary"][key] for setting in self.settings)
                       for key in ("runs", "lost", "failed")}

    def result(self, setting, session):
        return next((one for one in setting["results"] if one["session"] == session["name"]), None)

    def localized(self, setting, session):
        """A setting's summary of a session that has runs, or None."""
        summary = setting["sessions"].get(session["name"])
        return summary if summary and summary["runs"] else None

    def tried(self):
        """Sessions that any setting was to localize."""
        return [session for session in self.sessions
                if any(self.localized(setting, session) for setting in self.settings)]

    def troubles(self):
        """Runs without a good pose, with their session and setting."""
        return [{**run, "session": session["name"], "setting": setting["name"]}
                for session in self.sessions for setting in self.settings
                for run in (self.result(setting, session) or {"runs": []})["runs"] if run["state"] != "ok"]

    def hopeless(self):
        """Sessions that no run of a setting got through."""
        return [f"{one['session']} ({setting['name']})"
                for setting in self.settings for one in setting["summary"]["sessions"]
                if one["runs"] and one["lost"] + one["failed"] == one["runs"]]

    def overview(self):
        """Columns of the settings compared."""
        return [column(key, [setting["summary"]["figures"][key]["largest" if key == "pos_max" else "mean"]
                             for setting in self.settings]) for key in (*SESSION_KEYS, "pos_max")]

    def side_by_side(self):
        return column("pos_mean", [one["figures"]["pos_mean"]["mean"] for setting in self.settings
                                   for one in setting["summary"]["sessions"]])

    def theirs(self, system, summary, key):
        """What a system published for a session that ours was localized in, or None."""
        if not summary["runs"]:
            return None
        return next((one[key] for one in self.results["published_sessions"]
                     if (one["system"], one["session"]) == (system, summary["session"])), None)

    def their_mean(self, system, setting, key):
        """Its mean over the sessions of which ours has a figure as well."""
        return summaries.spread(self.theirs(system, one, key) for one in setting["summary"]["sessions"]
                                if one["figures"]["pos_mean"]["count"])["mean"]

    def sharing(self, setting):
        """The systems that published f_map for sessions of a setting."""
        return [system for system in self.systems if self.their_mean(system, setting, "f_map") is not None]

    def session_columns(self, setting):
        """Columns of the paper's table; ours and theirs decide on the unit."""
        sessions = setting["summary"]["sessions"]
        return [column(key, [one["figures"][key]["mean"] for one in sessions] +
                       [self.theirs(system, one, key) for system in self.systems for one in sessions])
                for key in SESSION_KEYS]

    def session_heads(self, columns, sharing):
        """Heads of the paper's table, and what stands over them where others have columns as well."""
        share = Markup("<i>f</i><sub>map</sub> (%)")
        if not self.systems:
            return [], ["Session", share, *(one.html for one in columns), "Runs"]
        short = {one: one.split(" ")[0] for one in self.systems}
        if len(set(short.values())) < len(short):
            short = {one: one for one in self.systems}
        names = [["this run", *(short[one] for one in systems)] for systems in (sharing, self.systems)]
        over = [(share, len(names[0])), *((one.html, len(names[1])) for one in columns)]
        return [("", 1), *over, ("", 1)], ["Session", *names[0], *(names[1] * len(columns)), "Runs"]

    def compared_columns(self):
        """Columns in which any system published a figure; RMSE in the plane stands beside that per axis."""
        systems = self.published["figures"]
        shown = {key for one in systems for key in one}
        shown |= {"pos_rmse"} if "axis_rmse" in shown else set()
        return [column(key, [one.get(key) for one in systems] +
                       [setting["summary"]["figures"][key]["mean"] for setting in self.settings])
                for key in COLUMNS if key in shown]

    def scored_maps(self):
        """Every scored map, if a setting has several."""
        maps = [one for session in self.sessions for setting in self.settings
                if (one := self.result(setting, session)) and one["map_score"]]
        return maps if any(setting["summary"]["scored_maps"] > 1 for setting in self.settings) else []

    def run_columns(self, setting):
        return [column(key, [run["errors"][key] for one in setting["results"] for run in one["runs"]])
                for key in RUN_KEYS]

    def differences(self):
        """Keys whose values are not the same in all settings, with the values."""
        values = [ini_values(setting["config"]) for setting in self.settings]
        keys = sorted({key for one in values for key in one})
        return [(key, row) for key in keys if len(set(row := [one.get(key) for one in values])) > 1]


def shares(score):
    return [quantities.number(score[key], 3) for key in ("precision", "recall", "f1")]


def scores(map_score):
    """Shares in all ways to count."""
    return [share for way in WAYS for share in shares(map_score[way])]


def runs(counts):
    """10, 1 wrong, 2 failed."""
    text = quantities.count(counts["runs"])
    text += f", {quantities.count(counts['lost'])} wrong" if counts["lost"] else ""
    return text + (f", {quantities.count(counts['failed'])} failed" if counts["failed"] else "")


def sample(setting, maps=False):
    """What the figures of a setting are means of: 2 sessions, runs: 20, 1 wrong. One map of 2 sessions."""
    summary = setting["summary"]
    tried, localized = sum(one["runs"] > 0 for one in summary["sessions"]), summary["localized_sessions"]
    if maps:
        text = quantities.plural(summary["scored_maps"], "map")
    elif tried:
        text = f"{localized} with figures of " * (localized < tried)
        text += f"{quantities.plural(tried, 'session')}, runs: {runs(summary)}"
    else:
        text = "no session localized"
    return sentences(text, setting["protocol"])


def sentences(*texts):
    """Texts that are not empty, each with a full stop, unless it ends in a mark already."""
    return " ".join(text if text[-1] in ".!?" else text + "." for text in texts if text)


def environment(**options):
    made = jinja2.Environment(
        loader=jinja2.FileSystemLoader(HERE), undefined=jinja2.StrictUndefined, extensions=["jinja2.ext.do"],
        trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True, **options)
    for name in ("number", "percent", "metres", "count", "plural", "change", "duration"):
        made.filters[name] = getattr(quantities, name)
    made.filters.update(runs=runs, shares=shares, scores=scores, sample=sample, sentence=sentences)
    made.globals.update(DASH=quantities.DASH, WAYS=WAYS, figures=figures)
    return made


def page(report):
    html = environment(autoescape=True)
    html.globals["style"] = Markup((HERE / "report.css").read_text(encoding="utf-8"))
    return html.get_template("report.html.j2").render(report=report, **vars(report))


def tables(report):
    tex = environment(finalize=quantities.tex, variable_start_string="<<", variable_end_string=">>",
                      block_start_string="<%", block_end_string="%>", comment_start_string="<#",
                      comment_end_string="#>")
    return tex.get_template("table.tex.j2").render(report=report, **vars(report))


def write(folder, texts):
    """Writes all of the files or none, the last one last, also when the power is cut."""
    parts = [folder / (name + ".part") for name in texts]
    try:
        for part, text in zip(parts, texts.values()):
            part.unlink(missing_ok=True)
            with part.open("x", encoding="utf-8", newline="\n") as stream:
                stream.write(text)
                stream.flush()
                os.fsync(stream.fileno())
        for part in parts[:-1]:
            os.replace(part, part.with_suffix(""))
        sync(folder)
        os.replace(parts[-1], parts[-1].with_suffix(""))
        sync(folder)
    finally:
        for part in parts:
            part.unlink(missing_ok=True)


def sync(folder):
    descriptor = os.open(folder, os.O_RDONLY)
    os.fsync(descriptor)
    os.close(descriptor)


def read(file):
    return json.loads(file.read_text(encoding="utf-8"))


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-") or sys.argv[2:] not in ([], ["-"]):
        print(__doc__.split("\n\n")[1], file=sys.stderr)
        return 2
    folder = Path(sys.argv[1])
    timings = folder / "timings.json"
    try:
        written = json.load(sys.stdin.buffer) if sys.argv[2:] else read(folder / "results.json")
        results = summaries.summed_up(written)
        report = Report(results, read(timings) if timings.exists() else None)
        shown = report.results
        write(folder, {"runs.csv": files.runs_csv(shown), "sessions.csv": files.sessions_csv(shown),
                       "maps.csv": files.maps_csv(shown), "table.tex": tables(report),
                       "report.html": page(report), "results.json": files.json_text(results) + "\n"})
    except (OSError, ValueError) as error:
        print(f"report.py: {error}", file=sys.stderr)
        return 1
    except (AttributeError, IndexError, KeyError, TypeError, jinja2.UndefinedError) as error:
        print(f"report.py: {folder}: results.json or timings.json is not as pole-batch writes it "
              f"({type(error).__name__}: {error}); run pole-batch again", file=sys.stderr)
        return 1
    except RecursionError:
        print(f"report.py: {folder}: results.json or timings.json is nested too deeply", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
