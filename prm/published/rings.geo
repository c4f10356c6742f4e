// A quarter of two rings, a < r < b and b < r < c, whose meshes do not match: cells have the
// size h inside, g outside and G at the rim; with a = 0 the inner ring is a disc. Around the
// axis x = 0 they are hollow spheres.
DefineConstant[ a = 0.2, b = 0.6, c = 1, h = 0.03, g = 0.05, G = g ];
radii[] = {a, b, b, c};
sizes[] = {h, h, g, G};
Point(1) = {0, 0, 0, h};
For k In {(a > 0 ? 0 : 1) : 3}
  Point(10 + k) = {radii[k], 0, 0, sizes[k]};
  Point(20 + k) = {0, radii[k], 0, sizes[k]};
  Circle(10 + k) = {10 + k, 1, 20 + k};
EndFor
Line(21) = {12, 13};
Line(31) = {22, 23};
If (a > 0)
  Line(20) = {10, 11};
  Line(30) = {20, 21};
  Curve Loop(1) = {20, 11, -30, -10};
  Physical Curve("bore") = {10};
Else
  Line(20) = {1, 11};
  Line(30) = {1, 21};
  Curve Loop(1) = {20, 11, -30};
EndIf
Curve Loop(2) = {21, 13, -31, -12};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Physical Curve("rim") = {13};
Physical Curve("bottom") = {20, 21};
Physical Curve("left") = {30, 31};
Physical Surface("inner") = {1};
Physical Surface("outer") = {2};
Mesh.MeshSizeFromCurvature = 0;
