# SPDX-License-Identifier: LGPL-2.1-or-later
# The cost of contact: the contact solve over one linear solve, against the
# number of unknowns, all scenes. Called by scripts/benchmarks, where contact_solve.csv is,
# with `format`.
if (format eq "svg") {
  set terminal svg size 800,500 font "sans,13" background "white"
} else {
  set terminal pngcairo size 1000,625 font "sans,13"
}
set output "contact-ratio." . format
set datafile separator ","
file = "contact_solve.csv"
of(path, name) = strstrt(strcol("path"), path) == 1 ? column(name) : NaN

set title "Contact solve over one linear solve of A u = f"
set xlabel "unknowns" offset 0, 0.5
set ylabel "processor time (median, from the smallest to the largest)"
set logscale xy
set format x "10^{%L}"
set yrange [0.2:]
set ytics (0.2, 0.3, 0.5, 0.7, 1, 1.3, 2, 3, 6, 10)
set grid
set key below spacing 1.2
set style line 1 lc rgb "#0072b2" pt 7 lw 1.5
set style line 2 lc rgb "#d55e00" pt 5 lw 1.5
set style line 3 lc rgb "#009e73" pt 9 lw 1.5
set style line 4 lc rgb "#cc79a7" pt 11 lw 1.5
set style line 5 lc rgb "#e69f00" pt 13 lw 1.5

plot 1 lc rgb "gray20" dt 1 title "1: contact costs nothing", \
     1.3 lc rgb "gray40" dt 2 title "1.3", \
     file using (of("direct", "unknowns")):"cpu_time_over_cholesky": \
       "cpu_time_over_cholesky_min":"cpu_time_over_cholesky_max" \
       with yerrorbars ls 1 title "direct path / CHOLMOD", \
     file using (of("multigrid 2D", "unknowns")):"cpu_time_over_levels": \
       "cpu_time_over_levels_min":"cpu_time_over_levels_max" \
       with yerrorbars ls 2 title "multigrid, 2D / same cycle", \
     file using (of("multigrid 2D", "unknowns")):"cpu_time_over_best": \
       "cpu_time_over_best_min":"cpu_time_over_best_max" \
       with yerrorbars ls 3 title "multigrid, 2D / best of the others", \
     file using (of("multigrid 3D", "unknowns")):"cpu_time_over_levels": \
       "cpu_time_over_levels_min":"cpu_time_over_levels_max" \
       with yerrorbars ls 4 title "multigrid, 3D / same cycle", \
     file using (of("multigrid 3D", "unknowns")):"cpu_time_over_best": \
       "cpu_time_over_best_min":"cpu_time_over_best_max" \
       with yerrorbars ls 5 title "multigrid, 3D / best of the others"
