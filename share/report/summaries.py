"""Figures of a batch summed up: over the runs of a session, and over the sessions of a setting."""

import functools
import math
import operator

ERRORS = ("pos_mean", "pos_rmse", "pos_max", "pos_end", "lat_mean", "lat_std", "lon_mean", "lon_std",
          "x_rmse", "y_rmse", "ang_mean_deg", "ang_std_deg", "ang_rmse_deg")
STATES = ("ok", "degraded", "lost")
FIGURES = (*ERRORS, "axis_rmse", *(f"{state}_share" for state in STATES))
COUNTS = ("runs", "lost", "failed")
WAYS = ("near_1m", "one_to_one_1m", "one_to_one_0.5m")  # to count the score of a map


def total(values):
    """Added one by one: sum() gives other last digits from Python 3.12 on."""
    return functools.reduce(operator.add, values, 0.0)


def spread(values):
    """Mean, standard deviation of the sample (n - 1), largest and number of the values that exist."""
    known = [value for value in values if value is not None]
    count, mean, deviation = len(known), None, None
    if count > 0:
        mean = total(known) / count
    if count > 1:
        deviation = math.sqrt(total((value - mean) * (value - mean) for value in known) / (count - 1))
    return {"mean": mean, "deviation": deviation, "largest": max(known, default=None), "count": count}


def figures(run):
    """The figures of a run that are summed up. axis_rmse is the position RMSE per axis, as MulRan has it."""
    errors, health = run["errors"], run["health"]
    x, y = errors["x_rmse"], errors["y_rmse"]
    axis = None if x is None or y is None else math.sqrt((x * x + y * y) / 2)
    return dict(zip(FIGURES, [*(errors[key] for key in ERRORS), axis, *(health[state] for state in STATES)]))


def session_summary(result):
    """A session under a setting, over its runs; lost runs with a pose count in all figures."""
    states = [run["state"] for run in result["runs"]]
    runs = [run for run in result["runs"] if run["state"] != "failed"]
    known = [figures(run) for run in runs]
    return {"session": result["session"], "f_map": result["f_map"], "map_poles": result["map_poles"],
            "runs": len(states), "lost": states.count("lost"), "failed": states.count("failed"),
            "relocalizations": spread(run["health"]["relocalizations"] for run in runs)["mean"],
            "figures": {key: spread(one[key] for one in known) for key in FIGURES}}


def over_sessions(spreads):
    """Every session has the same weight, as in the paper. `largest` is that of all runs."""
    return {**spread(one["mean"] for one in spreads),
            "largest": spread(one["largest"] for one in spreads)["largest"]}


def setting_summary(name, results):
    """A setting over its sessions: `results` in the order of the batch."""
    sessions = [session_summary(one) for one in results]
    localized = [one for one in sessions if one["runs"]]
    means = [one["figures"]["pos_mean"]["mean"] for one in sessions if one["figures"]["pos_mean"]["count"]]
    scores = [one["map_score"] for one in results if one["map_score"]]
    return {
        "setting": name, **{key: sum(one[key] for one in sessions) for key in COUNTS},
        "localized_sessions": len(means),
        "lost_sessions": sum(one["lost"] + one["failed"] == one["runs"] for one in localized),
        "last_over_first": means[-1] / means[0] if len(means) > 1 and means[0] > 0 else None,
        "f_map": spread(one["f_map"] for one in localized or sessions),
        "scored_maps": len(scores),
        "map_score": {way: {key: spread(score[way][key] for score in scores)["mean"]
                            for key in ("precision", "recall", "f1")} for way in WAYS},
        "figures": {key: over_sessions([one["figures"][key] for one in sessions]) for key in FIGURES},
        "sessions": sessions}


def summed_up(results):
    """The results with `summary`, which has one entry for each setting, before the longest part."""
    rest = {key: value for key, value in results.items() if key not in ("summary", "results")}
    rest["summary"] = [
        setting_summary(setting["name"],
                        [one for one in results["results"] if one["setting"] == setting["name"]])
        for setting in results["settings"]]
    return {**rest, "results": results["results"]}
