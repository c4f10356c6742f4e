# SPDX-License-Identifier: LGPL-2.1-or-later
# What an error costs: the errors of J, of the displacement and of the crack
# length against unknowns and time. Called by scripts/speed-against-error where
# speed_against_error.csv is.
set terminal pngcairo size 1200,900 font "sans,12"
set output "speed-against-error.png"
set datafile separator ","
file = "speed_against_error.csv"
array methods[5] = ["paper's method", "P1 uniform", "P1 refined", \
  "P2 uniform", "P2 refined"]
of(k, name) = strcol("method") eq methods[k] && column(name) > 0 ? \
  column(name) : NaN
set style line 1 lc rgb "#d55e00" pt 5 lw 1.5
set style line 2 lc rgb "#0072b2" pt 6 lw 1.5 dt 2
set style line 3 lc rgb "#0072b2" pt 7 lw 1.5
set style line 4 lc rgb "#009e73" pt 8 lw 1.5 dt 2
set style line 5 lc rgb "#009e73" pt 9 lw 1.5
set logscale xy
set format xy "10^{%L}"
set grid lc rgb "gray85"
set key top right samplen 2 spacing 1.1 font ",10"

set multiplot layout 2,2
set xlabel "unknowns" offset 0, 0.5
set ylabel "relative error of J"
plot for [k = 1:5] file using (of(k, "unknowns")):"J_error" \
  with linespoints ls k title methods[k]
set key off
set xlabel "seconds of all meshes"
plot for [k = 1:5] file using (of(k, "seconds")):"J_error" \
  with linespoints ls k
set ylabel "relative error in the energy norm"
plot for [k = 1:5] file using (of(k, "seconds")):"energy_error" \
  with linespoints ls k
set ylabel "error of the crack length, m"
plot for [k = 1:5] file using (of(k, "seconds")):"crack_length_error" \
  with linespoints ls k
unset multiplot
