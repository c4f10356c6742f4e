// A quarter of a plate with a hole: inner radius 10, outer radius 20, in mm.
// n cells across: gmsh -2 -format msh41 -setnumber n 16 ring.geo
DefineConstant[ n = 16 ];
Point(1) = {0, 0, 0};
Point(2) = {10, 0, 0};
Point(3) = {20, 0, 0};
Point(4) = {0, 20, 0};
Point(5) = {0, 10, 0};
Line(1) = {2, 3};
Circle(2) = {3, 1, 4};
Line(3) = {4, 5};
Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = n + 1;
Transfinite Curve{2, 4} = 2 * n + 1;
Transfinite Surface{1};
Recombine Surface{1};
Physical Curve("hole") = {4};
Physical Curve("rim") = {2};
Physical Curve("lower cut") = {1};
Physical Curve("left cut") = {3};
Physical Surface("plate") = {1};
