#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Estimates of the error of J by quadratic functions of the edges beside the true
error, in 2D without contact: the table of doc/notes/error-estimate.md. Plane strain,
crossed meshes, linear displacements; the true error is that to quadratic ones on
fine meshes.

lambda    each edge for itself, with the stiffness of its two functions
patch     those around a vertex and opposite to it together, each shared
all       all edges together
mu        each for itself with the stiffness 2 mu eps : eps, for what is left of the
          load by 2 mu eps(u) and the pressure p* that is continuous (the mean of the
          cells around a vertex); and 1/2 int (p - p*)^2 / lambda
"""
import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg

A7, B7 = 0.059715871789770, 0.470142064105115
C7, D7 = 0.797426985353087, 0.101286507323456
POINTS = np.array([[1 / 3] * 3, [A7, B7, B7], [B7, A7, B7], [B7, B7, A7],
                   [C7, D7, D7], [D7, C7, D7], [D7, D7, C7]])
WEIGHTS = np.array([.225] + [.132394152788506] * 3 + [.125939180544827] * 3)
EDGES = (0, 1), (1, 2), (2, 0)
GAUSS = (1 + np.sqrt(.6) * np.array([-1, 0, 1])) / 2, np.array([5, 8, 5]) / 18
NU_OF_SMOOTH = .4999


class Mesh:
    def __init__(self, lengths, cells):
        xs, ys = (np.linspace(0, l, n + 1) for l, n in zip(lengths, cells))
        points, triangles = [(x, y) for y in ys for x in xs], []
        for j in range(cells[1]):
            for i in range(cells[0]):
                a = j * len(xs) + i
                corners, m = (a, a + 1, a + len(xs) + 1, a + len(xs)), len(points)
                points.append((xs[i:i + 2].mean(), ys[j:j + 2].mean()))
                triangles += [(corners[k], corners[(k + 1) % 4], m)
                              for k in range(4)]
        self.x, self.t = np.array(points), np.array(triangles)
        self.edges = {}
        self.te = np.array([[self.edges.setdefault(
            tuple(sorted((t[a], t[b]))), len(self.edges)) for a, b in EDGES]
                            for t in self.t])
        X = self.x[self.t]
        d, e = X[:, 1] - X[:, 0], X[:, 2] - X[:, 0]
        det = d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]
        self.area = det / 2
        self.g = np.zeros((len(self.t), 3, 2))
        self.g[:, 1] = np.c_[e[:, 1], -e[:, 0]] / det[:, None]
        self.g[:, 2] = np.c_[-d[:, 1], d[:, 0]] / det[:, None]
        self.g[:, 0] = -self.g[:, 1] - self.g[:, 2]

    def edge_gradients(self, q):
        return [4 * (q[a] * self.g[:, b] + q[b] * self.g[:, a])
                for a, b in EDGES]

    def stiffness(self, mu, lam):
        K = np.zeros((len(self.t), 6, 2, 6, 2))
        for q, w in zip(POINTS, WEIGHTS):
            g = np.concatenate([self.g, np.stack(self.edge_gradients(q), 1)], 1)
            K += (w * self.area)[:, None, None, None, None] * (
                mu * np.einsum('tij,ab->tiajb', np.einsum('tid,tjd->tij', g, g),
                               np.eye(2)) +
                mu * np.einsum('tib,tja->tiajb', g, g) +
                lam * np.einsum('tia,tjb->tiajb', g, g))
        dofs = np.c_[self.t, len(self.x) + self.te]
        i = (2 * dofs[:, :, None] + np.arange(2)).reshape(-1, 12)
        n = 2 * (len(self.x) + len(self.edges))
        return sp.csr_matrix((K.ravel(), (np.repeat(i, 12, 1).ravel(),
                                          np.tile(i, (1, 12)).ravel())), (n, n))

    def load(self, force, traction):
        n = len(self.x)
        F = np.zeros((n + len(self.edges), 2))
        for q, w in zip(POINTS, WEIGHTS):
            f = force(*np.einsum('v,tvd->dt', q, self.x[self.t]))
            values = [*q, *(4 * q[a] * q[b] for a, b in EDGES)]
            for i, node in enumerate(np.c_[self.t, n + self.te].T):
                np.add.at(F, node, (w * self.area * values[i])[:, None] * f)
        top = self.x[:, 1] > self.x[:, 1].max() - 1e-12
        for (a, b), e in self.edges.items():
            if top[a] and top[b]:
                for s, w in zip(*GAUSS):
                    t = np.array(traction(*(self.x[a] * (1 - s) + self.x[b] * s)))
                    t = t * w * np.hypot(*(self.x[b] - self.x[a]))
                    F[a] += (1 - s) * t
                    F[b] += s * t
                    F[n + e] += 4 * s * (1 - s) * t
        return F.ravel()

    def free(self, fixed):
        at = np.array([fixed(*x) for x in self.x])
        edges = [not (at[a] and at[b] and fixed(*(self.x[a] + self.x[b]) / 2))
                 for a, b in self.edges]
        return np.repeat(np.r_[~at, edges], 2)


def solve(K, F, free):
    u, free = np.zeros(len(F)), np.where(free)[0]
    u[free] = scipy.sparse.linalg.spsolve(K[free][:, free].tocsc(), F[free])
    return u


def by_groups(K, r, free, groups):
    """1/2 r K^-1 r of each group of edges, a residual in several shared."""
    count = np.zeros(len(r) // 2)
    for group in groups:
        count[group] += 1
    total = 0.
    for group in groups:
        d = np.array([2 * e + k for e in group for k in (0, 1)
                      if free[2 * e + k]], int)
        if len(d):
            total += .5 * (r[d] / count[d // 2]) @ np.linalg.solve(
                K[d][:, d].toarray(), r[d])
    return total


def estimates(mesh, K, F, u, free, mu, lam):
    n = 2 * len(mesh.x)
    free = free[n:]
    KE = K[n:][:, n:].tocsr()
    r = (F[n:] - K[n:][:, :n] @ u) * free
    single = [[e] for e in range(len(mesh.edges))]
    patches = [set() for _ in mesh.x]
    for t, te in zip(mesh.t, mesh.te):
        for v in t:
            patches[v].update(te)
    yield by_groups(KE, r, free, single)
    yield by_groups(KE, r, free, [list(p) for p in patches])
    yield .5 * r @ solve(KE, r, free)

    p = lam * np.einsum('tvd,tvd->t', mesh.g, u.reshape(-1, 2)[mesh.t])
    smooth, weight = np.zeros(len(mesh.x)), np.zeros(len(mesh.x))
    np.add.at(smooth, mesh.t.ravel(), np.repeat(mesh.area * p, 3))
    np.add.at(weight, mesh.t.ravel(), np.repeat(mesh.area, 3))
    smooth /= weight
    K = mesh.stiffness(mu, 0.)
    r = (F[n:] - K[n:][:, :n] @ u).reshape(-1, 2)
    misfit = 0.
    for q, w in zip(POINTS, WEIGHTS):
        here = smooth[mesh.t] @ q
        misfit += .5 * np.sum(w * mesh.area * (p - here)**2) / lam
        for edge, g in zip(mesh.te.T, mesh.edge_gradients(q)):
            np.add.at(r, edge, -(w * mesh.area * here)[:, None] * g)
    yield misfit + by_groups(K[n:][:, n:].tocsr(), r.ravel() * free, free, single)


def case(name, lengths, meshes, nu, force, traction, fixed, fine):
    mu, lam = .5 / (1 + nu), nu / (1 + nu) / (1 - 2 * nu)
    mesh = Mesh(lengths, fine)
    F = mesh.load(force, traction)
    J = -.5 * F @ solve(mesh.stiffness(mu, lam), F, mesh.free(fixed))
    for cells in meshes:
        mesh = Mesh(lengths, cells)
        n, free = 2 * len(mesh.x), mesh.free(fixed)
        K, F = mesh.stiffness(mu, lam), mesh.load(force, traction)
        u = solve(K[:n][:, :n], F[:n], free[:n])
        error = -.5 * F[:n] @ u - J
        row = [name, "%dx%d" % cells, "%.1e" % (error / abs(J))]
        row += ["%.2f" % (value / error)
                for value in estimates(mesh, K, F, u, free, mu, lam)]
        print("| " + " | ".join(row) + " |", flush=True)


def nothing(x, _):
    return np.zeros((len(x), 2))


def smooth_force(x, y):
    return np.c_[np.cos(np.pi * y) * np.sin(np.pi * x), np.sin(2 * np.pi * x) * y]


def incompressible_force(x, y):
    """That of prm/verification/incompressible-2d.prm."""
    def component(x, y):
        return 4 * .5 / (1 + NU_OF_SMOOTH) * (2 * y - 1) * (
            3 * x**4 - 6 * x**3 + 6 * x**2 * y**2 - 6 * x**2 * y + 3 * x**2 -
            6 * x * y**2 + 6 * x * y + y**2 - y)
    return np.c_[-component(x, y), component(y, x)]


def main():
    square, bar, pad = (1, 1), (.4, .04), (.1, .02)
    around = lambda x, y: min(x, y, 1 - x, 1 - y) < 1e-12
    ends = lambda x, _: x < 1e-12 or x > .4 - 1e-12
    below = lambda x, y: ends(x, y) or y < 1e-12
    none = lambda x, y: (0, 0)
    bent = lambda x, y: (0, .69 if x < .2 else -.345)
    for nu in (.3, .45, .49):
        case("smooth, nu = %g" % nu, square, [(8, 8), (16, 16)], nu, smooth_force,
             none, around, (40, 40))
    case("smooth, nu = 0.4999", square, [(8, 8), (16, 16)], NU_OF_SMOOTH,
         incompressible_force, none, around, (40, 40))
    case("smooth, cells of 2:1", square, [(8, 16), (16, 32)], .3, smooth_force,
         none, around, (40, 80))
    for nu in (.3, .45, .499):
        case("bar, ends held, nu = %g" % nu, bar, [(40, 4), (80, 8)], nu, nothing,
             bent, ends, (160, 16))
    case("the same, held below too, nu = 0.3", bar, [(40, 4), (80, 8)], .3,
         nothing, bent, below, (160, 16))
    case("bar, cells of 4:1", bar, [(40, 16)], .3, nothing, bent, ends, (160, 48))
    for nu in (.3, .49):
        case("sheared pad, nu = %g" % nu, pad, [(20, 4), (40, 8)], nu, nothing,
             lambda x, y: (.3, -.1), lambda x, y: y < 1e-12, (160, 32))
    case("strip of 100 x 1", (4, .04), [(100, 1), (200, 2)], .3, nothing,
         lambda x, y: (0, .69), lambda x, y: x < 1e-12, (400, 8))


if __name__ == "__main__":
    main()
