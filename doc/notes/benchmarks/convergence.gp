# SPDX-License-Identifier: LGPL-2.1-or-later
# When to stop: J(x_k) - J_min over time, and the discretisation error of each
# mesh, below which an iteration gains nothing. Called by scripts/benchmarks,
# where convergence.csv and meshes.csv are, with `format`.
if (format eq "svg") {
  set terminal svg size 800,600 font "sans,13" background "white"
} else {
  set terminal pngcairo size 1000,750 font "sans,13"
}
set output "convergence." . format
set datafile separator ","
file = "convergence.csv"
names = system("tail -n +2 meshes.csv | cut -d , -f 1")
errors = system("tail -n +2 meshes.csv | cut -d , -f 4")
of(mesh, method, name) = \
  strcol("mesh") eq mesh && strcol("method") eq method && \
  column("J_distance") > 1e-18 ? column(name) : NaN

set title "J(x_k) - J_{min} over time; dashed: discretisation error of the mesh"
set xlabel "time since the start of the solve, s" offset 0, 0.5
set ylabel "J(x_k) - J_{min}"
set logscale xy
set format xy "10^{%L}"
set grid
set key outside right

plot for [k = 1:words(names)] file \
       using (of(word(names, k), "euclidean bundle", "seconds")):"J_distance" \
       with lines lw 2 lc k title word(names, k) . ", the paper's method", \
     for [k = 1:words(names)] file \
       using (of(word(names, k), "energy bundle", "seconds")):"J_distance" \
       with points pt 6 lc k title word(names, k) . ", energy bundle", \
     for [k = 1:words(names)] file \
       using (of(word(names, k), "majorise minimise", "seconds")):"J_distance" \
       with points pt 5 lc k title word(names, k) . ", majorise minimise", \
     for [k = 1:words(names)] real(word(errors, k)) lc k dt 2 notitle
