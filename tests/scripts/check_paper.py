# SPDX-License-Identifier: LGPL-2.1-or-later
"""Table 1 of the paper: iterations and their kinds, J and the rate at the best u_k
and beside it, and the printed numbers beside them."""
from common import SOURCE, near, study, table

page = study(SOURCE / "prm" / "studies" / "table-1.prm", "--set",
             "Sweep 1/Values=0.007 | 0.0008 | 0.0005")
found = table("output/table-1")
assert found["status"] == ["success"] * 3
# The paper tests its stop criterion every 200 iterations.
assert list(found["iterations (paper)"]) == [2200, 1400, 31800]
# Rounding moves it by up to 3 %.
n_best = found["iterations"][1]
assert abs(n_best - 898) < 0.04 * 898
assert list(found["long"][1:]) == [0, 0] and found["long"][0] > 100
for row in range(3):
    assert (found["long"] + found["short"] + found["null"] ==
            found["iterations"])[row]
    near(found["J"][row], -5.7774619651e-04, 1e-10)
    assert 0 < found["error"][row] < 3e-11
    # The printed J beside the least that is printed for the mesh.
near(found["error (paper)"][1], (5.288672131 - 5.28867208) / 5.288672131, 1e-6)
near(found["rate"][1], -14, 0.1)
assert f"{n_best:.0f}" in page and "-5.7774619651e-04" in page
for plot in "convergence", "fit", "iterations", "steps":
    with open(f"output/table-1/plots/{plot}.svg") as file:
        assert "0.0008" in file.read() or plot in ("iterations", "steps")
