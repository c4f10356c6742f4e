// Half of a section of a round punch (radius 50, height 100, its edge rounded with the
// radius r = 10) on a cylinder of the radius 100 and the height 200, with x the distance
// from the axis. Beyond x = 50 - r the surfaces part; up to a distance c more they are one
// line here, and the gap between them is in the scene. Cells have the size h at the edge
// of the contact, and grow by s per length from there.
DefineConstant[ r = 10, c = 2.5, h = 0.2, s = 0.1 ];
e = 50 - r;
Point(1) = {0, -200, 0};
Point(2) = {100, -200, 0};
Point(3) = {100, 0, 0};
Point(4) = {e + c, 0, 0};
Point(5) = {e, 0, 0};
Point(6) = {0, 0, 0};
Point(7) = {0, 100, 0};
Point(8) = {50, 100, 0};
Point(9) = {50, r, 0};
Point(10) = {e + c, r - Sqrt(r^2 - c^2), 0};
Point(11) = {e, r, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Line(6) = {6, 1};
Line(7) = {6, 7};
Line(8) = {7, 8};
Line(9) = {8, 9};
Circle(10) = {9, 11, 10};
Line(11) = {10, 4};
Curve Loop(1) = {1, 2, 3, 4, 5, 6};
Curve Loop(2) = {7, 8, 9, 10, 11, 4, 5};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Physical Curve("bottom") = {1};
Physical Curve("top") = {8};
Physical Curve("axis") = {6, 7};
Physical Curve("rest") = {2, 3, 9, 10, 11};
Physical Surface("foundation") = {1};
Physical Surface("punch") = {2};
Field[1] = MathEval;
Field[1].F = Sprintf("%g + %g * Max(0, Sqrt((x - %g)^2 + y^2) - %g)", h, s, e, c);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeFromCurvature = 0;
