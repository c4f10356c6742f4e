# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs of Debond from Python, see doc/guide/python.md."""

from .fit import fit
from .runs import Error, Results, matrices, run
