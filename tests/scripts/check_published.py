# SPDX-License-Identifier: LGPL-2.1-or-later
"""Published results: Debond differs from what each source states by no more than the
bound of the problem, "accepted" in doc/notes/published/problems.csv."""
import os

from common import DEBOND

from debond import published

os.environ["DEBOND"] = str(DEBOND)
for problem in published.PROBLEMS:
    rows = problem.rows()
    assert rows, problem.title
    for _, _, quantity, stated, value, difference, bound, word, *_ in rows:
        print(f"{problem.title}, {quantity}: {stated}, computed {value}, {word}")
        assert abs(difference) <= bound, (problem.title, quantity, stated, value)
