// NAFEMS LE10, thick elliptic plate: a quarter, 0.6 m thick, quadratic tets along the ellipses.
// Physical groups: volume "plate"; surfaces "upper" (z = 0.3), "plane_x" (x = 0), "plane_y"
// (y = 0), "outer" (outer ellipse); curve "middle" (outer ellipse at z = 0).
SetFactory("OpenCASCADE");
DefineConstant[h = 0.4, order = 2];  // edge length far from D [m]; a quarter of it at D
Ellipse(1) = {0, 0, -0.3, 3.25, 2.75, 0, Pi / 2};
Ellipse(2) = {0, 0, -0.3, 2, 1, 0, Pi / 2};
Line(3) = {3, 1};
Line(4) = {2, 4};
Curve Loop(1) = {1, 4, -2, 3};
Plane Surface(1) = {1};
// Two layers, so that the middle of the outer face is a line of the mesh.
lower() = Extrude {0, 0, 0.3} { Surface{1}; };
higher() = Extrude {0, 0, 0.3} { Surface{lower(0)}; };
middle() = Abs(Boundary{ Surface{lower(0)}; });
elsewhere() = middle();
elsewhere() -= Abs(Boundary{ Surface{lower(2)}; });
middle() -= elsewhere();
Mesh.CharacteristicLengthExtendFromBoundary = 0;
Mesh.CharacteristicLengthFromPoints = 0;
Field[1] = MathEval;  // finer at D = (2, 0, 0.3)
Field[1].F = Sprintf("%g * Min(1, 0.25 + 0.75 * Sqrt((x-2)^2 + y^2 + (z-0.3)^2))", h);
Background Field = 1;
Mesh.ElementOrder = order;
Mesh.Optimize = 1;
Mesh.MshFileVersion = 4.1;
Physical Volume("plate") = {lower(1), higher(1)};
Physical Surface("upper") = {higher(0)};
Physical Surface("outer") = {lower(2), higher(2)};
Physical Surface("plane_x") = {lower(3), higher(3)};
Physical Surface("plane_y") = {lower(5), higher(5)};
Physical Curve("middle") = {middle()};
