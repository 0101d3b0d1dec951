// Half a ball (radius 15 mm) that touches a block of 6 x 6 x 2 cm with its pole at the origin.
// Volumes "ball", "block". Surfaces "round" (of the ball), "lid" (its flat face), "top", "bottom".
SetFactory("OpenCASCADE");
DefineConstant[h = 0.005];       // edge length [m]
DefineConstant[fine = 0.0015];   // edge length around the contact [m]
r = 0.015;
Sphere(1) = {0, 0, r, r, -Pi/2, 0};
Box(2) = {-0.03, -0.03, -0.02, 0.06, 0.06, 0.02};
Field[1] = Ball;
Field[1].Radius = 0.006;
Field[1].Thickness = 0.01;
Field[1].VIn = fine;
Field[1].VOut = h;
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.Algorithm3D = 1;
Mesh.Optimize = 1;
Mesh.MshFileVersion = 4.1;
e = 1e-6;
Physical Volume("ball") = {1};
Physical Volume("block") = {2};
lid() = Surface In BoundingBox{-r - e, -r - e, r - e, r + e, r + e, r + e};
Physical Surface("lid") = lid();
round() = Abs(Boundary{ Volume{1}; });
round() -= lid();
Physical Surface("round") = round();
Physical Surface("top") = Surface In BoundingBox{-0.03 - e, -0.03 - e, -e, 0.03 + e, 0.03 + e, e};
Physical Surface("bottom") = Surface In BoundingBox{-0.03 - e, -0.03 - e, -0.02 - e, 0.03 + e, 0.03 + e, -0.02 + e};
