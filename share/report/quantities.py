"""Figures as text: always the same decimals, a dash for what does not exist."""

import math

from markupsafe import Markup

DASH, NO_BREAK, THIN = "\u2013", "\u00a0", "\u2009"
SHORT = 0.1  # m; a column with shorter lengths is in centimetres
TEX_SYMBOLS = {"Δ": r"\Delta", "σ": r"\sigma", "RMSE": r"\mathrm{RMSE}"}
TEX_LETTERS = {
    "\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
    "<": r"\textless{}", ">": r"\textgreater{}", "|": r"\textbar{}", DASH: "--",
    "\n": " ", "\r": " ", "\t": " ", **{letter: "\\" + letter for letter in "{}%$#&_"},
}


def number(value, decimals):
    """0.174 as "0.174"; zero has no sign."""
    if value is None or not math.isfinite(value):
        return DASH
    text = f"{value:.{decimals}f}"
    return text if text.strip("-0.") else text.lstrip("-")


def percent(share):
    return number(None if share is None else 100 * share, 1)


def centimetres(length):
    """Two significant digits below 10 cm, tenths of a centimetre above."""
    value = 100 * length
    if abs(length) >= SHORT or value == 0:
        return number(value, 1)
    return number(value, min(max(1 - int(f"{value:.1e}".split("e")[1]), 0), 3))


def metres(value, space=NO_BREAK):
    """A single length: 0.0072 m is "0.72 cm", 5.48 m "5.480 m"."""
    if value is None or abs(value) >= 1:
        return number(value, 3) + space + "m"
    return centimetres(value) + space + "cm"


def count(value):
    """12345 with a thin space between thousands."""
    return str(value) if value < 10000 else f"{value:,}".replace(",", THIN)


def plural(value, word):
    return f"{count(value)} {word}{'' if value == 1 else 's'}"


def change(ratio):
    """1.08 as "+8 %", 0.97 as "−3 %", 17 as "17 times"."""
    if ratio is None:
        return DASH
    if ratio >= 3:  # from there on, per cent are hard to read
        return number(ratio, 1 if ratio < 10 else 0) + " times"
    text = number(abs(100 * (ratio - 1)), 0)
    return ("±" if text == "0" else "+" if ratio > 1 else "\u2212") + text + " %"


def duration(seconds):
    """12 s, 3 min 20 s, 2 h 5 min."""
    if seconds is None or seconds < 9.95:
        return number(seconds, 1) + ("" if seconds is None else " s")
    whole = int(seconds + 0.5)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"


def tex(text):
    """Text as LaTeX shows it letter by letter."""
    if isinstance(text, Markup):
        return text
    parts, before = [], ""
    for letter in str(text):
        # Two of these would join: -- to a dash, '' to a quotation mark.
        if letter == before and letter in "-'`":
            parts.append("{}")
        parts.append(TEX_LETTERS.get(letter, letter))
        before = letter
    return "".join(parts)


class Column:
    """A column of errors, all in one unit: centimetres if any length is below 0.1 m, else metres."""

    def __init__(self, symbol, index, key, values):
        self.symbol, self.index, self.key = symbol, index, key
        short = any(value is not None and abs(value) < SHORT for value in values)
        self.unit = "°" if key.startswith("ang") else "cm" if short else "m"

    @property
    def html(self):
        index = f"<sub>{self.index}</sub>" if self.index else ""
        return Markup(f"{self.symbol}{index} ({self.unit})")

    @property
    def tex(self):
        unit = r"$^\circ$" if self.unit == "°" else self.unit
        return Markup(rf"${TEX_SYMBOLS[self.symbol]}_\mathrm{{{self.index}}}$ [{unit}]")

    def text(self, value):
        return centimetres(value) if self.unit == "cm" and value is not None else number(value, 3)

    def html_spread(self, spread):
        if spread["deviation"] is None:
            return self.text(spread["mean"])
        return Markup('{}<span class="sd"> ± {}</span>').format(
            self.text(spread["mean"]), self.text(spread["deviation"]))

    def tex_spread(self, spread):
        if spread["deviation"] is None:
            return self.text(spread["mean"])
        return Markup(rf"${self.text(spread['mean'])} \pm {self.text(spread['deviation'])}$")
