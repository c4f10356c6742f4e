# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes of tests and Gmsh files of them. Faces and cells are (groups, vertices)."""
import random
from itertools import product

KINDS = {(1, 2): 1, (2, 3): 2, (2, 4): 3, (3, 4): 4, (3, 8): 5}
SIDES = ["left", "right", "bottom", "top", "back", "front"]


def box(n, lengths, crossed=False):
    """Points, faces and cells: the sides are groups 1 to 2 dim, the cells 7, those
    whose centre is in the right half 8 as well. Crossed: triangles around centres."""
    dim = len(n)
    numbers = {place: k for k, place in enumerate(product(*(range(m + 1) for m in n)))}
    points = [tuple(length * i / m for length, i, m in zip(lengths, place, n))
              for place in numbers]
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    corners = {1: [(0,), (1,)], 2: square, 3: [(*c, z) for z in (0, 1) for c in square]}

    def at(place, corners):
        return [numbers[tuple(map(sum, zip(place, corner)))] for corner in corners]

    cells = [at(place, corners[dim]) for place in product(*map(range, n))]
    if crossed:
        for k, cell in enumerate(cells):
            points.append(tuple(sum(points[v][d] for v in cell) / 4 for d in range(2)))
            cells[k] = [(cell[i - 1], cell[i], len(points) - 1) for i in range(4)]
        cells = [cell for four in cells for cell in four]
    faces = [((2 * d + end + 1,), at(place[:d] + (end * n[d],) + place[d + 1:],
                                     [c[:d] + (0,) + c[d:] for c in corners[dim - 1]]))
             for d in range(dim) for end in (0, 1)
             for place in product(*(range(1 if e == d else m) for e, m in enumerate(n)))]
    return points, faces, [
        ((7, 8) if sum(points[v][0] for v in cell) > len(cell) * lengths[0] / 2 else (7,),
         cell) for cell in cells]


def text(points, faces, cells, names=None, version="2.2", is_odd=False, order=None):
    """Names of groups by dimension and number; those of a box if none are given.
    Elements in the given order. Odd: every second cell inside out, numbers of nodes
    with gaps, a node of no cell."""
    dim = len(points[0])
    if names is None:
        names = {(dim - 1, k + 1): SIDES[k] for k in range(2 * dim)}
        names.update({(dim, 7): "all", (dim, 8): "upper"})
    number, nodes = (lambda v: v + 1), list(points)
    if is_odd:
        number = (lambda v: 3 * v + 5)
        nodes.append((9.,) * dim)
        cells = [(g, (v[4:] + v[:4] if len(v) == 8 else v[::-1]) if k % 2 else v)
                 for k, (g, v) in enumerate(cells)]
    elements = [(dim - 1, *face) for face in faces] + [(dim, *cell) for cell in cells]
    if order:
        order.shuffle(elements)
    lines = ["$MeshFormat", version + " 0 8", "$EndMeshFormat", "$PhysicalNames",
             len(names)]
    lines += [f'{d} {group} "{name}"' for (d, group), name in names.items()]
    lines += ["$EndPhysicalNames"]
    places = [" ".join((repr(float(x)) for x in (*point, 0.)[:3])) for point in nodes]
    tags = [number(v) for v in range(len(nodes))]
    if version == "2.2":
        # Repeats what is in two groups.
        rows = [(d, group, v) for d, groups, v in elements for group in groups]
        lines += ["$Nodes", len(nodes)] + [f"{t} {p}" for t, p in zip(tags, places)]
        lines += ["$EndNodes", "$Elements", len(rows)]
        lines += [" ".join(map(str, (k, KINDS[d, len(v)], 2, group, group,
                                     *map(number, v))))
                  for k, (d, group, v) in enumerate(rows, 1)]
    else:
        entities = [sorted({groups for d, groups, _ in elements if d == e})
                    for e in range(4)]
        lines += ["$Entities", " ".join(str(len(own)) for own in entities)]
        lines += [f"{k} 0 0 0 1 1 1 {len(g)} {' '.join(map(str, g))} 0"
                  for own in entities for k, g in enumerate(own, 1)]
        lines += ["$EndEntities", "$Nodes", f"1 {len(nodes)} 1 {tags[-1]}",
                  f"{dim} 1 0 {len(nodes)}", *tags, *places, "$EndNodes", "$Elements",
                  f"{sum(map(len, entities))} {len(elements)} 1 {len(elements)}"]
        count = 0
        for d, own in enumerate(entities):
            for k, groups in enumerate(own, 1):
                block = [v for e, g, v in elements if (e, g) == (d, groups)]
                lines.append(f"{d} {k} {KINDS[d, len(block[0])]} {len(block)}")
                for v in block:
                    count += 1
                    lines.append(" ".join(map(str, (count, *map(number, v)))))
    return "\n".join(map(str, lines + ["$EndElements", ""]))


def triangles():
    """A file with the benchmark's bar in triangles that are no grid: inner vertices are
    moved, diagonals go either way, elements are in no order."""
    order = random.Random(1)
    n, lengths = (40, 4), (0.4, 0.04)
    points, faces, cells = box(n, lengths)
    inner = [all(0. < x < length for x, length in zip(point, lengths)) for point in points]
    points = [tuple(x + 0.003 * (2. * order.random() - 1.) * is_inner for x in point)
              for point, is_inner in zip(points, inner)]
    cut = []
    for _, (a, b, c, d) in cells:
        cut += [[a, b, c], [a, c, d]] if order.random() < 0.5 else [[a, b, d], [b, c, d]]
    cut.sort(key=lambda _: order.random())
    names = {(1, k): side for k, side in enumerate(SIDES[:4], 1)}
    return text(points, faces, [((7,), cell) for cell in cut], {**names, (2, 7): "bar"})
