"""Scenes of work_precision: how they are meshed and run, and what their error is."""
import subprocess

import h5py
import numpy as np

from common import ROOT
from quantities import interpolate
from remesh import MIDDLES, last_fields

TARGET = np.array([0.035, 0.0445, 0.0291])  # 2.1 cm beside the path
INNER, OUTER, YOUNG = 0.011, 0.025, 15000.0
PINS = "on_x:yz,on_y:xz,on_z:xy"
GEL = ("entry", "exit", "front", "back", "bottom", "top")
P1 = ("p1", "p1 ksp", "p1_anp")
P2 = ("p2", "p2_bbar", "p2_anp")
# The second word of a method and what it changes; None takes an option of the scene away.
WAYS = {"ksp": {"compliance_provider": "ksp"},
        "uncorrected": {"insertion_radius_correction": None},
        "line": {"insertion_radius_correction": None, "insertion_placement": "line"}}


def moduli(poisson):
    """Bulk and shear modulus [Pa]."""
    return YOUNG / (3 - 6 * poisson), YOUNG / (2 + 2 * poisson)


def free_shell(poisson):
    """u(a)/a of a free hollow sphere under 1 Pa (Lame)."""
    bulk, shear = moduli(poisson)
    return (INNER / OUTER) ** 3 / (1 - (INNER / OUTER) ** 3) * (
        1 / (3 * bulk) + (OUTER / INNER) ** 3 / (4 * shear))


# Eshelby's liquid sphere under the remote strain e + theta/3 I, as in tests/verify.
STRAIN, THETA = np.diag([2e-4, -1e-4, -1e-4]), -4e-5


def liquid_sphere(x, poisson):
    r = np.linalg.norm(x, axis=1)[:, None]
    first, second = (5 * INNER**3 / (2 * (7 - 5 * poisson)), 3 * INNER**5 / (2 * (7 - 5 * poisson)))
    ex = x @ STRAIN
    xex = (x * ex).sum(axis=1)[:, None]
    return (ex + first * ((2 - 4 * poisson) * ex / r**3 + 3 * x * xex / r**5)
            + second * (2 * ex / r**5 - 5 * x * xex / r**7) + THETA / 3 * (1 - (INNER / r) ** 3) * x)


def manufactured(x, poisson, k=40.0, size=1e-5):
    """(3 - 4 nu) psi - x_j grad psi_j with three harmonic functions psi_j: in equilibrium without
    forces (Papkovich and Neuber)."""
    cos, sin, grow = np.cos(k * x), np.sin(k * x), np.exp(k * x)
    found = np.zeros_like(x)
    for j in range(3):  # psi_j = cos(k x_j) exp(k x_b)
        b = (j + 1) % 3
        found[:, j] += (3 - 4 * poisson) * cos[:, j] * grow[:, b]
        found[:, j] += x[:, j] * k * sin[:, j] * grow[:, b]
        found[:, b] -= x[:, j] * k * cos[:, j] * grow[:, b]
    return size * found


def node_tags(mesh):
    """Tags and places of all nodes of a mesh in Gmsh's format 4.1."""
    tags, places = [], []
    with open(ROOT / mesh) as stream:
        while stream.readline().strip() != "$Nodes":
            pass
        for _ in range(int(stream.readline().split()[0])):
            count = int(stream.readline().split()[-1])
            tags += [int(stream.readline()) for _ in range(count)]
            places += [stream.readline().split() for _ in range(count)]
    return np.array(tags), np.array(places, float)


def written_field(mesh, folder, field):
    """CSV of a displacement at all nodes; the program takes those of the surface it is given to."""
    tag, x = node_tags(mesh)
    np.savetxt(folder / "field.csv", np.column_stack([tag, field(x)]), fmt=["%d"] + ["%.17g"] * 3,
               delimiter=",", header="node,x,y,z", comments="")
    return folder / "field.csv"


def quadrature():
    """64 barycentric points and weights (sum 1) of a tet, exact to degree 5."""
    g, w = np.polynomial.legendre.leggauss(4)
    g, w = (g + 1) / 2, w / 2
    r, s, t = (q.ravel() for q in np.meshgrid(g, g, g, indexing="ij"))
    weight = np.einsum("i,j,k->ijk", w, w, w).ravel() * (1 - r) ** 2 * (1 - s)
    points = np.column_stack([r, (1 - r) * s, (1 - r) * (1 - s) * t])
    return np.column_stack([1 - points.sum(axis=1), points]), weight / weight.sum()


def l2_error(run, folder, field):
    """Relative L2 error of the displacement on straight tets."""
    x, tets = run["mesh/coordinates"][:], run["mesh/tets"][:]
    with last_fields(folder) as fields:
        u = fields["displacement"][:]
    volume = np.linalg.det(x[tets[:, 1:4]] - x[tets[:, :1]])
    off = size = 0.0
    for b, weight in zip(*quadrature()):
        shape = b
        if tets.shape[1] == 10:
            shape = np.concatenate([b * (2 * b - 1), [4 * b[i] * b[j] for i, j in MIDDLES]])
        exact = field(np.einsum("k,tkc->tc", b, x[tets[:, :4]]))
        found = np.einsum("k,tkc->tc", shape, u[tets])
        off += weight * volume @ ((found - exact) ** 2).sum(axis=1)
        size += weight * volume @ (exact**2).sum(axis=1)
    return float(np.sqrt(off / size))


def command_line(options):
    """Words of a dict of options; a flag has the value '', an option that is left out None."""
    return [w for k, v in options.items() if v is not None
            for w in (f"-{k}", *([str(v)] if v != "" else []))]


def at_place(place):
    """Reader of the displacement at a place."""
    def read(run, folder):
        with last_fields(folder) as fields:
            return interpolate(run["mesh/coordinates"][:], run["mesh/tets"][:],
                               fields["displacement"][:], place)
    return read


class Scene:
    """Options, meshes, sizes, and what is compared with what.

    value    of a run: numbers; the error is relative to `exact`, or to the finest `reference`
    error    of a run, where that is known by itself
    field    displacement prescribed on `held` surfaces, by place
    methods  elements, each by itself or with one of WAYS
    """

    def __init__(self, name, options, geometry, sizes, value=None, exact=None, error=None,
                 field=None, held=(), numbers=None, order=2, methods=P1 + P2, reference="p2"):
        self.name, self.options, self.geometry, self.sizes = name, options, geometry, sizes
        self.value, self.exact, self.error = value, exact, error
        self.field, self.held, self.numbers, self.order = field, held, numbers or {}, order
        self.methods, self.reference = methods, reference
        self.meshes = {}

    def mesh(self, h, order):
        """A mesh of edges h; curved where the geometry is round and the elements can be."""
        if (h, order) not in self.meshes:
            path = f"build/meshes/wp_{self.name}_{h:g}_{order}.msh"
            numbers = {"h": h, "order": order, **{k: f(h) for k, f in self.numbers.items()}}
            words = [w for k, v in numbers.items() for w in ("-setnumber", k, f"{v:g}")]
            subprocess.run(
                ["gmsh", "-3", "-order", str(order), f"meshes/{self.geometry}.geo", *words,
                 "-o", path, "-format", "msh41"], cwd=ROOT, check=True, capture_output=True)
            self.meshes[h, order] = path
        return self.meshes[h, order]

    def words(self, h, method, folder):
        """Command line of a run."""
        element, *way = method.split()
        mesh = self.mesh(h, 1 if element.startswith("p1") else self.order)
        options = {"mesh": mesh, "tissue_element": element, **self.options}
        for word in way:
            options |= WAYS[word]
        if self.field:
            file = written_field(mesh, folder, self.field)
            options |= {f"boundary_{surface}_field": file for surface in self.held}
        return command_line(options)

    def judge(self, folder):
        """What a run found, and its nodes."""
        with h5py.File(folder / "run.h5") as run:
            found = self.error(run, folder) if self.error else self.value(run, folder)
            return found, len(run["mesh/coordinates"])


def cube(poisson):
    def field(x):
        return manufactured(x, poisson)
    return Scene(f"cube_{poisson:g}",
                 {"analysis": "static", "time_step": 1, "time_end": 1, "tissue_model": "linear",
                  "tissue_young": YOUNG, "tissue_poisson": poisson},
                 "gel", {"p1": [12e-3, 8e-3, 5.5e-3, 4e-3, 2.8e-3, 2e-3, 1.4e-3],
                         "p2": [24e-3, 16e-3, 11e-3, 8e-3, 5.5e-3, 4e-3]},
                 error=lambda run, folder: l2_error(run, folder, field), field=field, held=GEL,
                 numbers={"length": lambda h: 0.05})


def shell(poisson):
    def value(run, _):
        volume = run["history/cavity/fluid/volume"][:]
        return volume[-1] / volume[0] - 1.0
    return Scene(f"shell_{poisson:g}",
                 {"options_file": "options/shell.opts", "tissue_poisson": poisson, "fix": PINS},
                 "shell", {"p1": [6e-3, 4e-3, 2.8e-3, 2e-3, 1.4e-3], "p2": [12e-3, 8e-3, 6e-3, 4e-3]},
                 value, 3 * free_shell(poisson), numbers={"pins": lambda h: 1})


def eshelby(poisson):
    bulk, shear = moduli(poisson)

    def value(run, folder):
        """Pressure over that of the closed form, and the same of k in u = k e x at the wall."""
        x = run["mesh/coordinates"][:]
        at = np.abs(np.linalg.norm(x, axis=1) / INNER - 1) < 1e-6
        with last_fields(folder) as fields:
            u = fields["displacement"][:][at]
        ex = x[at] @ STRAIN
        k = (u * ex).sum() / (ex**2).sum() * (7 - 5 * poisson) / (15 * (1 - poisson))
        p = run["history/cavity/fluid/pressure"][-1] / (-(bulk + 4 * shear / 3) * THETA)
        return np.array([p, k])
    return Scene("eshelby",
                 {"analysis": "static", "time_step": 1, "time_end": 1, "tissue_model": "linear",
                  "tissue_young": YOUNG, "tissue_poisson": poisson, "cavities": "fluid",
                  "cavity_fluid_surface": "wall"},
                 "shell", {"p1": [6e-3, 4e-3, 2.8e-3, 2e-3, 1.4e-3], "p2": [12e-3, 8e-3, 6e-3, 4e-3]},
                 value, np.ones(2), field=lambda x: liquid_sphere(x, poisson), held=("outer",))


def scenes():
    phantom = Scene("phantom", {"options_file": "options/phantom.opts", "locking_gauge": "false"}, "phantom",
                    {"p1": [6e-3, 4.2e-3, 3e-3, 2.2e-3, 1.6e-3, 1.2e-3],
                     "p2": [12e-3, 8e-3, 6e-3, 4.2e-3]},
                    lambda run, _: run["history/cavity/pocket/pressure"][-1],
                    numbers={"hw": lambda h: 0.9 * h}, order=1)
    cantilever = Scene("cantilever",
                       {"analysis": "static", "time_step": 1, "time_end": 1,
                        "tissue_model": "linear", "tissue_young": YOUNG, "tissue_poisson": 0.45,
                        "tissue_density": 1000, "gravity": "0,0,-1", "fix": "entry"},
                       "gel", {"p1": [12e-3, 8e-3, 5.5e-3, 4e-3, 2.8e-3, 2e-3],
                               "p2": [24e-3, 16e-3, 12e-3, 8e-3, 5.5e-3]},
                       at_place([0.15, 0.025, 0.025]), order=1)
    insertion = Scene("insertion",
                      {"options_file": "options/gel_insertion.opts", "tissue_model": "linear",
                       "time_initial": "unstressed", "gravity": "0,0,0", "time_end": 2,
                       "insertion_radius_correction": ""},
                      "gel", {"p1": [12e-3, 8e-3, 5.5e-3, 4e-3, 2.8e-3, 2e-3],
                              "p2": [24e-3, 16e-3, 12e-3, 8e-3, 5.5e-3]},
                      at_place(TARGET), order=1, reference="p2 line",
                      methods=P1 + P2 + ("p1 uncorrected", "p2 uncorrected", "p1 line", "p2 line"))
    return [cube(0.45), cube(0.4999), *map(shell, (0.3, 0.485, 0.4999)), eshelby(0.485), cantilever,
            phantom, insertion]
