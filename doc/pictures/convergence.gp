# SPDX-License-Identifier: LGPL-2.1-or-later
# The paper's Fig. 7: objective against iteration. Called by scripts/pictures
# with `results` and `picture`.
set terminal pngcairo size 1000,500 noenhanced font "sans,11"
set output picture
set datafile separator ","
history = results . "/history.csv"

stats history using "functional" name "J" nooutput
set title "Proximal bundle method on the benchmark, mesh 40x4"
set logscale xy
set grid
set format y "10^{%L}"
set terminal pngcairo enhanced
set xlabel "iteration k"
set ylabel "relative to |J(x_K)|"
set key bottom left
plot history using "iteration":(column("functional") > J_min ? \
       (column("functional") - J_min)/abs(J_min) : NaN) with lines lw 2 \
       title "J(x_k) - J(x_K), x_K the last iterate", \
     history using "iteration":(-column("v")/abs(J_min)) with lines lw 1 \
       lc "gray60" title "-v_k, the predicted descent"
