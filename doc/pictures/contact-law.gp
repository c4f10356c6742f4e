# SPDX-License-Identifier: LGPL-2.1-or-later
# The paper's Fig. 6: normal force over normal displacement of each contact
# node, on the graph of the contact law. Called by scripts/pictures with
# `results` and `picture`.
set terminal pngcairo size 1000,500 noenhanced font "sans,11"
set output picture
set datafile separator ","
profile = results . "/contact_profile.csv"

a = 69.0    # GPa/m, bond stiffness of the scene
M = 0.002   # m, bond threshold
h = 0.01    # m, measure of a contact node
stats profile using (1e3*column("normal_force")) name "F" nooutput
stats profile using (1e3*column("u_nu")) name "s" nooutput

set title "Contact law on the benchmark, mesh 40x4"
set grid
set key top left
set xlabel "u_nu [mm]"
set ylabel "normal force of a node [MN per m]"
set xrange [s_min*1.05:1]
set yrange [-2*a*M*h*1e3:F_max*1.1]
$law << EOD
-20,0
-2,0
-2,-1
0,0
0,100
EOD
plot $law using 1:($2 < 0 ? -a*M*h*1e3 : $2) with lines lw 2 lc "gray60" \
       title "what the law allows", \
     profile using (1e3*column("u_nu")):(1e3*column("normal_force")) \
       with points pt 7 ps 0.8 lc "red" title "contact nodes"
