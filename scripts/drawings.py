#!/usr/bin/env python3
"""Draws the figures of docs/dev: geometry and time of the algorithms, and the folders of the source tree.

  scripts/drawings.py            writes docs/dev/drawings/*.svg
  scripts/drawings.py --check    exit 1 where a file there is not what this script draws

Each drawing has a panel of its own in the colours that the reader's system asks for, so it is readable in a light and in
a dark page. The folders and their arrows are read from the CMake lists."""
import pathlib
import re
import sys
from xml.sax.saxutils import escape

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ROOT / "docs/dev/drawings"
STYLE = """
  .panel { fill: #ffffff; stroke: #c8ccd4 }
  text { font: 13px sans-serif; fill: #20242c }
  .small { font-size: 11px }
  .faint { fill: #687080 }
  .line { stroke: #20242c; fill: none }
  .thin { stroke: #9098a8; fill: none }
  .dash { stroke-dasharray: 5 4 }
  .a { fill: #2a6fb0; stroke: none } .sa { stroke: #2a6fb0; fill: none; stroke-width: 2 }
  .b { fill: #c8641e; stroke: none } .sb { stroke: #c8641e; fill: none; stroke-width: 2 }
  .pa { fill: #d5e5f5; stroke: #2a6fb0 }
  .pb { fill: #f8e3d2; stroke: #c8641e }
  .pc { fill: #eceef2; stroke: #9098a8 }
  @media (prefers-color-scheme: dark) {
    .panel { fill: #16191f; stroke: #3a404c }
    text { fill: #e4e7ee } .faint { fill: #98a0b0 }
    .line { stroke: #e4e7ee } .thin { stroke: #687080 }
    .a { fill: #6fb0ee } .sa { stroke: #6fb0ee } .b { fill: #f09a58 } .sb { stroke: #f09a58 }
    .pa { fill: #1d3550; stroke: #6fb0ee } .pb { fill: #4a2c14; stroke: #f09a58 } .pc { fill: #262b34; stroke: #687080 }
  }"""


class Drawing:
    """An SVG with y downward, in pixels."""

    def __init__(self, title, width, height):
        self.parts = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img">',
            f"<title>{escape(title)}</title>",
            f"<style>{STYLE}\n</style>",
            '<defs><marker id="head" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto-start-reverse">'
            '<path d="M0 0L8 4L0 8z" fill="context-stroke"/></marker></defs>',
            f'<rect class="panel" x="0.5" y="0.5" width="{width - 1}" height="{height - 1}" rx="6"/>']

    def line(self, x1, y1, x2, y2, look="line", head=False):
        marker = ' marker-end="url(#head)"' if head else ""
        self.parts.append(f'<line class="{look}" x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"{marker}/>')

    def path(self, points, look="line", close=False, head=False):
        marker = ' marker-end="url(#head)"' if head else ""
        d = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points) + ("z" if close else "")
        self.parts.append(f'<path class="{look}" d="{d}"{marker}/>')

    def rect(self, x, y, width, height, look="line", radius=0):
        self.parts.append(f'<rect class="{look}" x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" rx="{radius}"/>')

    def dot(self, x, y, radius=4, look="a"):
        self.parts.append(f'<circle class="{look}" cx="{x:.1f}" cy="{y:.1f}" r="{radius}"/>')

    def text(self, x, y, words, anchor="start", look=""):
        self.parts.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" class="{look}">{escape(words)}</text>')

    def box(self, x, y, width, height, words, look="pc"):
        self.rect(x, y, width, height, look, 3)
        self.text(x + width / 2, y + height / 2 + 4.5, words, "middle")

    def lines(self, x, y, words):
        for k, line in enumerate(words):
            self.text(x, y + 19 * k, line, "start", "small")

    def svg(self):
        return "\n".join(self.parts + ["</svg>", ""])


def sheared_images():
    d = Drawing("The box, its sheared images, and the nearest image of a particle", 760, 470)
    width, height, shear = 150, 110, 38
    left, top = 160, 185
    for n in (-1, 0, 1):
        for m in (-1, 0, 1):
            x, y = left + n * width, top + n * shear - m * height
            d.rect(x, y, width, height, "pa" if (n, m) == (0, 0) else "thin")
            d.dot(x + 14, y + 62, 4, "b" if (n, m) != (0, 0) else "a")
            if (n, m) != (0, 0):
                d.text(x + width - 6, y + 16, f"({n}, {m})".replace("-", "−"), "end", "small faint")
    i, j = (left + width - 16, top + 78), (left + 14, top + 62)
    image = (j[0] + width, j[1] + shear - height)
    nearest = (j[0] + width, j[1] + shear)
    d.dot(*i, 4, "a")
    d.text(i[0] - 8, i[1] - 8, "i", "end")
    d.text(j[0] + 8, j[1] - 6, "j")
    d.line(*i, *j, "thin dash")
    d.line(*i, *image, "thin dash")
    d.line(*i, nearest[0] - 4, nearest[1] - 1, "sb", True)
    d.text(nearest[0] + 9, nearest[1] + 5, "nearest image of j")
    d.line(left + width + 4, top, left + width + 4, top + shear, "line", True)
    d.text(left + width + 10, top + 14, "d", "start")
    d.lines(478, 60, (
            "The image (n, m) of a particle at (x, y) is at", "(x + n L_x, y + m L_y − n d), with the velocity",
            "of its own radius: v_y − n S L_x.", "",
            "d = S L_x t modulo L_y: the shear offset.", "The columns slide; the box in the middle is fixed.", "",
            "The nearest image of j: n brings it within half a", "side in x, then m in y. It is the only one",
            "that can touch i while both radii and both paths", "together reach less than half a side."))
    d.line(20, 450, 80, 450, "line", True)
    d.text(86, 454, "x, away from the planet")
    d.line(20, 450, 20, 395, "line", True)
    d.text(30, 402, "y, along the orbit")
    return d


def neighbour_lists():
    d = Drawing("Lifetimes of the neighbour lists, and the skin about a reference path", 760, 500)
    begin, step, steps = 190, 44, 12
    rows = {"list lifetime": 60, "pruning intervals": 100, "steps": 140, "particle i": 190}
    for words, y in rows.items():
        d.text(begin - 14, y + 16, words, "end")
    d.rect(begin, rows["list lifetime"], steps * step, 24, "pa", 3)
    d.text(begin + steps * step / 2, 77, "reference paths and Verlet lists of all particles", "middle", "small")
    for k in range(3):
        d.rect(begin + 4 * k * step, rows["pruning intervals"], 4 * step - 3, 24, "pb", 3)
        d.text(begin + (4 * k + 2) * step, 117, "present lines, pruned pairs", "middle", "small")
    for k in range(steps):
        d.rect(begin + k * step, rows["steps"], step - 3, 24, "pc", 2)
    for k in range(4):
        x = begin + 4 * k * step
        d.line(x, 48, x, 228, "thin dash")
        d.text(x, 42, "kick", "middle", "small faint")
    hit = begin + 5.4 * step
    d.rect(begin, rows["particle i"], steps * step, 24, "pc", 3)
    d.rect(hit, rows["particle i"], 2.6 * step, 24, "pb", 3)
    d.text(hit + 1.3 * step, 206, "dirty: whole list", "middle", "small")
    d.line(hit, 236, hit, 216, "sb", True)
    d.text(hit + 30, 250, "hit: a new line; its list is kept", "end", "small")
    leave = begin + 9.5 * step
    d.rect(leave, rows["particle i"], 2.5 * step, 24, "pa", 3)
    d.text(leave + 1.25 * step, 206, "new list", "middle", "small")
    d.line(leave, 236, leave, 216, "sa", True)
    d.text(leave - 100, 250, "leaves its skin: new reference, new list", "start", "small")
    # the skin
    def centre(t):
        return 120 + 520 * t, 400 - 55 * t
    d.path([(x, y - 36) for x, y in (centre(0), centre(1))] + [(x, y + 36) for x, y in (centre(1), centre(0))], "pc", True)
    d.line(*centre(0), *centre(1), "line dash")
    def path(t):
        x, y = centre(t)
        return x, y + 26 - 95 * t * (1 - t) * 1.6 - (0 if t < 0.62 else 330 * (t - 0.62) ** 1.25)
    d.path([path(k / 60) for k in range(54)], "sa")
    d.dot(*path(37 / 60), 5, "b")
    d.text(path(37 / 60)[0] - 6, path(37 / 60)[1] - 12, "hit", "end", "small")
    d.text(660, 352, "reference path", "start", "small")
    d.line(114, 400, 114, 364, "line", True)
    d.text(106, 386, "skin", "end", "small")
    d.text(532, 282, "a new reference path is due here", "start", "small")
    d.line(560, 288, 545, 313, "thin", True)
    d.lines(120, 460, ("Two particles are on each other's list if their reference paths come within both radii and both skins",
                       "during the lifetime of the lists."))
    return d


def contact_domains():
    d = Drawing("Domains of the contact loop: blocks, blocks shifted twice, and the whole box", 960, 360)
    side, half, top = 200, 50, 46
    lefts = (25, 261, 497, 733)
    for left, words in zip(lefts, ("round 1: blocks", "round 2: shifted by half a block", "round 3: by a quarter", "last round: the whole box")):
        d.text(left + side / 2, 30, words, "middle")
        d.rect(left, top, side, side, "pc", 2)
    for k in (0, 1):
        for m in (0, 1):
            if k != m:
                d.rect(lefts[0] + 2 * k * half, top + 2 * m * half, 2 * half, 2 * half, "pa")
    for left, shift in ((lefts[1], 1.0), (lefts[2], 0.5)):
        shifted = ((0, 2 - shift), (2 - shift, 2), (4 - shift, shift))  # begin and width along one side, of the box
        for k, (x, wide) in enumerate(shifted):
            for m, (y, high) in enumerate(shifted):
                if k % 2 != m % 2:
                    d.rect(left + x * half, top + y * half, wide * half, high * half, "pa")

    def contact(x, y, look):
        d.dot(x - 5, y, 5, look)
        d.dot(x + 5, y, 5, look)

    def in_rounds(x, y, carried_out):
        for k, left in enumerate(lefts):
            if k <= carried_out:
                contact(left + x * half, top + y * half, "a" if k == carried_out else "b")

    for x, y in ((0.8, 0.9), (3.2, 1.1), (1.1, 3.2), (2.8, 2.7)):
        in_rounds(x, y, 0)
    in_rounds(2.0, 2.4, 1)
    in_rounds(1.4, 2.05, 1)
    in_rounds(2.0, 0.98, 2)
    in_rounds(3.25, 3.25, 3)
    d.lines(25, 278, (
        "A contact is carried out (blue) if its domain owns both particles and all particles on their lists. Otherwise it is deferred",
        "(orange), with all later contacts of its two particles. Edges of the first two rounds cross in the middle parts of the third's blocks.",
        "A hit that leaves its skin goes on to the last round. If a deferred contact disturbs one that an earlier round has carried out, that one is rolled back."))
    return d


def kick_drift_kick():
    d = Drawing("Kick, drift, kick, and the impulses of contacts at rest", 760, 330)
    left, length = 90, 270
    y = 150
    d.line(left - 30, y, left + 2 * length + 60, y, "line", True)
    d.text(left + 2 * length + 66, y + 4, "t")
    for k in range(3):
        x = left + k * length
        for side, look in ((-1, "pa"), (1, "pb")):
            if (k, side) in ((0, -1), (2, 1)):
                continue
            d.rect(x + (side - 1) * 17, y - 62, 34, 56, look, 2)
            d.text(x + side * 17, y - 40, "½ g", "middle", "small")
            d.text(x + side * 17, y - 18, "½ λ", "middle", "small")
        d.line(x, y - 78, x, y + 12, "thin dash")
    d.text(left, y - 86, "kick", "middle")
    d.text(left + length, y - 86, "kick", "middle")
    d.text(left + 2 * length, y - 86, "kick", "middle")
    for k in range(2):
        x = left + k * length
        d.text(x + length / 2, y - 44, "drift on epicycles", "middle")
        for s in range(1, 3):
            d.line(x + s * length / 3, y - 5, x + s * length / 3, y + 5)
        for s, c in enumerate((0.27, 0.45, 0.52, 0.81)):
            d.dot(x + c * length, y, 4, "b")
        d.path([(x + 4, y + 20), (x + 4, y + 28), (x + length - 4, y + 28), (x + length - 4, y + 20)], "thin")
        d.text(x + length / 2, y + 45, f"kick interval {k + 1}: kick_every = 3 steps", "middle", "small")
    d.lines(40, 240, (
            "g: the kick by all forces over the interval, half at its begin (orange) and half at its end (blue).",
            "λ: impulses of contacts at rest, found at the interval's begin so that the pairs touch again at its end; half at each end too.",
            "Dots: contacts, carried out at their own instants within the drift. Ticks: steps, the spans of one search for contacts."))
    return d


def blocks():
    d = Drawing("Blocks of seven ranks, and the ghosts of one of them", 760, 490)
    left, top, width, height = 60, 50, 640, 250
    low, high, above, below = 250, 510, 125, 225  # sides of the block of rank 3
    d.rect(left, top, width, height, "pc")
    d.rect(low - 36, above - 40, high - low + 72, below - above + 80, "pb")
    d.rect(low - 64, above - 68, high - low + 128, below - above + 136, "sb dash")
    d.rect(low, above, high - low, below - above, "pa")
    for x in (low, high):
        d.line(x, top, x, top + height)
    for start, end, y in ((left, low, 155), (low, high, above), (low, high, below), (high, left + width, 190)):
        d.line(start, y, end, y)
    for k, (x, y) in enumerate(((105, 240), (105, 105), (440, 258), (380, 158), (440, 112), (655, 255), (655, 120))):
        d.text(x, y, f"rank {k}", "middle")
    d.text(380, 190, "references of own particles", "middle", "small")
    for k, x in enumerate((155, 380, 605)):
        d.text(x, top - 12, f"strip {k}", "middle")
    d.dot(low + 12, 165, 5, "a")
    d.line(low + 12, 165, low - 14, 172, "sa", True)
    d.dot(high + 18, 160, 5, "b")
    d.line(high + 18, 160, high - 4, 152, "sb", True)
    d.line(left + width + 14, top + height, left + width + 14, top + height - 50, "line", True)
    d.text(left + width + 22, top + height - 42, "y")
    d.line(left, top + height + 16, left + 50, top + height + 16, "line", True)
    d.text(left + 58, top + height + 20, "x")
    for x, look, words in ((200, "pa", "block of rank 3"), (350, "pb", "near ghosts"), (480, "sb dash", "outer ghosts: 8 rows of spheres")):
        d.rect(x, top + height + 10, 24, 12, look)
        d.text(x + 32, top + height + 20, words, "start", "small")
    d.lines(left, 354, (
        "A particle belongs to the block in which its reference was when the ghost layer was built, wherever it is now. While no",
        "own particle is farther from its reference than the margin along x or two margins along y, it can touch only own particles",
        "and near ghosts. Outer ghosts make the near ones' histories right: a wrong path can reach them only through a chain of",
        "contacts within one step, which is noticed, and the step is repeated. Rank 3 has ghosts of ranks 0 to 6 here, and across the",
        "edges of the box too where they are within its reach. Across the sheared edge in x the blocks meet as they lie when the",
        "layer is built."))
    return d


def transform_layout():
    d = Drawing("Layout of the half spectrum between the transforms along y and x", 760, 394)
    left, top = 60, 70
    width, wave, plane = 200, 38, 11
    for b in range(3):
        x = left + b * (width + 14)
        d.rect(x, top, width, 3 * wave + 8, "pc", 3)
        d.text(x + width / 2, top - 10, f"block {b}: columns {8 * b} … {8 * b + 7}", "middle")
        for m in range(3):
            y = top + 4 + m * wave
            d.rect(x + 4, y, width - 8, wave - 3, "pa" if m == 1 else "panel", 2)
            d.text(x + 12, y + 22, f"k_y = {m}", "start", "small")
            for k in range(2):
                d.rect(x + 62, y + 4 + k * 15, 128, 12, "pb" if (m, k) == (1, 1) and b == 1 else "thin")
                for c in range(1, 8):
                    d.line(x + 62 + c * 16, y + 4 + k * 15, x + 62 + c * 16, y + 16 + k * 15, "thin")
    x, y = left + width + 14 + 62, top + 4 + wave + 4 + 15
    d.line(x + 64, y + 12, x + 64, 222, "sb")
    d.text(x + 64, 238, "one plane z of one wave: 8 neighbouring columns, a cache line of complex floats", "middle", "small")
    d.text(left, 272, "address = block × length of a block + (k_y × planes + z) × 8 + column within the block", "start")
    d.lines(left, 300, (
            "The transform along y fills columns; the turn by −k_y d x / L_x and the transform along x read one wave through all blocks.",
            "Over ranks, a rank's columns begin a block of their own. So what one rank sends another, some waves of all its blocks (blue),",
            "is a set of equal runs at equal distances, which MPI takes from where they are and puts where they belong, without packing.",
            "A block is where its eight columns of the mesh were, and a little shorter. A rank's waves of all columns are an array of",
            "their own, without gaps."))
    return d


def folders():
    """Returns the folders, lowest first, and the set of folders that each uses directly."""
    names = re.search(r"set\(KEELER_FOLDERS ([^)]*)\)", (ROOT / "CMakeLists.txt").read_text())[1].split()
    uses = {}
    for name in names:
        text = next(path for top in ("src", "lab") if (path := ROOT / top / name / "CMakeLists.txt").exists()).read_text()
        used = re.findall(r"\bUSES\b((?:\s+[a-z_]+\b)+)", text) or [" ".join(re.findall(r"keeler::([a-z_]+)", text))]
        uses[name] = set(used[0].split()) & set(names)
    return names, uses


def past(boxes, begin, end):
    """Returns a curve from begin to end, bent sideways as little as it must be to cross none of (x, y, half width)."""
    (x1, y1), (x2, y2) = begin, end
    for bend in sorted(range(-400, 401, 20), key=abs):
        at = [k / 24 for k in range(25)]
        curve = [(x1 + (x2 - x1) * t + 4 * bend * t * (1 - t), y1 + (y2 - y1) * t) for t in at]
        if not any(abs(x - bx) < half + 6 and by - 4 < y < by + 30 for x, y in curve for bx, by, half in boxes):
            return curve if bend else [begin, end]
    return [begin, end]


def house():
    names, uses = folders()
    below = {}  # all that a folder reaches
    for name in names:
        below[name] = set(uses[name]).union(*(below[used] for used in uses[name])) if uses[name] else set()
    direct = {name: {u for u in uses[name] if not any(u in below[v] for v in uses[name])} for name in names}
    level = {}
    for name in names:
        level[name] = 1 + max((level[used] for used in uses[name]), default=-1)
    rows = [[n for n in names if level[n] == k] for k in range(max(level.values()) + 1)]
    across = {n: (i + 0.5) / len(row) for row in rows for i, n in enumerate(row)}
    for _ in range(8):  # towards the mean of what each is joined to, row by row
        for row in rows:
            def mean(n):
                joined = [across[u] for u in direct[n]] + [across[v] for v in names if n in direct[v]]
                return sum(joined) / len(joined) if joined else across[n]
            row.sort(key=lambda n: (round(mean(n), 9), n))
            for i, n in enumerate(row):
                across[n] = (i + 0.5) / len(row)
    width, step = 860, 62
    d = Drawing("The folders and what each includes", width, 70 + step * len(rows))
    where = {n: (20 + across[n] * (width - 40), 30 + step * (len(rows) - 1 - level[n])) for n in names}
    half = {n: 8 + 3.6 * len(n) for n in names}
    for n in names:
        for u in sorted(direct[n]):
            (x1, y1), (x2, y2) = where[n], where[u]
            others = [(*where[v], half[v]) for v in names if v not in (n, u)]
            d.path(past(others, (x1, y1 + 26), (x2, y2 - 1)), "thin", head=True)
    for n in names:
        x, y = where[n]
        d.box(x - half[n], y, 2 * half[n], 26, n, "pa" if level[n] <= level["simulation"] else "pb")
    d.text(20, 50 + step * len(rows), "An arrow: uses. Arrows that follow from others are left out. Blue: up to the simulation; orange: runs, display, laboratory, program.", "start", "small")
    return d


def main():
    wrong = []
    FOLDER.mkdir(exist_ok=True)
    for draw in (sheared_images, neighbour_lists, contact_domains, kick_drift_kick, blocks, transform_layout, house):
        path = FOLDER / (draw.__name__.replace("_", "-") + ".svg")
        svg = draw().svg()
        if "--check" in sys.argv[1:]:
            if not path.exists() or path.read_text() != svg:
                wrong.append(f"{path.relative_to(ROOT)} is not what scripts/drawings.py draws: run it")
        else:
            path.write_text(svg)
    print(*wrong, sep="\n", end="\n" if wrong else "")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
