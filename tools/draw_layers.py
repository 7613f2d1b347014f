#!/usr/bin/env python3
"""Draws the layers and their includes: docs/pictures/layers.svg.

  tools/draw_layers.py           writes the picture
  tools/draw_layers.py --check   exits with 1 if the picture is out of date, or a layer has no row in
                                 docs/architecture.md

Layers and their folders come from the blum_add_layer() lines of CMakeLists.txt, arrows from the includes of src and
include. The level of a layer is one above the highest layer that it includes. A layer that all layers above the lowest
level include is the floor, and its arrows are left out. The number of includes selects one of a few arrow widths, so
that small changes leave the picture as it is.
"""

import collections
import itertools
import math
import pathlib
import re
import sys

import check_includes

PROJECT = check_includes.PROJECT
PICTURE = PROJECT / "docs/pictures/layers.svg"
PAGE = PROJECT / "docs/architecture.md"
STEPS = ((30, 6.0), (10, 3.2), (1, 1.4))  # minimum number of includes, width of the arrow
COLORS = ("#0072b2", "#d55e00", "#009e73", "#a6569c", "#8c6d1f", "#5b6ee1", "#b3404a", "#4a7a8c")
COLORS += ("#5d7f14", "#c2185b", "#00838f", "#7a4a2b")
WIDTH, MARGIN, ROOM_HEIGHT, ROW_DISTANCE, GAP = 900, 14, 62, 138, 38
FLOOR_DISTANCE = 80  # from the floor's row to the next row; no arrows lie between them
LANE = 9  # distance of arrows that pass a gap side by side


def layers() -> dict[str, list[str]]:
    """The layers in the order of CMakeLists.txt, with their folders that have their own sources."""
    text = (PROJECT / "CMakeLists.txt").read_text(encoding="utf-8")
    found: dict[str, list[str]] = {}
    for name, rest in re.findall(r"blum_add_layer\((\w+)([^)]*)\)", text):
        folders = [word for word in rest.split() if "/" in word]
        layer = folders[0].split("/")[0] if folders else name
        found.setdefault(layer, []).extend(folder.split("/", 1)[1] for folder in folders)
    return found


def includes(names: set[str]) -> collections.Counter:
    """The number of includes from one layer to another, for each pair."""
    counts: collections.Counter = collections.Counter()
    for folder in ("include", "src"):
        for path in sorted((PROJECT / folder).rglob("*")):
            if path.suffix not in (".hpp", ".cpp", ".cu", ".cuh"):
                continue
            source = pathlib.PurePosixPath(path.relative_to(PROJECT).as_posix())
            for line in path.read_text(encoding="utf-8").splitlines():
                match = check_includes.INCLUDE.match(line)
                target = check_includes.resolve(source, match[2] or match[1]) if match else None
                if target is None:
                    continue
                pair = check_includes.layer_of(source), check_includes.layer_of(target)
                if pair[0] != pair[1] and names.issuperset(pair):
                    counts[pair] += 1
    return counts


def levels(names: list[str], counts: collections.Counter) -> dict[str, int]:
    """The level of each layer: one above the highest layer that it includes."""
    level = dict.fromkeys(names, 0)
    for _ in names:
        for upper, lower in counts:
            level[upper] = max(level[upper], level[lower] + 1)
    if max(level.values()) >= len(names):
        sys.exit("draw_layers: layers include each other in a circle")
    return level


class Drawing:
    """Layers as rooms in rows, with arrows that pass other rows through the gaps between rooms."""

    def __init__(self, names: list[str], counts: collections.Counter):
        self.level = levels(names, counts)
        above = [name for name in names if self.level[name] > 0]
        self.floor = {name for name in names if all((other, name) in counts for other in above if other != name)}
        self.counts = {pair: number for pair, number in counts.items() if pair[1] not in self.floor}
        height = max(self.level.values()) + 1
        self.rows = [[name for name in names if self.level[name] == row] for row in range(height)]
        self.lowest = FLOOR_DISTANCE if self.floor else ROW_DISTANCE
        self.height = 2 * MARGIN + ROOM_HEIGHT + (height - 2) * ROW_DISTANCE + self.lowest
        self.improve()
        targets = [name for name in names if any(pair[1] == name for pair in self.counts)]
        self.color = {name: COLORS[i % len(COLORS)] for i, name in enumerate(targets)}

    # Positions. Row 0 is at the bottom.

    def room_width(self, row: int) -> float:
        number = len(self.rows[row])
        if number == 1 and row in (0, len(self.rows) - 1):
            return WIDTH - 2 * MARGIN - 2 * GAP
        return min(190.0, (WIDTH - 2 * MARGIN - (number + 1) * GAP) / number)

    def pitch(self, row: int) -> float:
        """The distance between the middles of neighbouring rooms."""
        return (WIDTH - 2 * MARGIN - GAP) / len(self.rows[row])

    def middle(self, name: str) -> float:
        row = self.level[name]
        return MARGIN + GAP / 2 + (self.rows[row].index(name) + 0.5) * self.pitch(row)

    def top(self, row: int) -> float:
        up = self.lowest + (row - 1) * ROW_DISTANCE if row > 0 else 0
        return self.height - MARGIN - ROOM_HEIGHT - up

    def gaps(self, row: int) -> list[float]:
        """The places where arrows may pass a row: at the sides, and beside each room."""
        aside = (self.room_width(row) + GAP) / 2
        places = [MARGIN + GAP / 2, WIDTH - MARGIN - GAP / 2]
        for name in self.rows[row]:
            places += [self.middle(name) - aside, self.middle(name) + aside]
        apart: list[float] = []
        for place in sorted(places):
            if not apart or place - apart[-1] >= GAP:
                apart.append(place)
        return apart

    def route(self, upper: str, lower: str) -> list[tuple[int, int]]:
        """The rows that an arrow passes and the gap in each, on the way with the least sideways movement."""
        between = range(self.level[upper] - 1, self.level[lower], -1)
        best: tuple[float, list[tuple[int, int]]] = (math.inf, [])
        start, goal = self.anchor_guess(upper, lower), self.middle(lower)
        for choice in itertools.product(*(range(len(self.gaps(row))) for row in between)):
            x, way = start, 0.0
            for row, gap in zip(between, choice, strict=True):
                way, x = way + abs(self.gaps(row)[gap] - x), self.gaps(row)[gap]
            way += abs(goal - x)
            if way < best[0] - 1e-9:
                best = way, list(zip(between, choice, strict=True))
        return best[1]

    def anchor_guess(self, upper: str, lower: str) -> float:
        """The place where an arrow leaves its room, ignoring other arrows: as close to its goal as the room allows."""
        half = self.room_width(self.level[upper]) / 2 - 12
        return min(max(self.middle(lower), self.middle(upper) - half), self.middle(upper) + half)

    # The order of rooms in their rows.

    def cost(self) -> float:
        """The sideways movement of arrows and the number of their crossings."""
        total = 0.0
        steps = []  # (upper row, x there, x below, weight)
        for (upper, lower), number in self.counts.items():
            x, row, weight = self.anchor_guess(upper, lower), self.level[upper], width_of(number)
            for next_row, gap in self.route(upper, lower):
                steps.append((row, x, self.gaps(next_row)[gap]))
                x, row = self.gaps(next_row)[gap], next_row
            steps.append((row, x, self.middle(lower)))
            total += sum(abs(a - b) for _, a, b in steps[-(self.level[upper] - self.level[lower]) :]) * math.sqrt(
                weight
            )
        for (row, a, b), (other, c, d) in itertools.combinations(steps, 2):
            if row == other and (a - c) * (b - d) < -1e-9:
                total += 60
        return total

    def improve(self) -> None:
        """Swaps rooms of a row as long as the cost falls."""
        best = self.cost()
        better = True
        while better:
            better = False
            for row in self.rows:
                for i, k in itertools.combinations(range(len(row)), 2):
                    row[i], row[k] = row[k], row[i]
                    now = self.cost()
                    if now < best - 1e-6:
                        best, better = now, True
                    else:
                        row[i], row[k] = row[k], row[i]

    # Arrows.

    def arrows(self) -> list[tuple[str, str, list[tuple[float, float]]]]:
        """Each arrow as the points that it passes vertically."""
        routes = {pair: self.route(*pair) for pair in self.counts}
        aims = {}  # the first place an arrow heads for, and the last one it comes from
        for (upper, lower), route in routes.items():
            first = self.gaps(route[0][0])[route[0][1]] if route else self.middle(lower)
            last = self.gaps(route[-1][0])[route[-1][1]] if route else self.middle(upper)
            aims[upper, lower] = first, last
        leaves, reaches = {}, {}
        for name in self.level:
            down = sorted((pair for pair in routes if pair[0] == name), key=lambda pair: (aims[pair][0], pair))
            up = sorted((pair for pair in routes if pair[1] == name), key=lambda pair: (aims[pair][1], pair))
            leaves.update(zip(down, self.spread(name, [aims[pair][0] for pair in down]), strict=True))
            reaches.update(zip(up, self.spread(name, [aims[pair][1] for pair in up]), strict=True))
        lanes = self.lanes(routes, leaves, reaches)
        result = []
        for (upper, lower), route in sorted(routes.items()):
            points = [(leaves[upper, lower], self.top(self.level[upper]) + ROOM_HEIGHT)]
            for row, gap in route:
                x = self.gaps(row)[gap] + lanes[upper, lower, row]
                points += [(x, self.top(row)), (x, self.top(row) + ROOM_HEIGHT)]
            points.append((reaches[upper, lower], self.top(self.level[lower])))
            result.append((upper, lower, points))
        return result

    def spread(self, name: str, aims: list[float]) -> list[float]:
        """Places along a side of a room for arrows with these rising aims.

        The places are even. Along a wide room they lie below the aims, if these are far enough apart."""
        half = self.room_width(self.level[name]) / 2 - 14
        low, high = self.middle(name) - half, self.middle(name) + half
        step = 2 * half / max(len(aims), 1)
        if half < WIDTH / 4:
            return [low + (i + 0.5) * step for i in range(len(aims))]
        apart = min(26.0, step)
        places = [min(max(aim, low), high) for aim in aims]
        for i in range(1, len(places)):
            places[i] = max(places[i], places[i - 1] + apart)
        return [min(place, high - (len(places) - 1 - i) * apart) for i, place in enumerate(places)]

    def lanes(self, routes: dict, leaves: dict, reaches: dict) -> dict:
        """The offset of each arrow from the middle of a gap; arrows from the left pass on the left."""
        passing = collections.defaultdict(list)
        for pair, route in routes.items():
            for row, gap in route:
                passing[row, gap].append(pair)
        result = {}
        for (row, _), pairs in passing.items():
            pairs.sort(key=lambda pair: (leaves[pair] + reaches[pair], pair))
            lane = min(LANE, (GAP - 6) / len(pairs))
            for i, pair in enumerate(pairs):
                result[*pair, row] = (i - (len(pairs) - 1) / 2) * lane
        return result


def width_of(number: int) -> float:
    return next(width for least, width in STEPS if number >= least)


def text_element(x: float, y: float, size: int, text: str, more: str = "") -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" {more}>{text}</text>'


def path_of(points: list[tuple[float, float]], head: float) -> str:
    """A curve that is vertical at each of its points and ends one arrowhead before the last."""
    points = [*points[:-1], (points[-1][0], points[-1][1] - head)]
    text = f"M{points[0][0]:.1f} {points[0][1]:.1f}"
    for (x0, y0), (x1, y1) in itertools.pairwise(points):
        if x0 == x1:
            text += f" V{y1:.1f}"
        else:
            bend = (y1 - y0) * 0.5
            text += f" C{x0:.1f} {y0 + bend:.1f} {x1:.1f} {y1 - bend:.1f} {x1:.1f} {y1:.1f}"
    return text


def arrow(points: list[tuple[float, float]], number: int, color: str) -> list[str]:
    width = width_of(number)
    head = 6 + width
    x, y = points[-1]
    half = 3.2 + width * 0.75
    curve = path_of(points, head - 1)
    return [
        f'<path d="{curve}" fill="none" stroke="#fff" stroke-width="{width + 3:.1f}"/>',
        f'<path d="{curve}" fill="none" stroke="{color}" stroke-width="{width:.1f}"/>',
        f'<path d="M{x:.1f} {y:.1f} l{-half:.1f} {-head:.1f} h{2 * half:.1f} z" fill="{color}"/>',
    ]


def wrapped(words: list[str], width: float, size: int) -> list[str]:
    """The words, wrapped into lines of the given width."""
    lines: list[str] = []
    for word in words:
        longer = f"{lines[-1]}, {word}" if lines else word
        if lines and len(longer) * size * 0.54 <= width:
            lines[-1] = longer
        else:
            lines = [*lines[:-1], *(f"{line}," for line in lines[-1:]), word]
    return lines


def room(drawing: Drawing, name: str, folders: list[str]) -> list[str]:
    row = drawing.level[name]
    width, middle, top = drawing.room_width(row), drawing.middle(name), drawing.top(row)
    color = drawing.color.get(name, "#555")
    below = wrapped(folders, width - 16, 11)
    first = top + ROOM_HEIGHT / 2 + 6 - 6.5 * len(below)
    return [
        f'<rect x="{middle - width / 2:.1f}" y="{top:.1f}" width="{width:.1f}" height="{ROOM_HEIGHT}" rx="6" '
        f'fill="#f6f6f2" stroke="{color}" stroke-width="2"/>',
        text_element(middle, first, min(17, int((width - 8) / (0.62 * len(name)))), name, 'font-weight="bold"'),
        *(text_element(middle, first + 2 + 13 * (i + 1), 11, line, 'fill="#444"') for i, line in enumerate(below)),
    ]


def level_names(drawing: Drawing) -> list[str]:
    """The numbers of the rows beside the rows."""
    parts = []
    for row in range(len(drawing.rows)):
        y = drawing.top(row) + ROOM_HEIGHT / 2
        parts.append(text_element(11, y, 11, f"level {row}", f'fill="#777" transform="rotate(-90 11 {y:.1f})"'))
    return parts


def legend(y: float) -> list[str]:
    """The meaning of the widths in one line."""
    parts = [text_element(MARGIN + 20, y + 4, 12, "includes:", 'text-anchor="start" fill="#444"')]
    x = MARGIN + 84
    most = math.inf
    labels = []
    for least, width in STEPS:
        labels.append((f"{least} to {most - 1}" if most < math.inf else f"{least} or more", width))
        most = least
    for label, width in reversed(labels):
        parts.append(f'<path d="M{x} {y} h30" stroke="#555" stroke-width="{width}"/>')
        parts.append(text_element(x + 38, y + 4, 12, label, 'text-anchor="start" fill="#444"'))
        x += 104
    return parts


def picture() -> str:
    folders = layers()
    drawing = Drawing(list(folders), includes(set(folders)))
    below = 30
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {drawing.height + below:.0f}" '
        f'width="{WIDTH}" height="{drawing.height + below:.0f}" font-family="Helvetica, Arial, sans-serif" '
        'text-anchor="middle" fill="#111">',
        "<!-- Written by tools/draw_layers.py; do not edit. -->",
        "<title>The layers of Blum: an arrow goes from a layer to one that it includes headers of</title>",
        '<rect width="100%" height="100%" fill="#fff"/>',
    ]
    thick_first = sorted(drawing.arrows(), key=lambda item: (-width_of(drawing.counts[item[:2]]), item[:2]))
    for upper, lower, points in thick_first:
        parts += arrow(points, drawing.counts[upper, lower], drawing.color[lower])
    for name, inner in folders.items():
        parts += room(drawing, name, inner)
    parts += level_names(drawing)
    parts += legend(drawing.height + below - 20)
    for name in sorted(drawing.floor):
        more = 'text-anchor="end" fill="#444"'
        words = f"every layer includes {name}: these arrows are left out"
        parts.append(text_element(WIDTH - MARGIN - 20, drawing.height + below - 16, 12, words, more))
    return "\n".join([*parts, "</svg>"]) + "\n"


def check(text: str) -> int:
    problems = []
    if not PICTURE.is_file() or PICTURE.read_text(encoding="utf-8") != text:
        problems.append(f"{PICTURE.relative_to(PROJECT)} is out of date: run tools/draw_layers.py")
    page = PAGE.read_text(encoding="utf-8")
    rows = re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE)
    known = layers()
    shown = PAGE.relative_to(PROJECT)
    problems += [f"{shown} has no row of the layer {name}" for name in known if name not in rows]
    problems += [f"{shown} has a row of {name}, which is no layer" for name in rows if name not in known]
    for problem in problems:
        print(f"draw_layers: {problem}")
    print(f"draw_layers: {len(known)} layers, {len(problems)} problems")
    return 1 if problems else 0


def main() -> int:
    if sys.argv[1:] not in ([], ["--check"]):
        print(__doc__, file=sys.stderr)
        return 2
    text = picture()
    if sys.argv[1:]:
        return check(text)
    PICTURE.write_text(text, encoding="utf-8")
    print(f"draw_layers: wrote {PICTURE.relative_to(PROJECT)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
