# SPDX-License-Identifier: LGPL-2.1-or-later
"""load(DIRECTORY): S, g, c_0 and upper of a problem, and of s J, a subgradient, and the Hessian."""
import json, pathlib, types, zlib
import numpy as np, scipy.io


def load(directory):
    data = json.loads((pathlib.Path(directory) / "problem.json").read_text())
    file, g, c_0 = pathlib.Path(directory) / data["S"]["file"], np.array(data["g"]), data["c_0"]
    if zlib.crc32(file.read_bytes()) != data["S"]["crc32"]:
        raise ValueError(f"{file} is that of another problem")
    S, terms, rubs = scipy.io.mmread(file), data["terms"], data["friction"]
    bonds, curves = ([term for term in terms if key in term] for key in ("energy", "pieces"))
    upper, energy = (np.array([np.inf if x is None else x for x in numbers]) for numbers in (
        data["upper"], [bond["energy"] for bond in bonds]))
    springs, slide = np.zeros((len(bonds), len(g))), np.zeros((2, len(rubs), len(g)))
    for row, bond in zip(springs, bonds):
        row[bond["unknowns"]] = bond["stiffness"]
    weight, place = np.array([rub["weight"] for rub in rubs]), np.zeros((2, len(rubs)))
    for k, rub in enumerate(rubs):
        slide[range(len(rub["place"])), k, rub["unknowns"]] = 1
        place[:len(rub["place"]), k] = rub["place"]
    at, row = np.array([curve["unknown"] for curve in curves], dtype=int), np.arange(len(curves))
    # Of each piece its end, curvature, slope, decay, begin, and the term where it begins.
    table = np.full((len(row), max([1, *(len(t["pieces"]) for t in curves)]), 6), -np.inf)
    area = lambda s, c, m, d, u: c / 2 * (s - u) * (s + u) + m * np.where(
        d > 0, np.expm1(d * (s - u)) / np.where(d > 0, d, 1), s - u)
    for pieces, curve in zip(table, curves):
        begin = f = 0.
        for k, (c, m, end, *decay) in enumerate(curve["pieces"]):
            pieces[k] = -np.inf if end is None else end, c, m, sum(decay), begin, f
            begin, f = end, f if end is None else f + area(end, *pieces[k, 1:5])
    branch = lambda s: table[row, (s[at, None] < table[..., 0]).sum(axis=1), 1:].T
    kept = lambda s: (springs @ s**2 / 2 < energy) @ springs
    slip = lambda s: (slide @ s - place, np.maximum(np.hypot(*(slide @ s - place)), 1e-300))

    def value(s):
        *piece, f = branch(s)
        return (c_0 + s @ S @ s / 2 - g @ s + (f + area(s[at], *piece)).sum()
                + np.minimum(springs @ s**2 / 2, energy).sum() + weight @ slip(s)[1])

    def gradient(s):
        (c, m, d, u, _), (way, size), result = branch(s), slip(s), S @ s - g + kept(s) * s
        result[at] += c * s[at] + m * np.exp(d * (s[at] - u))
        return result + np.tensordot(weight * way / size, slide, 2)

    def curvature(s):
        (c, m, d, u, _), (way, size), result = branch(s), slip(s), S + np.diag(kept(s))
        result[at, at] += c + m * d * np.exp(d * (s[at] - u))
        across = (way[0, :, None] * slide[1] - way[1, :, None] * slide[0]) / size[:, None]
        return result + across.T @ ((weight / size)[:, None] * across)

    return types.SimpleNamespace(
        S=S, g=g, c_0=c_0, upper=upper, terms=terms, friction=rubs, springs=springs, energy=energy,
        table=table, at=at, value=value, gradient=gradient, curvature=curvature)
