# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves: 'Y over X', two columns of a table or what numbers make of columns."""

import ast
import difflib
import os

import numpy

from . import prm, runs
from .runs import Error

SUMS = (ast.Expression, ast.BinOp, ast.UnaryOp, ast.Load, ast.Name, ast.Constant,
        ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow, ast.USub)


def column(text, table, file):
    """A column of a table, or what + - * / ** make of numbers and columns."""
    titles, text = {}, text.strip()
    if text in table:  # it need not be a name, as 'force in N'
        titles, text, table = {"_": text}, "_", {"_": table[text]}
    try:
        tree = ast.parse(text, mode="eval")
    except SyntaxError:
        tree = None
    if not tree or not all(isinstance(node, SUMS) for node in ast.walk(tree)):
        raise Error(f"{file}: '{text}' is no sum of numbers and columns", 2)
    for name in (node.id for node in ast.walk(tree) if isinstance(node, ast.Name)):
        if name not in table:
            near = difflib.get_close_matches(name, table) or list(table)[:3]
            raise Error(f"{file} has no column '{name}', but {', '.join(near)}, ...; "
                        "its first line has them all", 2)
        if table[name].dtype.kind != "f":
            raise Error(f"{file}: not all in the column '{titles.get(name, name)}' are "
                        "numbers", 2)
    return eval(compile(tree, text, "eval"), {"__builtins__": {}}, table)


def curve_of(table, text, file):
    """x and y of 'Y over X', where it has both, up to the largest x."""
    y, over, x = text.partition(" over ")
    if not over:
        raise Error(f"'{text}' is not 'Y over X'", 2)
    n = len(next(iter(table.values())))
    x, y = (numpy.broadcast_to(column(side, table, file), n) for side in (x, y))
    known = numpy.isfinite(x) & numpy.isfinite(y)
    if not known.any():
        raise Error(f"{file}: no row has both of '{text}'", 2)
    last = numpy.argmax(x[known]) + 1
    return x[known][:last], y[known][:last]


def read_measured(measured, columns):
    """x and y from two arrays or a table, by default its first two columns."""
    if not isinstance(measured, (str, os.PathLike)):
        table = dict(zip("xy", (numpy.asarray(part, float) for part in measured)))
        return curve_of(table, "y over x", "the measured curve")
    table = runs.read_csv(measured)
    if not table:
        raise Error(f"there is nothing in {measured}" if os.path.exists(measured) else
                    f"there is no file {measured}", 2)
    if len(table) < 2 or any(prm.number(title) is not None for title in table):
        raise Error(f"{measured} needs a line with titles and two columns, separated "
                    "by commas", 2)
    if not columns:
        (x_title, x), (y_title, y), *_ = table.items()
        return curve_of({x_title: x, y_title: y}, f"{y_title} over {x_title}", measured)
    return curve_of(table, columns, measured)
