# SPDX-License-Identifier: LGPL-2.1-or-later
"""load(DIRECTORY): S, g, c_0, upper of a problem, and of s J, a subgradient, and the Hessian."""
import json, pathlib, types, zlib
import numpy as np, scipy.io


def load(directory):
    data = json.loads((pathlib.Path(directory) / "problem.json").read_text())
    file, g, c_0 = pathlib.Path(directory) / data["S"]["file"], np.array(data["g"]), data["c_0"]
    if zlib.crc32(file.read_bytes()) != data["S"]["crc32"]:
        raise ValueError(f"{file} is that of another problem")
    S, terms, rubs = scipy.io.mmread(file), data["terms"], data["friction"]
    upper, energy = (np.array([np.inf if x is None else x for x in numbers]) for numbers in (
        data["upper"], [term["energy"] for term in terms if "energy" in term]))
    springs, slide, place = np.zeros((len(energy), len(g))), np.zeros((2, len(rubs), len(g))), []
    for row, term in zip(springs, (term for term in terms if "energy" in term)):
        row[term["unknowns"]] = term["stiffness"]
    for k, rub in enumerate(rubs):
        slide[range(len(rub["unknowns"])), k, rub["unknowns"]] = 1
        place.append((rub["place"] + [0])[:2])
    place, weight = np.reshape(place, (-1, 2)).T, np.array([rub["weight"] for rub in rubs])
    curves = [term for term in terms if "pieces" in term]
    at, row = np.array([curve["unknown"] for curve in curves], dtype=int), np.arange(len(curves))
    # Of each piece its end, curvature, slope, decay, begin, and the term where it begins.
    table = np.full((len(row), max((len(t["pieces"]) for t in curves), default=1), 6), -np.inf)
    area = lambda s, c, m, d, u: c / 2 * (s - u) * (s + u) + m * np.where(
        d > 0, np.expm1(d * (s - u)) / np.where(d > 0, d, 1), s - u)
    for pieces, curve in zip(table, curves):
        begin = f = 0.
        for k, (c, m, end, *decay) in enumerate(curve["pieces"]):
            pieces[k] = -np.inf if end is None else end, c, m, sum(decay), begin, f
            begin, f = end, f if end is None else f + area(end, *pieces[k, 1:5])
    branch = lambda s: table[row, (s[at, None] < table[..., 0]).sum(axis=1), 1:].T

    def slip(s):
        v = slide @ s - place
        size = np.maximum(np.hypot(*v), 1e-300)
        return size, v / size

    def value(s):
        *piece, f = branch(s)
        return (c_0 + s @ S @ s / 2 - g @ s + (f + area(s[at], *piece)).sum()
                + np.minimum(springs @ s**2 / 2, energy).sum() + weight @ slip(s)[0])

    def gradient(s):
        c, m, d, u, _ = branch(s)
        result = S @ s - g + (springs @ s**2 / 2 < energy) @ springs * s
        result[at] += c * s[at] + m * np.exp(d * (s[at] - u))
        return result + np.tensordot(weight * slip(s)[1], slide, 2)

    def curvature(s):
        (c, m, d, u, _), (size, way) = branch(s), slip(s)
        across = way[0, :, None] * slide[1] - way[1, :, None] * slide[0]
        H = S + np.diag((springs @ s**2 / 2 < energy) @ springs)
        H[at, at] += c + m * d * np.exp(d * (s[at] - u))
        return H + across.T @ ((weight / size)[:, None] * across)

    return types.SimpleNamespace(**locals())
