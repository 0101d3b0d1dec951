// A full bladder in soft tissue, 8 x 6 x 6 cm. The bladder is a volume of its own, to be taken out
// with -cavity_<n>_region.
// Physical groups: volumes "tissue", "bladder"; surfaces "entry" (x = 0), "bottom" (z = 0),
// "back" (x = 8 cm).
SetFactory("OpenCASCADE");
DefineConstant[h = 0.0075, hw = 0.005];  // edge lengths in the block and at the wall [m]
Box(1) = {0, 0, 0, 0.08, 0.06, 0.06};
Sphere(2) = {0.045, 0.03, 0.03, 0.014};
Dilate {{0.045, 0.03, 0.03}, {1, 1.3, 1}} { Volume{2}; }
out() = BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; };
e = 1e-4;
inside() = {out(0)};
whole() = {out(1)};
entry() = Surface In BoundingBox {-e, -e, -e, e, 0.06 + e, 0.06 + e};
bottom() = Surface In BoundingBox {-e, -e, -e, 0.08 + e, 0.06 + e, e};
back() = Surface In BoundingBox {0.08 - e, -e, -e, 0.08 + e, 0.06 + e, 0.06 + e};
Mesh.CharacteristicLengthExtendFromBoundary = 0;
Mesh.CharacteristicLengthFromPoints = 0;
Field[1] = MathEval;  // finer at the wall
Field[1].F = Sprintf("%g + %g * Min(1, Abs(Sqrt(((x-0.045)/0.014)^2 + ((y-0.03)/0.0182)^2 + ((z-0.03)/0.014)^2) - 1))", hw, h - hw);
Background Field = 1;
Mesh.Optimize = 1;
Mesh.MshFileVersion = 4.1;
Physical Volume("tissue") = whole();
Physical Volume("bladder") = inside();
Physical Surface("entry") = entry();
Physical Surface("bottom") = bottom();
Physical Surface("back") = back();
