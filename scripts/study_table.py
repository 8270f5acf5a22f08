#!/usr/bin/env python3
"""The table of a page, of the settings.csv that `keeler study step`, `kicks`, `mesh`, `box` or `sizes` wrote.

    study_table.py DIR/settings.csv TITLE COLUMN...

TITLE heads the column of the settings. A COLUMN is NAME:FORMAT:TITLE, the mean over the seeds in Python's format; NAME+:FORMAT:TITLE has
the bound beside it, and NAME%:FORMAT:TITLE is the difference from the reference in per cent with its bound, bold beyond the scatter.
"""

import csv
import sys


def setting_name(setting):
    """A setting as pages call it: "kick-0.001" is 1/1000 orbit, "fft-0.002" is `fft` 2e-3."""
    kind, _, value = setting.partition("-")
    if kind in ("step", "kick"):
        if value == "auto":
            return '`"auto"`'
        thousandths = 1000 * float(value)
        return f"{thousandths:g}/1000" if thousandths >= 1 else f"1/{1 / float(value):g}"
    if kind in ("fft", "tree", "mesh", "direct"):
        return f"`{kind}` {value}".rstrip()
    return {"whole": "whole", "equal": "equal, ⟨r³⟩/⟨r²⟩"}.get(kind, value)


def cell(row, name, form):
    base = name.rstrip("+%")
    if name.endswith("%"):
        difference, bound = row[base + "_difference_percent"], row[base + "_difference_bound_percent"]
        if not difference:
            return ""
        text = f"{float(difference):+{form}} ± {float(bound):{form}}".replace("-", "−")
        return f"**{text}**" if abs(float(difference)) > float(bound) else text
    if not row[base]:
        return ""
    bound = f" ± {float(row[base + '_bound']):{form}}" if name.endswith("+") else ""
    return f"{float(row[base]):{form}}{bound}"


def main(path, title, *columns):
    columns = [column.split(":", 2) for column in columns]
    print("| " + " | ".join([title] + [text for _, _, text in columns]) + " |")
    print("|---" * (1 + len(columns)) + "|")
    with open(path, newline="") as table:
        for row in csv.DictReader(table):
            print("| " + " | ".join([setting_name(row["setting"])] + [cell(row, name, form) for name, form, _ in columns]) + " |")


main(*sys.argv[1:])
