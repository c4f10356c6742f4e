#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_command_line.sh DEBOND: the options that do not solve anything.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

"$debond" --help >help
for code in 0 1 2 3 4 5; do
  grep -qE "^  $code  " help || fail "--help has no exit code $code"
done

"$debond" --version >version
for line in '^Debond [0-9]+\.[0-9]+\.[0-9]+$' '^revision .+$' \
  '^deal\.II 9\.' '^build type (Release|Debug)$'; do
  grep -qE "$line" version || fail "--version has no line $line"
done

# What is printed can be read and is the same then, also with values that are
# not the defaults.
"$debond" --print-parameters >defaults.prm
"$debond" defaults.prm --print-parameters >again.prm
diff defaults.prm again.prm || fail "The printed defaults read differently."
"$debond" defaults.prm --validate >/dev/null || fail "The defaults are invalid."

"$debond" --print-parameters --set "Dimension=3" \
  --set "Solver/Euclidean bundle/Proximal weight = 0.25" \
  --set "Loads/Traction top=0; if(x<L, q, -q/2); 0" \
  --set "Loads/Constants=q=0.69, L=0.2" >set.prm
grep -qE '^ +set Proximal weight += 0\.25 ' set.prm || fail "--set has no effect."
"$debond" set.prm --print-parameters >again.prm
diff set.prm again.prm || fail "The printed parameters read differently."

# JSON has all that the text has, of families a member NAME.
"$debond" --print-parameters=json set.prm >parameters.json
python3 - <<'CHECK' || fail "JSON"
import json, re
entries = {}
def collect(section, path):
    for name, value in section.items():
        if "default_value" in value:
            entries[path + name] = value
        else:
            collect(value, path + name + "/")
collect(json.load(open("parameters.json")), "")
assert entries["Solver/Euclidean bundle/Proximal weight"]["value"] == "0.25"
assert "Units: force per area" in entries["Loads/Traction NAME"]["documentation"]
text = open("set.prm").read()
assert len(entries) == len(re.findall(r"^ *set |^# .*NAME$", text, re.M))
CHECK
rm parameters.json

# An included file, named from the folder of the one that includes it, and what
# is set again after it; errors name the file they are in.
mkdir parts
cat >parts/base.prm <<'SCENE'
set Dimension = 3
subsection Material
  set Young modulus = 7
  set Poisson ratio = 0.1
end
SCENE
cat >parts/middle.prm <<'SCENE'
include base.prm
subsection Material
  set Poisson ratio = 0.2
end
SCENE
echo 'include parts/middle.prm' >including.prm
"$debond" including.prm --print-parameters >included.prm
for line in 'set Dimension += 3' 'set Young modulus += 7' \
  'set Poisson ratio += 0\.2'; do
  grep -qE "^ *$line( |$)" included.prm || fail "include: no $line"
done
# Files that include another twice are not read 2^n times.
cp parts/middle.prm twice0.prm
for k in $(seq 28); do
  printf 'include twice%d.prm\ninclude twice%d.prm\n' \
    $((k - 1)) $((k - 1)) >twice$k.prm
done
sed -i 's,base.prm,parts/base.prm,' twice0.prm
timeout 20 "$debond" twice28.prm --print-parameters >twice.prm ||
  fail "include twice: exit code $?"
diff included.prm twice.prm || fail "include twice"
sed -i 's/0\.2/0.7/' twice0.prm
expect_code 2 "$debond" twice28.prm
[ "$(grep -c 'Poisson ratio' errors)" -eq 1 ] ||
  fail "an error in a file that is included often: $(head -c 1000 errors)"
rm twice*.prm
echo 'set Colour = red' >>parts/base.prm
expect_code 2 "$debond" including.prm
grep -qE '^debond: parts/base.prm:6: unknown parameter Colour' errors ||
  fail "an error in an included file: $(cat errors)"

# Numbers of cells as numbers, rounding in expressions, what muParser takes for an
# operator, and constants in lists.
expect_code 0 "$debond" defaults.prm --validate --set "Mesh/Cells=20.0, 0.3/0.1" \
  --set "Loads/Traction top=0; if(x<0.1||x>0.3&&y>0, 1, 0)" --set Constants/d=0.001 \
  --set "Contact law/Law=curve" --set "Contact law/Curve=0:0, d:2*d, 2*d:0" \
  --set "Contact law/Bond stiffness=" --set "Contact law/Bond threshold="

# An include behind what it sets again would undo that; a comment that ends in a
# backslash does not swallow the next line.
printf 'set Dimension = 3\n' >base.prm
printf 'set Dimension = 2\ninclude base.prm\n' >undone.prm
expect_code 2 "$debond" undone.prm
grep -qx "debond: undone.prm:2: include base.prm sets Dimension again, after undone.prm:1: put include first" errors ||
  fail "include behind: $(cat errors)"
printf '# in C:\\parts\\\nset Dimension = 3\n' >comment.prm
expect_code 0 "$debond" comment.prm --print-parameters
grep -q '^set Dimension *= 3' log || fail "a backslash in a comment"
expect_code 0 "$debond" /dev/stdin --print-parameters <base.prm
grep -q '^set Dimension *= 3' log || fail "a scene from a pipe"
mkdir -p one two
cp base.prm one
cp base.prm two
expect_code 2 "$debond" one/base.prm two/base.prm --set "Dimension=2" --set "Mesh/Cells=4, 1"
grep -q "two/base.prm: the output directory output/base is that of one/base.prm" errors ||
  fail "one directory of two scenes: $(cat errors)"
rm -r one two output base.prm undone.prm comment.prm

# Every parameter says its units.
entries=$(grep -cE '^ *set |^# .* NAME$|^# [A-Za-z]+/NAME$' defaults.prm)
units=$(tr -d '\n' <defaults.prm | tr -s '# ' ' ' | grep -o 'Units:' | wc -l)
[ "$entries" -eq "$units" ] || fail "$entries entries, but $units with units"

# What is wrong with a file is said for what it is.
expect_code 2 "$debond" missing.prm
grep -qx "debond: missing.prm: there is no such file" errors ||
  fail "a missing file: $(cat errors)"
cat >study.prm <<'STUDY'
subsection Study
  set Scene = scene.prm
end
STUDY
expect_code 2 "$debond" study.prm
grep -qx "debond: study.prm:1: unknown subsection Study; .*scripts/study" errors ||
  fail "a study: $(cat errors)"
cp study.prm study.geo
expect_code 2 "$debond" study.geo
grep -qx "debond: study.geo: this is a mesh or a geometry; .* Mesh/File, .*" errors ||
  fail "a geometry: $(cat errors)"
expect_code 2 "$debond" --study study.prm
grep -q "scripts/study" errors || fail "--study: $(cat errors)"
printf '\xef\xbb\xbfset Dimension = 3\n' >mark.prm
expect_code 0 "$debond" mark.prm --print-parameters
grep -qE '^set Dimension += 3 ' log ||
  fail "a file that begins with the mark of UTF-8"
{
  echo 'subsection Load path'
  echo "  set Factors = $(seq -s, 100000)"
  echo 'end'
} >long.prm
expect_code 2 "$debond" long.prm
[ "$(wc -c <errors)" -lt 300 ] || fail "a message of $(wc -c <errors) letters"
rm -r study.* mark.prm long.prm parts including.prm included.prm

# refused TEXT ARGUMENTS: soon, with little memory, and with a message in which
# there are no control characters.
refused() {
  local text=$1
  shift
  expect_code 2 prlimit --as=$((2000 * 1024 * 1024)) timeout 120 "$debond" "$@"
  grep -qF -- "$text" errors || fail "$text: $(cat errors)"
  ! grep -qP '[\x00-\x09\x0b-\x1f\x7f]|\xc2[\x80-\x9f]' errors ||
    fail "control characters: $(cat -v errors)"
}

# Names that are none of a folder, or that a terminal obeys.
for name in ...prm ..prm $'a\nb.prm' $'a\x1b[31m.prm' $'a\xc2\x9b31m.prm'; do
  : >"$name"
  refused "no scene may have this name" "$name"
  rm -- "$name"
done
: >plain.prm
for value in $'Output/Directory=a\nb' $'Output/Directory=\x1b]0;title' \
  $'Probes/na\x7fme=0, 0' $'Boundary conditions/Contact boundary=\x1b[2J' \
  $'\x1b[2J=1'; do
  refused "--set: " plain.prm --set "$value"
done

refused "--set: unknown parameter Solver/Euclidean bundle/Proximal wieght; did you \
mean Solver/Euclidean bundle/Proximal weight?" plain.prm \
  --set "Solver/Euclidean bundle/Proximal wieght=1"
refused "--set: cannot read 'Material/Young modulus': expected Section/Parameter=value" \
  plain.prm --set "Material/Young modulus"
refused "--set: Material/Young modulus = -3: expected a number from 1e-100 to 1e100" \
  plain.prm --set "Material/Young modulus=-3"
refused "--set: unknown parameter Proximal weight; did you mean Solver/Euclidean" \
  plain.prm --set "Proximal weight=1"
refused "unrecognised option '--validat'; see debond --help" plain.prm --validat

# Files that do not end, or never begin.
mkfifo pipe
refused "/dev/zero: cannot be read as a scene file" /dev/zero
for file in /dev/zero pipe .; do
  refused "cannot be read" plain.prm --set Mesh/Source=file \
    --set "Mesh/File=$file"
  refused "is not the displacement" plain.prm \
    --set "Solver/Euclidean bundle/Start=$file" --set "Solver/Method=euclidean bundle"
done
rm pipe

# A number of cells beyond all memory, of which the product has no 32 bits.
refused "there is not enough memory" plain.prm --set "Mesh/Cells=300000, 200000" \
  --set "Solver/Memory limit=1e30"

# What is wrong with the groups of a mesh, and with what scenes name.
# mesh NAMES ELEMENTS: two triangles, 2 x 1, between six nodes, as mesh.msh.
mesh() {
  {
    printf '%s\n' '$MeshFormat' '2.2 0 8' '$EndMeshFormat' '$PhysicalNames' \
      "$1" '$EndPhysicalNames' '$Nodes' 4 '1 0 0 0' '2 2 0 0' '3 2 1 0' '4 0 1 0' \
      '$EndNodes' '$Elements' "$2" '$EndElements'
  } >mesh.msh
}
file=(plain.prm --set Mesh/Source=file --set Mesh/File=mesh.msh)
mesh 0 $'2\n1 2 2 0 1 1 2 3\n2 2 2 0 1 1 3 4'
refused "physical groups of curves" "${file[@]}"
mesh $'2\n1 7 "seam"\n2 8 "half"' \
  $'4\n1 1 2 7 1 1 3\n2 2 2 8 1 1 2 3\n3 2 2 9 1 1 3 4\n4 1 2 5 1 1 2'
refused "no boundary seam, but 5; the group of this name lies inside" \
  "${file[@]}" --set "Boundary conditions/Contact boundary=seam"
refused "no boundary half, but 5; the region of this name" \
  "${file[@]}" --set "Boundary conditions/Clamped boundaries=half"
# Commas separate names, but for those of a name.
mesh $'3\n1 5 "id: 1, side: 2"\n1 6 "id: 1, side: 3"\n1 7 "side: 2"' \
  $'5\n1 1 2 5 1 4 1\n2 1 2 6 1 1 2\n3 1 2 7 1 2 3\n4 2 2 8 1 1 2 3\n5 2 2 8 1 1 3 4'
file+=(--validate --set "Boundary conditions/Contact boundary=id: 1,side: 3")
expect_code 0 "$debond" "${file[@]}" --set \
  "Boundary conditions/Clamped boundaries=side: 2, id: 1, side: 2"
refused "the side id: 1, side: 3 is clamped already" "${file[@]}" --set \
  "Boundary conditions/Clamped boundaries=id: 1, side: 2, id: 1, side: 3"
rm log errors plain.prm mesh.msh

[ "$(ls)" = "$(printf '%s\n' again.prm defaults.prm help set.prm version)" ] ||
  fail "Files were written."
