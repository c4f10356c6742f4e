# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs of Debond from Python, see doc/guide/python.md."""

from .runs import Error, Results, matrices, run
