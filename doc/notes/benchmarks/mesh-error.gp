# SPDX-License-Identifier: LGPL-2.1-or-later
# What a mesh costs in accuracy: discretisation errors against the number of
# unknowns. Called by scripts/benchmarks, where meshes.csv is, with `format`.
if (format eq "svg") {
  set terminal svg size 800,500 font "sans,13" background "white"
} else {
  set terminal pngcairo size 1000,625 font "sans,13"
}
set output "mesh-error." . format
set datafile separator ","
file = "meshes.csv"

set title "Discretisation error against unknowns"
set xlabel "unknowns n" offset 0, 0.5
set ylabel "relative error"
set logscale xy
set format xy "10^{%L}"
set grid
set key below spacing 1.2
set style line 1 lc rgb "#0072b2" pt 7 lw 1.5
set style line 2 lc rgb "#d55e00" pt 5 lw 1.5

relative_J(error, J) = error / abs(J - error)
# Lines with the slopes of a smooth solution through the coarsest mesh.
stats file using "unknowns" every ::0::0 nooutput name "n"
stats file using (relative_J(column("J_discretisation_error"), \
  column("J_min"))) every ::0::0 nooutput name "J"
stats file using "energy_discretisation_error" every ::0::0 nooutput \
  name "energy"

plot file using "unknowns":"energy_discretisation_error" \
       with linespoints ls 1 title "|u_{min} - u_{ref}|_A / |u_{ref}|_A", \
     file using "unknowns":(relative_J(column("J_discretisation_error"), \
       column("J_min"))) with linespoints ls 2 title "(J_{min} - J) / |J|", \
     energy_min * (x / n_min)**(-0.5) lc rgb "#0072b2" dt 2 \
       title "slope -1/2: as h, a smooth solution", \
     J_min * (x / n_min)**(-1) lc rgb "#d55e00" dt 2 \
       title "slope -1: as h^2, a smooth solution"
