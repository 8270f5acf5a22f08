"""docs/reliability.md: the table, and what its words mean."""

HEAD = """# Harmed on purpose

What becomes of runs and their files when machines and people do their worst. Written by `scripts/test --faults`, which tries all
of it again from outside the program; moments and places are drawn at random, with a fixed seed for all but the clock. A run that
was harmed is brought to its end, by `keeler resume` or, where it had no checkpoint yet, by starting again, and then held against the same
run without harm: state, series, snapshots and log of contacts must be equal bit for bit.

"""

TAIL = """
| column | counts trials in which |
|---|---|
| lost | something that was on disk is gone, in silence, or a run that could go on does not |
| wrong | a result differs in a bit, a damaged file is taken for a whole one, output is in two places, parts of files are left, the exit code is another than the manual's, or a failure is not one line of at most 2000 bytes |
| crashes | a signal that nobody sent ends the program, or a library or the C++ runtime speaks in its place |
| hangs | a command takes longer than 20 seconds, under mpirun 60; none of them needs one, and mpirun 7 to miss a host whose cable was cut |

Snapshots, checkpoints and files of contacts are [sealed](formats.md#the-seal): no damage of theirs may give other values. Texts and
snapshots that other programs wrote have no seal. There a changed digit is a value like others, which nothing can tell;
only the refusal of what is no value, and the manner of it, is tried.

Where a rank or a host is lost mpirun ends the others, with an exit code and words of its own, which are not judged. A host whose cable
is cut says nothing, and mpirun's default is to wait for it 8 minutes; here it was told to wait 6 s ([how](manual/ranks.md#when-a-host-vanishes)).

Disks that lie about what they have written, and the loss of power, are not tried: a checkpoint is forced to disk before the one
before the last is removed, and what a disk says is believed.
"""

COLUMNS = ["fault", "how", "tried", "lost", "wrong", "crashes", "hangs"]


def _line(cells):
    return "| " + " | ".join(cells) + " |\n"


def _rows_in(text):
    """Cells of the rows of a page, by their titles."""
    rows = [line.strip("| \n").split(" | ") for line in text.splitlines() if line.startswith("| ")]
    return {cells[0]: cells for cells in rows if len(cells) == len(COLUMNS)}


def _number(cell):
    return int(cell.replace(",", "")) if cell[0].isdigit() else 0


def table(rows):
    sums = [f"{sum(_number(cells[column]) for cells in rows):,}" for column in range(2, len(COLUMNS))]
    return "".join(map(_line, [COLUMNS, ["---"] * len(COLUMNS), *rows, ["all", "", *sums]]))


def written(titles, measured, before):
    """The page. A row that was not measured stays as it was before."""
    known = {**_rows_in(before), **{cells[0]: cells for cells in measured}}
    return HEAD + table([known[title] for title in titles if title in known]) + TAIL
