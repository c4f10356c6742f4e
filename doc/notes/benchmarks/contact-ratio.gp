# SPDX-License-Identifier: LGPL-2.1-or-later
# The cost of contact: the contact solve over one linear solve, against the
# number of unknowns. Called by scripts/benchmarks, where contact_solve.csv is,
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

set title "Contact solve over one linear solve of the same matrix"
set xlabel "unknowns" offset 0, 0.5
set ylabel "ratio (median, from the smallest to the largest)"
set logscale xy
set format x "10^{%L}"
set yrange [0.5:]
set ytics (0.5, 1, 1.2, 1.5, 2, 3, 6, 10, 20, 50)
set grid
set key below spacing 1.2
set style line 1 lc rgb "#0072b2" pt 7 lw 1.5
set style line 2 lc rgb "#d55e00" pt 5 lw 1.5
set style line 3 lc rgb "#009e73" pt 9 lw 1.5
has_multigrid = system("grep -c ',multigrid ' " . file) + 0
set style line 4 lc rgb "#cc79a7" pt 11 lw 1.5

plot 1 lc rgb "gray20" dt 1 title "1: contact costs nothing", \
     1.2 lc rgb "gray40" dt 2 title "1.2", \
     1.5 lc rgb "gray60" dt 3 title "1.5", \
     file using (of("direct", "unknowns")):"time_over_cholesky":\
       "time_over_cholesky_min":"time_over_cholesky_max" \
       with yerrorbars ls 1 title "direct path, time / CHOLMOD", \
     file using (of("direct", "unknowns")):"memory_over_cholesky":\
       "memory_over_cholesky_min":"memory_over_cholesky_max" \
       with yerrorbars ls 2 title "direct path, memory / CHOLMOD", \
     file using (of("multigrid", "unknowns")):"time_over_multigrid":\
       "time_over_multigrid_min":"time_over_multigrid_max" \
       with yerrorbars ls 3 title \
       (has_multigrid ? "multigrid path, time / ML-CG" : ""), \
     file using (of("multigrid", "unknowns")):"memory_over_multigrid":\
       "memory_over_multigrid_min":"memory_over_multigrid_max" \
       with yerrorbars ls 4 title \
       (has_multigrid ? "multigrid path, memory / ML-CG" : "")
