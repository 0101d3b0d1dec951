// Two layers of tissue, 6 x 5 x 5 cm: "fat" (2 cm) in front of "muscle" (4 cm).
// Physical surfaces: "skin" (x = 0), "fascia" (between the layers), "far", "bottom".
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 0.02, 0.05, 0.05};
Box(2) = {0.02, 0, 0, 0.04, 0.05, 0.05};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
DefineConstant[h = 0.006];  // edge length [m]
Mesh.CharacteristicLengthMin = h;
Mesh.CharacteristicLengthMax = h;
Mesh.Algorithm3D = 1;
Mesh.Optimize = 1;
Mesh.MshFileVersion = 4.1;
e = 1e-6;
Physical Volume("fat") = {1};
Physical Volume("muscle") = {2};
Physical Surface("skin") = Surface In BoundingBox{-e, -e, -e, e, 0.05 + e, 0.05 + e};
Physical Surface("fascia") = Surface In BoundingBox{0.02 - e, -e, -e, 0.02 + e, 0.05 + e, 0.05 + e};
Physical Surface("far") = Surface In BoundingBox{0.06 - e, -e, -e, 0.06 + e, 0.05 + e, 0.05 + e};
Physical Surface("bottom") = Surface In BoundingBox{-e, -e, -e, 0.06 + e, 0.05 + e, e};
