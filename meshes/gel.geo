// Gel block of the needle insertion scene: 15 x 5 x 5 cm, unstructured tets.
// Physical groups: volume "gel"; surfaces "bottom", "top", "entry" (x = 0), "exit", "front", "back".
SetFactory("OpenCASCADE");
// Edge length and length of the block [m]; gmsh -setnumber h 0.005 for a finer one.
DefineConstant[h = 0.0092, length = 0.15];
Box(1) = {0, 0, 0, length, 0.05, 0.05};
Mesh.CharacteristicLengthMin = h;
Mesh.CharacteristicLengthMax = h;
Mesh.Algorithm3D = 1;
Mesh.Optimize = 1;
Mesh.MshFileVersion = 4.1;
Physical Volume("gel") = {1};
Physical Surface("entry") = {1};
Physical Surface("exit") = {2};
Physical Surface("front") = {3};
Physical Surface("back") = {4};
Physical Surface("bottom") = {5};
Physical Surface("top") = {6};
