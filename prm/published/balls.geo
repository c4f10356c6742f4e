// Two blocks with a common face in the plane y = 0, half of each behind the plane of symmetry
// z = 0: cells of the size h within the distance f from the origin, which grow by s per length.
SetFactory("OpenCASCADE");
DefineConstant[ L = 8, h = 0.1, f = 1.4, s = 0.4 ];
Box(1) = {-L, 0, 0, 2*L, L, L};
Box(2) = {-L, -L, 0, 2*L, L, L};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
e = 1e-6;
Physical Surface("top") = Surface In BoundingBox {-L-e, L-e, -e, L+e, L+e, L+e};
Physical Surface("bottom") = Surface In BoundingBox {-L-e, -L-e, -e, L+e, -L+e, L+e};
Physical Surface("middle") = Surface In BoundingBox {-L-e, -L-e, -e, L+e, L+e, e};
Physical Volume("body") = {1, 2};
Field[1] = MathEval;
Field[1].F = Sprintf("%g + %g * Max(0, Sqrt(x^2 + y^2 + z^2) - %g)", h, s, f);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.MeshSizeFromCurvature = 0;
