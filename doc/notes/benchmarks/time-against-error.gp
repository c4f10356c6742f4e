# SPDX-License-Identifier: LGPL-2.1-or-later
# What an error costs: time of the solve against the error of J, for all meshes
# and methods. Called by scripts/benchmarks, where speed_against_error.csv is,
# with `format`.
if (format eq "svg") {
  set terminal svg size 800,500 font "sans,13" background "white"
} else {
  set terminal pngcairo size 1000,625 font "sans,13"
}
set output "time-against-error." . format
set datafile separator ","
file = "speed_against_error.csv"
of(method, name) = strcol("method") eq method ? column(name) : NaN

set title "Time of the contact solve against its error, one point a mesh"
set xlabel "J(u) - J, discretisation and optimisation error together" offset 0, 0.5
set ylabel "time of the solve, s"
set logscale xy
set format xy "10^{%L}"
set xrange [*:*] reverse
set grid
set key below spacing 1.2
set style line 1 lc rgb "#0072b2" pt 7 lw 1.5
set style line 2 lc rgb "#d55e00" pt 5 lw 1.5
set style line 3 lc rgb "#009e73" pt 9 lw 1.5

# A line of slope -1 through the last point of the last method.
stats file using "J_total_error":"seconds" nooutput name "all"
reference(x) = all_min_y * (all_max_x / x)

plot file using (of("euclidean bundle", "J_total_error")):"seconds" \
       with linespoints ls 2 title "euclidean bundle (the paper)", \
     file using (of("energy bundle", "J_total_error")):"seconds" \
       with linespoints ls 3 title "energy bundle", \
     file using (of("majorise minimise", "J_total_error")):"seconds" \
       with linespoints ls 1 title "majorise minimise", \
     file using (of("euclidean bundle", "J_total_error")):\
       "seconds_good_enough" with points ls 2 pt 4 title \
       "euclidean bundle, until iterating on is pointless", \
     reference(x) lc rgb "gray50" dt 2 title \
       "slope -1: half the error in twice the time", \
     file using (of("majorise minimise", "J_total_error")):"seconds":"mesh" \
       with labels offset 0,-1.2 notitle
