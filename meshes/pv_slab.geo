// Plane case of the fluid paper's figure 4: a slab 5 x 5 cm, 1.2 cm thick, with a square hole, one
// layer of tets between its two faces. The hole is the cavity; caps close it.
// Physical groups: volume "gel"; surfaces "bottom" (y = -5 cm), "top", "left", "right", "faces",
// "wall"; point "needle_point" (middle of the top).
DefineConstant[side = 0.02, h = 0.0025];  // of the hole, edge length [m]
t = 0.012;
Point(1) = {-0.025, -0.05, 0, h};
Point(2) = {0.025, -0.05, 0, h};
Point(3) = {0.025, 0, 0, h};
Point(9) = {0, 0, 0, h};
Point(4) = {-0.025, 0, 0, h};
Point(5) = {-side / 2, -0.025 - side / 2, 0, h};
Point(6) = {side / 2, -0.025 - side / 2, 0, h};
Point(7) = {side / 2, -0.025 + side / 2, 0, h};
Point(8) = {-side / 2, -0.025 + side / 2, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 9};
Line(9) = {9, 4};
Line(4) = {4, 1};
Line(5) = {5, 6};
Line(6) = {6, 7};
Line(7) = {7, 8};
Line(8) = {8, 5};
Curve Loop(1) = {1, 2, 3, 9, 4};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(1) = {1, 2};
out[] = Extrude {0, 0, t} { Surface{1}; Layers{1}; };
Physical Volume("gel") = {out[1]};
Physical Surface("faces") = {1, out[0]};
Physical Surface("bottom") = {out[2]};
Physical Surface("right") = {out[3]};
Physical Surface("top") = {out[4], out[5]};
Physical Surface("left") = {out[6]};
Physical Surface("wall") = {out[7], out[8], out[9], out[10]};
Physical Point("needle_point") = {9};
Mesh.MshFileVersion = 4.1;
