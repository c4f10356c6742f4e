# SPDX-License-Identifier: LGPL-2.1-or-later
# The paper's Fig. 5: normal force of each node and displacement along the
# contact boundary. Called by scripts/pictures with `results` and `picture`.
set terminal pngcairo size 1000,700 noenhanced font "sans,11"
set output picture
set datafile separator ","
profile = results . "/contact_profile.csv"

set multiplot layout 2,1 title "Contact boundary of the benchmark, mesh 40x4"
set grid
set xzeroaxis lt -1
set format y "%6.2f"
set key top left
set ylabel "u_nu [mm]"
set arrow from graph 0, first -2 to graph 1, first -2 nohead dt 2 lc "gray40"
set label "bonds break at -M" at graph 0.6, first -2.5 textcolor "gray40"
plot profile using "x":(1e3*column("u_nu")) with linespoints pt 7 ps 0.6 \
     title "normal displacement (negative: lifted off)"
unset arrow
unset label
set xlabel "x [m]"
set ylabel "force [MN per m]"
plot profile using "x":(1e3*column("normal_force")) with impulses lw 2 \
     title "normal force of each node (positive: pressed, negative: held)"
unset multiplot
