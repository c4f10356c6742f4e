# SPDX-License-Identifier: LGPL-2.1-or-later
"""Optimisers on a problem that load.py has read, from several starts: those of scipy, those of
PETSc and Ipopt where they are installed, and two that are made here."""
import pathlib
import statistics
import sys
import time
import types

import numpy as np
import scipy.linalg
import scipy.optimize

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
from debond import peers  # noqa: E402

SECONDS = 10.  # which a start may take at most, and after which no other one is begun


class Scaled:
    """J over an energy, of x = s / unit: at rest its gradient and the diagonal of its Hessian are
    about 1, as tolerances of optimisers suppose."""

    def __init__(self, problem):
        self.problem, rest = problem, np.minimum(0., problem.upper)
        diagonal = np.sqrt(np.diag(problem.S))
        self.energy = np.sum((problem.gradient(rest) / diagonal)**2) or 1.
        self.unit = np.sqrt(self.energy) / diagonal
        self.upper = np.where(np.isfinite(problem.upper), problem.upper / self.unit, 1e20)
        self.lower = np.full(len(rest), -1e20)
        self.end = np.inf  # of the time that there is

    def J(self, x):
        if time.time() > self.end:
            raise TimeoutError
        return self.problem.value(x * self.unit) / self.energy

    def gradient(self, x):
        return self.problem.gradient(x * self.unit) * self.unit / self.energy

    def hessian(self, x):
        return self.problem.curvature(x * self.unit) * np.outer(self.unit, self.unit) / self.energy


class Lifted(Scaled):
    """Bonds that break at a threshold in a smooth form, of (x, z): z in [0, 1] is the part of each
    that is broken, and the least value over z is J. Throws ValueError for other terms."""

    def __init__(self, problem):
        super().__init__(problem)
        first, last = problem.table[:, 0], problem.table[:, -1]
        if problem.friction or problem.table.shape[1] > 2 or first[:, 2:4].any() or (
                problem.table[:, 1:, 1:4].any()):
            raise ValueError
        curves = np.zeros((len(first), len(problem.g)))
        curves[range(len(first)), problem.at] = first[:, 1]
        breaks, scale = np.isfinite(problem.energy), self.unit**2 / self.energy
        self.k = np.vstack([curves, problem.springs[breaks]]) * scale
        self.lost = np.append(last[:, 5], problem.energy[breaks]) / self.energy
        self.S = np.outer(self.unit, self.unit) / self.energy * problem.S + np.diag(
            problem.springs[~breaks].sum(axis=0) * scale)
        self.g, self.n = problem.g * self.unit / self.energy, len(problem.g)
        self.lower = np.append(self.lower, np.zeros(len(self.k)))
        self.upper = np.append(self.upper, np.ones(len(self.k)))

    def J(self, y):
        x, z = y[:self.n], y[self.n:]
        return x @ self.S @ x / 2 - self.g @ x + (1 - z) @ self.k @ x**2 / 2 + self.lost @ z

    def gradient(self, y):
        x, z = y[:self.n], y[self.n:]
        return np.append(self.S @ x - self.g + (1 - z) @ self.k * x, self.lost - self.k @ x**2 / 2)

    def hessian(self, y):
        mixed = -self.k * y[:self.n]
        return np.block([[self.S + np.diag((1 - y[self.n:]) @ self.k), mixed.T],
                         [mixed, np.zeros((len(mixed), len(mixed)))]])


def broken(problem):
    """Openings at which nothing holds but tails and what never breaks."""
    depth = np.zeros(len(problem.g))
    depth[problem.at] = -np.where(np.isfinite(problem.table[..., 4]), problem.table[..., 4],
                                  0.).min(axis=1, initial=0.)
    for stiffness, energy in zip(problem.springs, problem.energy):
        if np.isfinite(energy):
            depth[stiffness > 0] = np.sqrt(2 * energy / stiffness[stiffness > 0])
    return 1.5 * depth


def starts(problem, n):
    """Rest, all bonds broken, and random ones, either way along what has no bound."""
    random, rest, depth = np.random.default_rng(1), np.minimum(0., problem.upper), broken(problem)
    yield rest
    yield rest - depth
    for _ in range(n - 2):
        way = np.where(np.isfinite(problem.upper), 1, random.choice((-1, 1), len(rest)))
        yield rest - depth * way * (random.random(len(rest)) < random.random())


def newton(scaled, x):
    """Newton's method on what its bounds do not hold, with a search along the way; where J is
    not convex, with the sizes of its curvatures."""
    J = scaled.J(x)
    for _ in range(300):
        gradient = scaled.gradient(x)
        free = (x < scaled.upper) | (gradient > 0)
        if np.max(np.abs(gradient[free]), initial=0.) < 1e-13:
            break
        H, step, part = scaled.hessian(x)[np.ix_(free, free)], np.zeros(len(x)), 1.
        try:
            step[free] = scipy.linalg.cho_solve(scipy.linalg.cho_factor(H), gradient[free])
        except scipy.linalg.LinAlgError:
            sizes, ways = scipy.linalg.eigh(H)
            step[free] = ways @ (ways.T @ gradient[free] / np.maximum(np.abs(sizes), 1e-8))
        while part > 1e-10:
            new = np.minimum(x - part * step, scaled.upper)
            J_new = scaled.J(new)
            if J_new < J + 1e-4 * min(gradient @ (new - x), 0.):
                break
            part /= 2
        else:
            break
        x, J = new, J_new
    return x


def iterated(scaled, x):
    """Newton's method, 1000 times, from the best point so far with some bonds broken or closed:
    those that S couples most to one of them."""
    random, best = np.random.default_rng(2), newton(scaled, x)
    depth, rest = broken(scaled.problem) / scaled.unit, np.minimum(0., scaled.upper)
    J, coupling = scaled.J(best), np.abs(scaled.problem.S)
    try:
        for _ in range(1000):
            n_near = random.integers(1, len(x) // 3 + 2)
            near, new = np.argsort(-coupling[random.integers(len(x))])[:n_near], best.copy()
            new[near] = rest[near] - depth[near] * random.integers(2)
            new = newton(scaled, new)
            J_new = scaled.J(new)
            if J_new < J:
                best, J = new, J_new
    except TimeoutError:
        pass
    return best


def scipys(method, **options):
    def solve(scaled, x):
        bounds = [(None, None if u >= 1e20 else u) for u in scaled.upper]
        return scipy.optimize.minimize(scaled.J, x, jac=scaled.gradient, method=method,
                                       bounds=bounds, options=options).x
    return solve


def petsc(kind):
    return lambda scaled, x: peers.petsc(scaled, x, scaled.lower, scaled.upper, kind)[0]


def ipopt(scaled, x):
    scaled.end = np.inf  # exceptions are lost in it
    return np.array(peers.ipopt(scaled, x, scaled.lower, scaled.upper)[0])


def lifted(scaled, x):
    smooth = Lifted(scaled.problem)
    return ipopt(smooth, np.append(x, np.full(len(smooth.k), 0.5)))[:smooth.n]


# With the number of unknowns up to which they are tried, and the number of starts.
OPTIMISERS = {
    "L-BFGS-B": (4000, 10, scipys("L-BFGS-B", maxcor=30, ftol=1e-16, gtol=1e-11, maxiter=20000,
                                  maxfun=40000)),
    "SLSQP": (160, 10, scipys("SLSQP", ftol=1e-15, maxiter=1000)),
    "SNES VI": (700, 10, petsc("vinewtonrsls")),
    "TAO BNLS": (700, 10, petsc("bnls")),
    "TAO BLMVM": (4000, 10, petsc("blmvm")),
    "Ipopt": (400, 10, ipopt),
    "Ipopt, lifted": (200, 10, lifted),
    "Newton": (2000, 10, newton),
    "iterated Newton": (700, 2, iterated)}


def compare(problem):
    """Of each optimiser that is installed and for such terms: its name, J from all starts, the
    least and the state there, and seconds."""
    scaled = Scaled(problem)
    for name, (largest, n_starts, solve) in OPTIMISERS.items():
        found, begin = [], time.time()
        try:
            for start in starts(problem, n_starts) if len(problem.g) <= largest else ():
                if time.time() - begin > SECONDS:
                    break
                scaled.end = time.time() + SECONDS
                s = np.minimum(solve(scaled, start / scaled.unit) * scaled.unit, problem.upper)
                if np.isfinite(problem.value(s)):
                    found.append((problem.value(s), s))
        except (ImportError, OSError, RuntimeError, ValueError):  # OSError is also of the time
            pass
        if found:
            values = [J for J, _ in found]
            best, state = min(found, key=lambda pair: pair[0])
            yield types.SimpleNamespace(name=name, values=values, best=best, state=state,
                                        median=statistics.median(values),
                                        seconds=time.time() - begin)
