// Cook's membrane as a slab of one layer of tets, n by n cells, as thick as a cell is long.
// Physical groups: volume "membrane"; surfaces "clamped" (x = 0), "loaded" (x = 48 mm), "faces".
DefineConstant[n = 8];  // cells along each side
Point(1) = {0, 0, 0};
Point(2) = {0.048, 0.044, 0};
Point(3) = {0.048, 0.06, 0};
Point(4) = {0, 0.044, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 2, 3, 4} = n + 1;
Transfinite Surface{1};  // one diagonal: alternating ones hide the locking of linear tets
slab() = Extrude {0, 0, 0.048 / n} { Surface{1}; Layers{1}; };
Mesh.MshFileVersion = 4.1;
Physical Volume("membrane") = {slab(1)};
Physical Surface("loaded") = {slab(3)};
Physical Surface("clamped") = {slab(5)};
Physical Surface("faces") = {1, slab(0)};
