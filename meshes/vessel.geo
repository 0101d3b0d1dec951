// A vessel through a block 6 x 4 x 4 cm and a cyst beside it.
// Physical groups: volume "tissue"; surfaces "bottom" (z = 0), "ends" (x = 0 and 6 cm), "vessel",
// "cyst"; the vessel is open at both ends.
SetFactory("OpenCASCADE");
DefineConstant[h = 0.005, hw = 0.0022];  // edge lengths in the block and at the walls [m]
Box(1) = {0, 0, 0, 0.06, 0.04, 0.04};
Cylinder(2) = {-0.01, 0.013, 0.02, 0.08, 0, 0, 0.004};
Sphere(3) = {0.03, 0.028, 0.02, 0.006};
BooleanDifference(4) = { Volume{1}; Delete; }{ Volume{2, 3}; Delete; };
e = 1e-4;
bottom() = Surface In BoundingBox {-e, -e, -e, 0.06 + e, 0.04 + e, e};
left() = Surface In BoundingBox {-e, -e, -e, e, 0.04 + e, 0.04 + e};
right() = Surface In BoundingBox {0.06 - e, -e, -e, 0.06 + e, 0.04 + e, 0.04 + e};
vessel() = Surface In BoundingBox {-e, 0.008, 0.015, 0.06 + e, 0.018, 0.025};
top() = Surface In BoundingBox {-e, -e, 0.04 - e, 0.06 + e, 0.04 + e, 0.04 + e};
front() = Surface In BoundingBox {-e, -e, -e, 0.06 + e, e, 0.04 + e};
back() = Surface In BoundingBox {-e, 0.04 - e, -e, 0.06 + e, 0.04 + e, 0.04 + e};
cyst() = Boundary{ Volume{4}; };
cyst() -= {bottom(), left(), right(), vessel(), top(), front(), back()};
Mesh.CharacteristicLengthExtendFromBoundary = 0;
Mesh.CharacteristicLengthFromPoints = 0;
Field[1] = MathEval;  // finer at the walls
Field[1].F = Sprintf("%g + %g * Min(1, Min(Abs(Sqrt((y-0.013)^2 + (z-0.02)^2) - 0.004), Abs(Sqrt((x-0.03)^2 + (y-0.028)^2 + (z-0.02)^2) - 0.006)) / 0.01)", hw, h - hw);
Background Field = 1;
Mesh.Optimize = 1;
Mesh.MshFileVersion = 4.1;
Physical Volume("tissue") = {4};
Physical Surface("bottom") = bottom();
Physical Surface("ends") = {left(), right()};
Physical Surface("vessel") = vessel();
Physical Surface("cyst") = cyst();
