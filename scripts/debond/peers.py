# SPDX-License-Identifier: LGPL-2.1-or-later
"""Optimisers of others on the discrete problem that a run has written with
Output/Matrices = true, all of them from rest: J(s) = c_0 + 1/2 s'S s - g's + Phi(s)
over s <= 0, with nodal quadrature."""

import ctypes
import time

import numpy
from scipy.optimize import minimize

from .runs import matrices

REAL = numpy.ctypeslib.ndpointer(dtype=float, flags="C")
IPOPT = {0: "optimal", 1: "acceptable", -1: "iteration limit"}


class Problem:
    """J of a run whose bonds have tractions over the opening that are straight
    between `points`."""

    def __init__(self, directory, points):
        self.discrete = matrices(directory)
        self.openings, self.tractions = numpy.array(points, dtype=float).T
        self.slopes = numpy.append(numpy.divide(
            numpy.diff(self.tractions), numpy.diff(self.openings),
            where=numpy.diff(self.openings) > 0., out=0. * self.openings[1:]), 0.)
        self.energies = numpy.append(0., numpy.cumsum(0.5 * numpy.diff(
            self.openings) * (self.tractions[1:] + self.tractions[:-1])))

    def law(self, opening):
        """Energy, traction and its slope at the openings."""
        k = numpy.maximum(numpy.searchsorted(self.openings, opening, "right") - 1, 0)
        p = numpy.maximum(opening - self.openings[k], 0.)
        return (self.energies[k] + p * (self.tractions[k] + 0.5 * p * self.slopes[k]),
                self.tractions[k] + p * self.slopes[k], self.slopes[k])

    def J(self, s):
        d = self.discrete
        return d.c_0 + s @ d.S @ s / 2 - d.g @ s + d.weights @ self.law(-s)[0]

    def gradient(self, s):
        d = self.discrete
        return d.S @ s - d.g - d.weights * self.law(-s)[1]

    def hessian(self, s):
        return self.discrete.S + numpy.diag(self.discrete.weights * self.law(-s)[2])


class Lifted:
    """The same with bonds of the threshold law in a smooth form: of (s, z) with z in
    [0, 1], the part that is broken. The least J over z is that of s."""

    def __init__(self, problem):
        d, k = problem.discrete, problem.slopes[0]
        self.problem, self.n, self.d = problem, len(d.g), d
        self.k, self.energy = d.weights * k, d.weights * problem.energies[-1]

    def J(self, x):
        s, z = x[:self.n], x[self.n:]
        return (self.d.c_0 + s @ self.d.S @ s / 2 - self.d.g @ s +
                self.k @ ((1 - z) * s**2) / 2 + self.energy @ z)

    def gradient(self, x):
        s, z = x[:self.n], x[self.n:]
        return numpy.append(self.d.S @ s - self.d.g + self.k * (1 - z) * s,
                            self.energy - self.k * s**2 / 2)

    def hessian(self, x):
        s, z = x[:self.n], x[self.n:]
        mixed = numpy.diag(-self.k * s)
        return numpy.block([[self.d.S + numpy.diag(self.k * (1 - z)), mixed],
                            [mixed, numpy.zeros((self.n, self.n))]])


def ipopt(problem, start, lower, upper):
    """What Ipopt ends at, by its interface for C, and what it says."""
    library = ctypes.CDLL("libipopt.so.1")
    n, rows = len(start), numpy.tril_indices(len(start))
    number, pointer = ctypes.c_double, ctypes.POINTER
    real = pointer(number)

    def vector(x, size=n):
        return numpy.ctypeslib.as_array(x, (size,))

    def value(n, x, new, result, data):
        result[0] = problem.J(vector(x))
        return 1

    def gradient(n, x, new, result, data):
        vector(result)[:] = problem.gradient(vector(x))
        return 1

    def hessian(n, x, new, factor, m, multipliers, new_m, size, i, j, values, data):
        if values:
            vector(values, size)[:] = factor * problem.hessian(vector(x))[rows]
        else:
            vector(i, size)[:], vector(j, size)[:] = rows
        return 1

    integers, index, data = pointer(ctypes.c_int), ctypes.c_int, ctypes.c_void_p
    kinds = [[real, data], [real, data], [index, real, data],
             [index, index, integers, integers, real, data],
             [number, index, real, index, index, integers, integers, real, data]]
    functions = [ctypes.CFUNCTYPE(index, index, real, index, *kind)(f) for kind, f in zip(
        kinds, (value, gradient, lambda *_: 1, lambda *_: 1, hessian))]
    library.CreateIpoptProblem.restype = data
    bounds = [(number * n)(*b) for b in (lower, upper)]
    solver = data(library.CreateIpoptProblem(
        n, *bounds, 0, None, None, 0, len(rows[0]), 0, functions[0], functions[2],
        functions[1], functions[3], functions[4]))
    library.AddIpoptIntOption(solver, b"print_level", 0)
    library.AddIpoptStrOption(solver, b"sb", b"yes")
    library.AddIpoptNumOption(solver, b"tol", number(1e-10))
    x = (number * n)(*start)
    code = library.IpoptSolve(solver, x, *[None] * 6)
    library.FreeIpoptProblem(solver)
    return vector(x), IPOPT.get(code, f"code {code}")


def petsc(problem, start, lower, upper, kind):
    """What PETSc ends at, by the solvers for bounds of SNES (`vinewtonrsls`, ...) or TAO
    (`bnls`, `blmvm`, ...), and what it says."""
    from petsc4py import PETSc

    x, low, high = (PETSc.Vec().createWithArray(numpy.array(a, dtype=float))
                    for a in (start, lower, upper))
    matrix = PETSc.Mat().createDense((len(start),) * 2)
    matrix.setUp()

    def gradient(solver, x, result):
        result[:] = problem.gradient(x.getArray(readonly=True))

    def hessian(solver, x, matrix, _):
        matrix.getDenseArray()[:] = problem.hessian(x.getArray(readonly=True))
        matrix.assemble()

    if kind.startswith("vi"):
        solver = PETSc.SNES().create()
        solver.setType(kind)
        solver.setFunction(gradient, x.duplicate())
        solver.setJacobian(hessian, matrix)
        solver.ksp.setType("preonly")
        solver.ksp.pc.setType("lu")
        solver.setVariableBounds(low, high)
        solver.setTolerances(max_it=1000)
        solver.solve(None, x)
    else:
        solver = PETSc.TAO().create()
        solver.setType(kind)
        solver.setObjective(lambda _, x: problem.J(x.getArray(readonly=True)))
        solver.setGradient(gradient, x.duplicate())
        solver.setHessian(hessian, matrix)
        solver.setVariableBounds((low, high))
        solver.setMaximumIterations(10000)
        solver.solve(x)
    return x.getArray(), "converged" if solver.getConvergedReason() > 0 else "not converged"


def getfems(problem, start, lower, upper):
    """What the solver of GetFEM ends at, by its contact with multipliers, and what it
    says. Its mesh has a cell of length 1 for each bond; as S is full, so is the solver
    of linear equations."""
    import getfem

    n, d, openings = len(start), problem.discrete, problem.openings
    pieces = [(f"(Heaviside(t-{a})-Heaviside(t-{b}))", f"({traction}+({slope})*(t-{a}))",
               f"({slope})") for a, b, traction, slope in zip(
                   openings, numpy.append(openings[1:], 1e20), problem.tractions,
                   problem.slopes)]
    getfem.util_trace_level(0)
    getfem.asm_define_function(
        "traction", 1, "+".join(f"{inside}*{line}" for inside, line, _ in pieces),
        "+".join(f"{inside}*{slope}" for inside, _, slope in pieces))
    mesh = getfem.Mesh("cartesian", numpy.arange(n + 1.))
    cells = getfem.MeshFem(mesh, 1)
    cells.set_classical_fem(0)
    S = getfem.Spmat("empty", n, n)
    S.assign(range(n), range(n), d.S)
    model = getfem.Model("real")
    model.add_fem_variable("s", cells)
    model.set_variable("s", start)
    model.add_initialized_fem_data("weights", cells, d.weights)
    model.add_explicit_matrix("s", "s", S)
    model.add_explicit_rhs("s", d.g)
    model.add_nonlinear_term(getfem.MeshIm(mesh, getfem.Integ("IM_GAUSS1D(1)")),
                             "-weights*traction(-s)*Test_s")
    model.add_variable("multipliers", n)
    model.add_initialized_data("augmentation", d.S.diagonal().max())
    model.add_initialized_data("upper", upper)
    model.add_basic_contact_brick("s", "multipliers", "augmentation",
                                  getfem.Spmat("identity", n), "upper")
    _, converged = model.solve("lsolver", "dense_lu")
    getfem.asm_undefine_function("traction")
    return model.variable("s"), "converged" if converged else "not converged"


def scipys(problem, start, lower, upper, kind):
    """What an optimiser of scipy ends at, and what it says."""
    found = minimize(problem.J, start, method=kind, bounds=list(zip(lower, upper)), **(
        {} if kind == "Powell" else {"jac": problem.gradient}))
    return found.x, "converged" if found.success else "not converged"


def compare(problem, lifted):
    """Rows of optimiser, J, what it says, seconds."""
    n = len(problem.discrete.g)
    start, lower, upper = numpy.zeros(n), numpy.full(n, -1e20), numpy.zeros(n)
    for name, solve in (
            *((f"scipy {kind}", lambda *args, kind=kind: scipys(*args, kind))
              for kind in ("L-BFGS-B", "Powell", "SLSQP")),
            *((f"PETSc {title}", lambda *args, kind=kind: petsc(*args, kind))
              for title, kind in (("SNES VI", "vinewtonrsls"), ("TAO bnls", "bnls"),
                                  ("TAO blmvm", "blmvm"))),
            ("GetFEM", getfems),
            ("Ipopt", ipopt)):
        begin = time.time()
        x, said = solve(problem, start, lower, upper)
        yield name, problem.J(numpy.minimum(x, 0.)), said, time.time() - begin
    for part in (0., 0.5) if lifted else ():
        begin = time.time()
        x, said = ipopt(Lifted(problem), numpy.append(start, start + part),
                        numpy.append(lower, start), numpy.append(upper, start + 1.))
        yield f"Ipopt, lifted, from {part:g}", problem.J(x[:n]), said, time.time() - begin
