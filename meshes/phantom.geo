// Gelatin phantom of the fluid paper, as far as it is described: a block between two plates with a
// fluid-filled glove fingertip, here an ellipsoid. Sizes are ours (docs/scenes.md).
// Physical groups: volume "gel"; surfaces "probe" (x = 0), "stage" (x = 6 cm), "bottom", "top",
// "sides", "wall"; point "pin" (middle of the bottom edge at the probe).
SetFactory("OpenCASCADE");
DefineConstant[h = 0.0052, hw = 0.0048];  // edge lengths in the block and at the wall [m]
Box(1) = {0, 0, 0, 0.06, 0.05, 0.05};
Sphere(2) = {0.03, 0.025, 0.025, 0.01};
Dilate {{0.03, 0.025, 0.025}, {1, 1.5, 1}} { Volume{2}; }
BooleanDifference(4) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Point(100) = {0, 0, 0.025};
body() = BooleanFragments{ Volume{4}; Delete; }{ Point{100}; Delete; };
eps = 1e-4;
probe() = Surface In BoundingBox {-eps, -eps, -eps, eps, 0.05 + eps, 0.05 + eps};
stage() = Surface In BoundingBox {0.06 - eps, -eps, -eps, 0.06 + eps, 0.05 + eps, 0.05 + eps};
bottom() = Surface In BoundingBox {-eps, -eps, -eps, 0.06 + eps, eps, 0.05 + eps};
top() = Surface In BoundingBox {-eps, 0.05 - eps, -eps, 0.06 + eps, 0.05 + eps, 0.05 + eps};
front() = Surface In BoundingBox {-eps, -eps, -eps, 0.06 + eps, 0.05 + eps, eps};
back() = Surface In BoundingBox {-eps, -eps, 0.05 - eps, 0.06 + eps, 0.05 + eps, 0.05 + eps};
wall() = Boundary{ Volume{body(0)}; };
wall() -= {probe(), stage(), bottom(), top(), front(), back()};
pin() = Point In BoundingBox {-eps, -eps, 0.025 - eps, eps, eps, 0.025 + eps};
Mesh.CharacteristicLengthExtendFromBoundary = 0;
Mesh.CharacteristicLengthFromPoints = 0;
Field[1] = MathEval;  // finer at the wall
Field[1].F = Sprintf("%g + %g * Min(1, Abs(Sqrt(((x-0.03)/0.01)^2 + ((y-0.025)/0.015)^2 + ((z-0.025)/0.01)^2) - 1))", hw, h - hw);
Background Field = 1;
Mesh.Optimize = 1;
Mesh.MshFileVersion = 4.1;
Physical Volume("gel") = {body(0)};
Physical Surface("probe") = probe();
Physical Surface("stage") = stage();
Physical Surface("bottom") = bottom();
Physical Surface("top") = top();
Physical Surface("sides") = {front(), back()};
Physical Surface("wall") = wall();
Physical Point("pin") = pin();
