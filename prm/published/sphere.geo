// The lower half of a ball of the radius R around (0, R), in the plane of its axis, with
// cells of the size h where it touches the plane y = 0, which grow by s per length beyond
// the distance f.
DefineConstant[ R = 50, h = 0.25, f = 12, s = 0.2 ];
Point(1) = {0, 0, 0};
Point(2) = {R, R, 0};
Point(3) = {0, R, 0};
Circle(1) = {1, 3, 2};
Line(2) = {2, 3};
Line(3) = {3, 1};
Curve Loop(1) = {1, 2, 3};
Plane Surface(1) = {1};
Physical Curve("ball") = {1};
Physical Curve("top") = {2};
Physical Curve("axis") = {3};
Physical Surface("body") = {1};
Field[1] = MathEval;
Field[1].F = Sprintf("%.16g + %g * Max(0, Sqrt(x^2 + y^2) - %.16g)", h, s, f);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeFromCurvature = 0;
