// Block 5 x 5 x 1.2 cm with a closed cavity of square section (fluid paper, figure 4, in 3D).
// Physical groups: volume "gel"; surfaces "bottom" (y = -5 cm), "top", "left", "right", "faces",
// "wall".
SetFactory("OpenCASCADE");
DefineConstant[side = 0.02, depth = 0.006, h = 0.0025];  // of the cavity, edge length [m]
Box(1) = {-0.025, -0.05, 0, 0.05, 0.05, 0.012};
Box(2) = {-side / 2, -0.025 - side / 2, 0.006 - depth / 2, side, side, depth};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
e = 1e-4;
bottom() = Surface In BoundingBox {-0.025 - e, -0.05 - e, -e, 0.025 + e, -0.05 + e, 0.012 + e};
top() = Surface In BoundingBox {-0.025 - e, -e, -e, 0.025 + e, e, 0.012 + e};
left() = Surface In BoundingBox {-0.025 - e, -0.05 - e, -e, -0.025 + e, e, 0.012 + e};
right() = Surface In BoundingBox {0.025 - e, -0.05 - e, -e, 0.025 + e, e, 0.012 + e};
front() = Surface In BoundingBox {-0.025 - e, -0.05 - e, -e, 0.025 + e, e, e};
back() = Surface In BoundingBox {-0.025 - e, -0.05 - e, 0.012 - e, 0.025 + e, e, 0.012 + e};
wall() = Surface In BoundingBox {-0.024, -0.049, 0.001, 0.024, -0.001, 0.011};
Mesh.CharacteristicLengthMin = h;
Mesh.CharacteristicLengthMax = h;
Mesh.Optimize = 1;
Mesh.MshFileVersion = 4.1;
Physical Volume("gel") = {3};
Physical Surface("bottom") = bottom();
Physical Surface("top") = top();
Physical Surface("left") = left();
Physical Surface("right") = right();
Physical Surface("faces") = {front(), back()};
Physical Surface("wall") = wall();
