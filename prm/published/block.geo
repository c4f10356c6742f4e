// A block W x H with cells of the size h at y = 0 and |x - c| < f, which grow by s per
// length from there, to m at most.
DefineConstant[ W = 30, H = 30, c = 1, f = 0.1, h = 0.01, s = 0.2, m = 1e9 ];
Point(1) = {0, 0, 0};
Point(2) = {c, 0, 0};
Point(3) = {W, 0, 0};
Point(4) = {W, H, 0};
Point(5) = {0, H, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 1};
Curve Loop(1) = {1, 2, 3, 4, 5};
Plane Surface(1) = {1};
Physical Curve("bottom") = {1, 2};
Physical Curve("right") = {3};
Physical Curve("top") = {4};
Physical Curve("left") = {5};
Physical Surface("block") = {1};
Field[1] = MathEval;
Field[1].F = Sprintf("Min(%g, %.16g + %g * (y + Max(0, Abs(x - %.16g) - %.16g)))", m, h, s, c, f);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
