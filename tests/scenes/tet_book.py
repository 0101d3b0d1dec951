"""Linear elasticity of linear and quadratic tets as in textbooks, dense, in NumPy.

Shares nothing with the program but the mesh: B and C matrices, loads by Gauss points of high
degree.
Also the body that it and CalculiX are compared on.
"""
import os
import subprocess

import h5py
import numpy as np

import harness

# A cylinder of two materials: flat top, curved side, unstructured tets.
GEOMETRY = """SetFactory("OpenCASCADE");
Cylinder(1) = {0, 0, 0, 0, 0, 0.02, 0.02};
Cylinder(2) = {0, 0, 0.02, 0, 0, 0.03, 0.02};
body() = BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; };
skin() = CombinedBoundary{ Volume{body()}; };
bottom() = Surface In BoundingBox {-1, -1, -1e-4, 1, 1, 1e-4};
top() = Surface In BoundingBox {-1, -1, 0.0499, 1, 1, 1};
skin() -= {bottom(), top()};
Mesh.CharacteristicLengthMin = 0.016;
Mesh.CharacteristicLengthMax = 0.016;
Physical Volume("lower") = {body(0)};
Physical Volume("upper") = {body(1)};
Physical Surface("bottom") = {bottom()};
Physical Surface("top") = {top()};
Physical Surface("skin") = {skin()};
"""
RADIUS, HEIGHT = 0.02, 0.05
YOUNG, POISSON, DENSITY = (5000.0, 20000.0), (0.3, 0.4), (1000.0, 1500.0)
GRAVITY, TRACTION = np.array([1.0, -2.0, -9.81]), np.array([30.0, -20.0, 50.0])
EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
FACES = ((1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1))


class Body:
    """Mesh and displacement of a run."""

    def __init__(self, folder):
        with h5py.File(os.path.join(folder, "run.h5")) as run:
            self.x, self.tets = run["mesh/coordinates"][:], run["mesh/tets"][:]
            self.region = run["mesh/region"][:]
        last = sorted(os.listdir(os.path.join(folder, "fields")))[-1]
        with h5py.File(os.path.join(folder, "fields", last)) as step:
            self.u = step["displacement"][:]
            self.energy, self.stress = step["strain_energy"][:], step["stress"][:]
        self.held = np.flatnonzero(np.abs(self.x[:, 2]) < 1e-9)

    def faces(self, surface):
        """Nodes of the tets' faces on "top" or "skin", in VTK's order."""
        count = {}
        for tet in self.tets:
            for face in FACES:
                count.setdefault(tuple(sorted(tet[list(face)])), []).append((tet, face))
        z, r = self.x[:, 2], np.hypot(self.x[:, 0], self.x[:, 1])
        at_top, at_side = np.abs(z - HEIGHT) < 1e-9, np.abs(r - RADIUS) < 1e-9
        found = []
        for corners, owners in count.items():
            end = at_top[list(corners)].all() or (z[list(corners)] < 1e-9).all()
            wanted = at_top if surface == "top" else at_side
            if len(owners) > 1 or not wanted[list(corners)].all() or (surface == "skin" and end):
                continue
            tet, face = owners[0]
            middles = [4 + k for a, b in zip(face, face[1:] + face[:1])
                       for k, edge in enumerate(EDGES) if {a, b} == set(edge)]
            found.append(tet[list(face) + (middles if len(tet) == 10 else [])])
        return found


def solved(element, order=1, surface="top"):
    """The program's displacement of the body, its mesh of the order given."""
    path = os.path.join(harness.MESHES, f"body_{order}.msh")
    if not os.path.exists(path):
        text = harness.written("body.geo", GEOMETRY)
        words = ["gmsh", "-3", text, "-order", str(order), "-o", path, "-format", "msh41"]
        subprocess.run(words, check=True, capture_output=True)
    settings = {"-mesh": path, "-analysis": "static", "-fix": "bottom", "-tissue_model": "linear",
                "-tissue_element": element,
                "-output_fields": "displacement,stress,strain_energy",
                "-gravity": ",".join(map(str, GRAVITY)),
                f"-boundary_{surface}_traction": ",".join(map(str, TRACTION))}
    for k, volume in enumerate(("lower", "upper")):
        settings |= {f"-tissue_{volume}_young": repr(YOUNG[k]),
                     f"-tissue_{volume}_poisson": repr(POISSON[k]),
                     f"-tissue_{volume}_density": repr(DENSITY[k])}
    return Body(harness.completed(settings))


def shape(at, nodes):
    """Shape functions of a triangle or tet at barycentric coordinates, and derivatives by these."""
    if nodes == len(at):
        return at, np.eye(nodes)
    edges = EDGES[:nodes - len(at)]
    by = np.zeros((nodes, len(at)))
    by[:len(at)] = np.diag(4 * at - 1)
    for row, (a, b) in zip(by[len(at):], edges):
        row[a], row[b] = 4 * at[b], 4 * at[a]
    return np.concatenate([at * (2 * at - 1), [4 * at[a] * at[b] for a, b in edges]]), by


def fine_rule(corners, count=10):
    """Points and weights (sum 1) on a triangle or tet: Gauss-Legendre in collapsed coordinates."""
    g, w = np.polynomial.legendre.leggauss(count)
    g, w = 0.5 * (1 + g), 0.5 * w
    rule = [(np.array([1.0]), 1.0)]
    for d in range(1, corners):
        rule = [(np.append((1 - s) * at, s), weight * v * d * (1 - s)**(d - 1))
                for at, weight in rule for s, v in zip(g, w)]
    return rule


def four_points():
    a = (5 + 3 * 5**0.5) / 20
    return [(np.full(4, (1 - a) / 3) + (a - (1 - a) / 3) * np.eye(4)[k], 0.25) for k in range(4)]


def gradients(x, at):
    """Gradients of the shape functions (nodes, 3) and the volume of the tet at that Jacobian."""
    _, by = shape(at, len(x))
    free = by[:, 1:] - by[:, :1]
    jacobian = x.T @ free
    return free @ np.linalg.inv(jacobian), np.linalg.det(jacobian) / 6


def strain_matrix(g):
    B = np.zeros((6, 3 * len(g)))
    for k, row in enumerate(g.T):
        B[k, k::3] = row
    for k, (i, j) in enumerate(((0, 1), (1, 2), (2, 0))):
        B[3 + k, i::3], B[3 + k, j::3] = g[:, j], g[:, i]
    return B


def stiffness(body, element):
    """Dense stiffness. The averaged dilatations are those of docs/theory.md section 2."""
    n = len(body.x)
    K = np.zeros((3 * n, 3 * n))
    sums, measures = {}, {}
    for tet, (nodes, region) in enumerate(zip(body.tets, body.region)):
        mu = YOUNG[region] / (2 + 2 * POISSON[region])
        bulk = 2 * mu * POISSON[region] / (1 - 2 * POISSON[region])
        inside = {"p1": bulk, "p2": bulk, "p2_anp": min(bulk, 10 * mu)}.get(element, 0.0)
        dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
        for at, weight in [(np.full(4, 0.25), 1.0)] if len(nodes) == 4 else four_points():
            g, volume = gradients(body.x[nodes], at)
            B, V = strain_matrix(g), weight * volume
            C = np.diag(mu * np.array([2, 2, 2, 1, 1, 1.0]))
            C[:3, :3] += inside
            K[np.ix_(dofs, dofs)] += V * B.T @ C @ B
            shares = [(tet, 1.0)] if element == "p2_bbar" else \
                [((nodes[a], region), at[a]) for a in range(4)]
            for place, share in shares:
                _, row = sums.setdefault(place, (bulk - inside, np.zeros(3 * n)))
                row[dofs] += share * V * g.ravel()
                measures[place] = measures.get(place, 0.0) + share * V
    for place, (rest, row) in sums.items():
        if rest > 0.0:
            K += rest / measures[place] * np.outer(row, row)
    return K


def stored(body):
    """Strain energy [J] and stress times volume [N m] that the tets' outputs add up to."""
    volume = np.array([sum(w * gradients(body.x[tet], at)[1] for at, w in four_points())
                       for tet in body.tets])
    return volume @ body.energy, volume @ body.stress


def traction_loads(body, surface):
    f = np.zeros(body.x.shape)
    for face in body.faces(surface):
        for at, weight in fine_rule(3):
            N, by = shape(at, len(face))
            along = body.x[face].T @ (by[:, 1:] - by[:, :1])
            area = 0.5 * np.linalg.norm(np.cross(along[:, 0], along[:, 1]))
            f[face] += weight * area * N[:, None] * TRACTION
    return f.ravel()


def weights(body):
    f = np.zeros(body.x.shape)
    rule = fine_rule(4, 5)
    for nodes, region in zip(body.tets, body.region):
        for at, weight in rule:
            mass = weight * gradients(body.x[nodes], at)[1] * DENSITY[region]
            f[nodes] += mass * shape(at, len(nodes))[0][:, None] * GRAVITY
    return f.ravel()


def solution(body, K, f):
    """Displacement with the bottom held."""
    free = np.setdiff1d(np.arange(f.size), (3 * body.held[:, None] + np.arange(3)).ravel())
    u = np.zeros(f.size)
    u[free] = np.linalg.solve(K[np.ix_(free, free)], f[free])
    return u.reshape(-1, 3)


def difference(u, reference):
    return np.abs(u - reference).max() / np.abs(reference).max()
