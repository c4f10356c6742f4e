# SPDX-License-Identifier: LGPL-2.1-or-later
# Normal displacement and force along the contact boundary of a plane body.
# Called by scripts/picture with `results` and `picture`.
set terminal pngcairo size 1000,700 noenhanced font "sans,11"
set output picture
set datafile separator ","
profile = results . "/contact_profile.csv"

# Along the axis in which it is longest.
stats profile using "x" name "X" nooutput
stats profile using "y" name "Y" nooutput
axis = X_max - X_min >= Y_max - Y_min ? "x" : "y"

set multiplot layout 2,1
set grid
set xzeroaxis lt -1
set format y "%8.2e"
set lmargin 14
set ylabel "normal displacement"
plot profile using axis:"u_nu" with linespoints pt 7 ps 0.6 notitle
set xlabel axis
set ylabel "force per length"
plot profile using axis:"normal_force_density" with linespoints pt 7 ps 0.6 \
     title "positive: pressed, negative: held"
unset multiplot
