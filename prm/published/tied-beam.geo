// Two pieces of a beam of the length L and the height H, whose common side is inclined: it
// goes from x = L/2 - e to L/2 + e. Cells of the size h in the first piece and g in the other.
DefineConstant[ L = 100, H = 10, e = 5, h = 1.5, g = 1 ];
Point(1) = {0, 0, 0, h};
Point(2) = {L/2 - e, 0, 0, h};
Point(3) = {L/2 + e, H, 0, h};
Point(4) = {0, H, 0, h};
Point(5) = {L/2 - e, 0, 0, g};
Point(6) = {L, 0, 0, g};
Point(7) = {L, H, 0, g};
Point(8) = {L/2 + e, H, 0, g};
For k In {1 : 8}
  Line(k) = {k, k % 4 == 0 ? k - 3 : k + 1};
EndFor
Curve Loop(1) = {1 : 4};
Curve Loop(2) = {5 : 8};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Physical Curve("fixed") = {4};
Physical Curve("end") = {6};
Physical Curve("one") = {2};
Physical Curve("two") = {8};
Physical Surface("beam") = {1, 2};
