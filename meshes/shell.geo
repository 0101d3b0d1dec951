// Hollow sphere with a fluid inside, for the closed form of Lame: radii 11 and 25 mm.
SetFactory("OpenCASCADE");
// Edge length outside [m], half of it at the wall; 1 for pins; 2 for round walls.
DefineConstant[h = 0.006, pins = 0, order = 2];
Sphere(1) = {0, 0, 0, 0.025};
Sphere(2) = {0, 0, 0, 0.011};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
If(pins)  // points where the axes leave the shell: held across them, it is free but cannot float
  Point(101) = {0.025, 0, 0};
  Point(102) = {0, 0.025, 0};
  Point(103) = {0, 0, 0.025};
  BooleanFragments{ Volume{3}; Delete; }{ Point{101, 102, 103}; Delete; }
  Physical Point("on_x") = Point In BoundingBox {0.0249, -1e-4, -1e-4, 0.0251, 1e-4, 1e-4};
  Physical Point("on_y") = Point In BoundingBox {-1e-4, 0.0249, -1e-4, 1e-4, 0.0251, 1e-4};
  Physical Point("on_z") = Point In BoundingBox {-1e-4, -1e-4, 0.0249, 1e-4, 1e-4, 0.0251};
EndIf
Mesh.CharacteristicLengthExtendFromBoundary = 0;
Mesh.CharacteristicLengthFromPoints = 0;
Field[1] = MathEval;
Field[1].F = Sprintf("%g * (0.5 + 0.5 * (Sqrt(x^2 + y^2 + z^2) - 0.011) / 0.014)", h);
Background Field = 1;
Mesh.Optimize = 1;
Mesh.ElementOrder = order;
Mesh.MshFileVersion = 4.1;
eps = 1e-4;
wall() = Surface In BoundingBox {-0.011 - eps, -0.011 - eps, -0.011 - eps, 0.011 + eps, 0.011 + eps, 0.011 + eps};
outer() = Boundary{ Volume{3}; };
outer() -= {wall()};
Physical Volume("tissue") = {3};
Physical Surface("wall") = wall();
Physical Surface("outer") = outer();
