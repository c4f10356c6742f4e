#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_ranks.sh DEBOND: 1, 2, 3 and 4 ranks write the same displacement and
# contact profile byte for byte, and a summary whose numbers are the same; one
# message and one exit code for all of them where they cannot share a scene.
source "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OPENBLAS_NUM_THREADS=1

# shared NAME: what all scenes say.
shared() {
  cat >>"$1.prm" <<END
subsection Solver
  set Method = majorise minimise
  set Linear solver = multigrid
  set Search = none
end
subsection Output
  set Displacement = true
  set Machine details = false
end
END
}

# scene NAME DIMENSION CELLS LENGTHS TRACTION
scene() {
  cat >"$1.prm" <<END
set Dimension = $2
subsection Mesh
  set Lengths = $4
  set Cells = $3
end
subsection Boundary conditions
  set Clamped boundaries = left
end
subsection Loads
  set Traction right = $5
end
END
  shared "$1"
}
scene plane 2 "320, 8" "0.4, 0.01" "0; 0.001"
scene solid 3 "42, 4, 3" "0.4, 0.04, 0.03" "0; 0.02; 0"
# Ranks share its first coarser level, too.
scene fine 2 "479, 63" "0.479, 0.063" "0; 0.02"

# A mesh of Gmsh that is halved, with curved sides (its finest level and the next one
# are shared), and what a generator makes in 3D.
sed "s=ring.msh=$tests/../prm/cookbook/ring.msh=" \
  "$tests/../prm/cookbook/ring.prm" >ring.prm
cat >>ring.prm <<END
subsection Mesh
  set Refinements = 3
end
END
shared ring
cat >pipe.prm <<END
set Dimension = 3
subsection Mesh
  set Source = generator
  set Generator = quarter_hyper_shell
  set Arguments = 0, 0, 0 : 0.1 : 0.2 : 3 : true
  set Refinements = 3
end
subsection Boundary conditions
  set Clamped boundaries = 2
  set Contact boundary = 1
end
subsection Loads
  set Traction 3 = 0; 0.02; 0
end
END
shared pipe

# What all ranks have: neither times nor the error estimate and the means.
numbers() {
  python3 - "$1" <<'END'
import json, sys
summary = json.load(open(sys.argv[1]))
for name in ("timings_s", "peak_memory_bytes", "memory_estimate_bytes"):
    summary.pop(name, None)
print(json.dumps(summary, indent=1, sort_keys=True))
END
}

# Each cell's fields are in one of the files, as they are in that of one process.
cat >pieces.py <<'SCRIPT'
import sys
sys.path.insert(0, sys.argv[4])
from vtu import Piece


def rows(body, names):
    n = body.cells["offsets"][0]
    nodes = body.cells["connectivity"]
    return [tuple(body.points[3 * i:3 * i + 3] +
                  body.at_points["displacement"][3 * i:3 * i + 3]
                  for i in nodes[n * cell:n * (cell + 1)]) +
            tuple(body.in_cells[name][cell] for name in names)
            for cell in range(body.n_cells)]


whole = Piece(sys.argv[1] + "/body.vtu")
pieces = [Piece(f"{sys.argv[2]}/body.rank{rank}.vtu")
          for rank in range(int(sys.argv[3]))]
names = sorted(pieces[0].in_cells)
assert {"von_mises", "stress_xx", "error_density"} <= set(names), names
assert sorted(row for piece in pieces for row in rows(piece, names)) == sorted(
    rows(whole, names))
SCRIPT

for name in plane solid fine ring pipe; do
  ranks="2 3 4"
  [[ $name != @(fine|ring) ]] || ranks=3
  expect_code 0 "$debond" $name.prm --set Output/Directory=$name-1
  numbers $name-1/summary.json >$name-1.numbers
  for n in $ranks; do
    expect_code 0 mpirun --oversubscribe -n $n "$debond" $name.prm \
      --set Output/Directory=$name-$n
    [ ! -s errors ] || fail "$n ranks: $(cat errors)"
    [ "$(grep -c '^Result' log)" -eq 1 ] || fail "$n ranks print $(cat log)"
    for file in displacement.txt contact_profile.csv contact.vtu history.csv; do
      cmp $name-1/$file $name-$n/$file ||
        fail "$name: $file of $n ranks is not that of one"
    done
    numbers $name-$n/summary.json >$name-$n.numbers
    diff $name-1.numbers $name-$n.numbers ||
      fail "$name: the summary of $n ranks is not that of one"
    [ "$(grep -c '<Piece Source' $name-$n/body.pvtu)" -eq $n ] ||
      fail "body.pvtu does not join $n files"
    python3 pieces.py $name-1 $name-$n $n "$tests/program" ||
      fail "$name: the fields of $n ranks are not those of one"
  done
done

# refused ENTRY=VALUE MESSAGE [SCENE]
refused() {
  expect_code 2 mpirun --oversubscribe -n 2 "$debond" "${3:-plane}.prm" \
    --set Output/Directory=refused --set "$1"
  [ "$(grep -c "$2" errors)" -eq 1 ] || fail "$1: $(cat errors)"
  [ ! -e refused ] || fail "$1: there is a directory"
}
refused "Solver/Prove=true" "Solver/Prove"
refused "Solver/Linear solver=direct" "Solver/Linear solver"
refused "Solver/Method=euclidean bundle" "Solver/Method"
refused "Certificate/Kind=global" "Certificate/Kind"
refused "Contact law/Initial gap=1e-4" "Contact law/Initial gap"
refused "Mesh/Rotation=10" "Mesh/Rotation: .*; run the scene on one rank"
refused "Probes/end=0.4, 0.005" "Probes/end"
refused "Mesh/Cells=3, 1" "Mesh/Cells"
expect_code 2 mpirun --oversubscribe -n 5 "$debond" plane.prm \
  --set Mesh/Lengths=0.4,8 --set Mesh/Cells=4,80 --set Output/Directory=refused
grep -q "at most as many ranks, not 5" errors || fail "$(cat errors)"

# Bodies and displacements that ranks do not share, and a word of what they leave out.
refused "Mesh/Refinements=0" "Mesh/Refinements: .*coarser levels" ring
refused "Parts/half=x > 0" "Parts: several ranks" ring
expect_code 2 mpirun --oversubscribe -n 2 "$debond" plane.prm \
  --set Mesh/Degree=2 --set "Contact law/Quadrature=gauss 4" \
  --set "Solver/Linear solver=automatic" --set Output/Directory=refused
[ "$(grep -c "Mesh/Degree: several ranks share linear" errors)" -eq 1 ] ||
  fail "$(cat errors)"
expect_code 0 mpirun --oversubscribe -n 2 "$debond" plane.prm \
  --set Solver/Method=automatic --set Solver/Search=automatic \
  --set Output/Directory=searched
[ "$(grep -c "fronts of bonds are as the search" log)" -eq 1 ] ||
  fail "no word of the fronts: $(cat log)"
