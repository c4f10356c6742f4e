# SPDX-License-Identifier: LGPL-2.1-or-later
"""Problem(DIRECTORY): a problem of the collection (doc/reference/proofs.md has its format)."""
import json
import pathlib
import zlib

import numpy as np
import scipy.io


class Problem:
    """J(s) = c_0 + 1/2 s'S s - g's + terms + friction, s <= upper."""

    def __init__(self, directory):
        data = json.loads((pathlib.Path(directory) / "problem.json").read_text())
        file = pathlib.Path(directory) / data["S"]["file"]
        if zlib.crc32(file.read_bytes()) != data["S"]["crc32"]:
            raise ValueError(f"{file} is that of another problem")
        self.S, self.g, self.c_0 = scipy.io.mmread(file), np.array(data["g"]), data["c_0"]
        self.upper, n = numbers(data["upper"]), len(data["g"])
        # Springs with a common energy: a row of stiffnesses each.
        bonds = [term for term in data["terms"] if "energy" in term]
        self.springs, self.energy = np.zeros((len(bonds), n)), numbers(t["energy"] for t in bonds)
        for row, bond in zip(self.springs, bonds):
            row[bond["unknowns"]] = bond["stiffness"]
        # Curves of the unknowns `at`: of each piece its end, curvature, slope, decay, where it
        # begins, and its value there. What is no piece ends at minus infinity.
        curves = [term for term in data["terms"] if "pieces" in term]
        self.at = np.array([curve["unknown"] for curve in curves], dtype=int)
        most = max([1, *(len(curve["pieces"]) for curve in curves)])
        self.table = np.full((len(curves), most, 6), -np.inf)
        for rows, curve in zip(self.table, curves):
            begin = value = 0.
            for row, (c, b, end, *decay) in zip(rows, curve["pieces"]):
                row[:] = -np.inf if end is None else end, c, b, sum(decay), begin, value
                if end is not None:
                    begin, value = end, value + rise(end, *row[1:5])
        # Friction: weights, and slips from their places in up to two directions.
        self.friction = data["friction"]
        self.weight = np.array([entry["weight"] for entry in self.friction])
        self.slide = np.zeros((2, len(self.friction), n))
        self.place = np.zeros((2, len(self.friction)))
        for k, entry in enumerate(self.friction):
            for d, (unknown, place) in enumerate(zip(entry["unknowns"], entry["place"])):
                self.slide[d, k, unknown], self.place[d, k] = 1., place

    def pieces(self, s):
        """Columns of the table, of the pieces that hold; at a kink the one on the side of 0."""
        held = (s[self.at, None] < self.table[..., 0]).sum(axis=1)
        return self.table[np.arange(len(held)), held, 1:].T

    def stiffness(self, s):
        """Of the springs that are not lost, by unknown."""
        return (self.springs @ s**2 / 2 < self.energy) @ self.springs

    def slips(self, s):
        way = self.slide @ s - self.place
        return way, np.maximum(np.hypot(*way), 1e-300)

    def value(self, s):
        *piece, at_begin = self.pieces(s)
        springs = np.minimum(self.springs @ s**2 / 2, self.energy)
        return (self.c_0 + s @ self.S @ s / 2 - self.g @ s + springs.sum()
                + (at_begin + rise(s[self.at], *piece)).sum() + self.weight @ self.slips(s)[1])

    def gradient(self, s):
        """An element of the subdifferential."""
        (c, b, decay, begin, _), (way, size) = self.pieces(s), self.slips(s)
        result = self.S @ s - self.g + self.stiffness(s) * s
        result[self.at] += c * s[self.at] + b * np.exp(decay * (s[self.at] - begin))
        return result + np.tensordot(self.weight * way / size, self.slide, 2)

    def curvature(self, s):
        """The Hessian where there is one."""
        (c, b, decay, begin, _), (way, size) = self.pieces(s), self.slips(s)
        result = self.S + np.diag(self.stiffness(s))
        result[self.at, self.at] += c + b * decay * np.exp(decay * (s[self.at] - begin))
        across = (way[0, :, None] * self.slide[1] - way[1, :, None] * self.slide[0]) / size[:, None]
        return result + across.T @ ((self.weight / size)[:, None] * across)


def numbers(values):
    """null is infinite."""
    return np.array([np.inf if value is None else value for value in values])


def rise(s, c, b, decay, begin):
    """What a piece with the derivative c s + b exp(decay (s - begin)) rises by from its begin."""
    growth = np.where(decay > 0, np.expm1(decay * (s - begin)) / np.where(decay > 0, decay, 1),
                      s - begin)
    return c / 2 * (s - begin) * (s + begin) + b * growth
