"""Results of a batch as text: JSON for scripts, tables as CSV. What does not exist is null or empty."""

import json
import re

from summaries import COUNTS, ERRORS, STATES, WAYS

SCORES = ("precision", "recall", "f1", "matches")


def json_text(value, margin="\n"):
    """Indented by two, but lists of plain values on one line: a path is not a page."""
    def text(one):
        return json.dumps(one, ensure_ascii=False, separators=(",", ":"))

    inner = margin + "  "
    if value and isinstance(value, dict):
        parts = [f"{text(key)}: {json_text(one, inner)}" for key, one in value.items()]
    elif isinstance(value, list) and any(isinstance(one, (dict, list)) for one in value):
        parts = [json_text(one, inner) for one in value]
    else:
        return text(value)
    first, last = "{}" if isinstance(value, dict) else "[]"
    return first + inner + ("," + inner).join(parts) + margin + last


def field(value):
    """A field, in quotes where it needs them; one line, for readers that go line by line."""
    if value is None:
        return ""
    if isinstance(value, float):
        return f"{value:.9g}"
    text = re.sub("[\r\n]", " ", str(value))
    if text == text.strip(" ") and not re.search('[,"#]', text):
        return text
    return '"' + text.replace('"', '""') + '"'


def table(*rows):
    return "".join(",".join(map(field, row)) + "\n" for row in rows)


def runs_csv(results):
    """One row for each run."""
    head = ["setting", "session", "run", "seed", "state", "reason", *ERRORS, "poses", "unmatched",
            *(f"{state}_share" for state in STATES), "first_pose_scan", "relocalizations"]
    return table(head, *(
        [one["setting"], one["session"], run["run"], run["seed"], run["state"], run["failure"],
         *(run["errors"][key] for key in (*ERRORS, "poses", "unmatched")),
         *(run["health"][key] for key in (*STATES, "first_pose_scan", "relocalizations"))]
        for one in results["results"] for run in one["runs"]))


def sessions_csv(results):
    """One row for each session under each setting: mean and standard deviation over its runs."""
    spreads, shares = (*ERRORS, "axis_rmse"), [f"{state}_share" for state in STATES]
    head = ["setting", "session", "date", "length_m", "scans", "f_map", "map_poles", *COUNTS]
    head += [name for key in spreads for name in (key, key + "_sd")]
    rows = [[*head, *shares, "relocalizations"]]
    sessions = {one["name"]: one for one in results["sessions"]}
    for setting in results["summary"]:
        for one in setting["sessions"]:
            session, figures = sessions[one["session"]], one["figures"]
            rows.append([
                setting["setting"], one["session"], session["date"], session["length_m"], session["scans"],
                one["f_map"], one["map_poles"] if one["runs"] else None, *(one[key] for key in COUNTS),
                *(figures[key][part] for key in spreads for part in ("mean", "deviation")),
                *(figures[key]["mean"] for key in shares), one["relocalizations"]])
    return table(*rows)


def maps_csv(results):
    """One row for each map that was scored; without any, the header alone."""
    head = ["setting", "session", "truth", "map_poles", "truth_poles",
            *(f"{way}_{key}" for way in WAYS for key in SCORES)]
    return table(head, *(
        [one["setting"], one["session"], score["truth"], score["near_1m"]["map_poles"],
         score["near_1m"]["truth_poles"], *(score[way][key] for way in WAYS for key in SCORES)]
        for one in results["results"] if (score := one["map_score"])))
