"""Numbers for the marks of pages: the outputs of commands, and what templates in scripts/parts may use of them."""

import csv
import io
import json
import math
import re
import statistics


class Fields(dict):
    """A JSON object whose members are attributes."""

    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"no member '{name}'; there are {', '.join(self)}") from None


def row_at(table, orbit):
    """The row of a series nearest to an orbit."""
    index = min(range(len(table.time_orbits)), key=lambda k: abs(table.time_orbits[k] - orbit))
    return Fields({name: column[index] for name, column in table.items()})


def maxima(table, column):
    """The (orbit, value) of each local maximum of a column."""
    values = table[column]
    return [(table.time_orbits[k], values[k]) for k in range(1, len(values) - 1) if values[k - 1] < values[k] >= values[k + 1]]


def between(table, column, begin, end):
    """The values of a column from one orbit to another."""
    return [value for orbit, value in zip(table.time_orbits, table[column]) if begin - 1e-9 <= orbit <= end + 1e-9]


def distance(table):
    """Between the first two particles of a table, whose box is wider than the pair."""
    return math.dist(*((table.x_m[k], table.y_m[k], table.z_m[k]) for k in (0, 1)))


def find(pattern, text):
    """The number that a pattern's first group finds in a text."""
    found = re.search(pattern, text, re.M)
    if not found:
        raise ValueError(f"nothing like '{pattern}' in: {text[:300]}")
    return float(found[1])


def listed(values, form):
    """Numbers in words: 1, 2 and 3."""
    words = [format(value, form) for value in values]
    return f"{', '.join(words[:-1])} and {words[-1]}"


def ratios(points, form):
    """Of each value to the one before."""
    return listed([b / a for (_, a), (_, b) in zip(points, points[1:])], form)


def words(count):
    return ("no", "one", "two", "three", "four", "five", "six")[int(count)] if count < 7 else str(count)


def r_omega(analysis):
    """r Ω in m/s."""
    return analysis.dispersion_m_s[0] / analysis.dispersion_r_omega[0]


HELPERS = {f.__name__: f for f in (row_at, maxima, between, distance, find, listed, ratios, words, r_omega)} | {"mean": statistics.fmean}


def number(text):
    try:
        return float(text)
    except ValueError:
        return text


def parsed(output):
    """A step's output: a JSON object, a table of comma-separated columns, or text."""
    if output.startswith("{"):
        return json.loads(output, object_hook=Fields)
    lines = [line for line in output.splitlines() if not line.startswith("#")]
    if lines and re.fullmatch(r"[\w.]+(,[\w.]+)+", lines[0]):
        rows = list(csv.reader(io.StringIO("\n".join(lines))))
        return Fields({name: [number(row[k]) for row in rows[1:]] for k, name in enumerate(rows[0])})
    return output


def printed(template, results):
    """A template of Python's f-strings, with a minus sign in place of a hyphen."""
    text = eval("f'''" + template + "'''", dict(HELPERS), results)  # pylint: disable=eval-used
    return re.sub(r"(?<!\w)-(?=\d)", "−", text)
