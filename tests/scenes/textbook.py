"""Same displacements, energy and stress as a textbook assembly in NumPy, for every kind of tet."""
import numpy as np

from harness import check, finish
from tet_book import difference, solution, solved, stiffness, stored, traction_loads, weights

# On curved faces the area is no polynomial: the program's rule leaves 1e-8.
CASES = [(element, 1, "top", 1e-10) for element in ("p1", "p1_anp", "p2", "p2_bbar", "p2_anp")]
CASES += [(element, 2, "top", 1e-10) for element in ("p1", "p2", "p2_bbar", "p2_anp")]
CASES += [("p2", 1, "skin", 1e-10), ("p2", 2, "skin", 1e-6)]

for element, order, surface, tolerance in CASES:
    body = solved(element, order, surface)
    title = f"{element} on a mesh of order {order}, load on the {surface}, {len(body.x)} nodes: "
    K = stiffness(body, element)
    f = traction_loads(body, surface) + weights(body)
    off = difference(body.u, solution(body, K, f))
    check(off < tolerance, f"{title}displacement differs by {off:.1e}")
    # Clapeyron; and the stress summed over the body is the moment of the nodal forces.
    energy, stress = stored(body)
    forces = (K @ body.u.ravel()).reshape(-1, 3)
    moment = body.x.T @ forces
    moment = 0.5 * (moment + moment.T)[[0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]]
    off = max(abs(energy / (0.5 * np.sum(forces * body.u)) - 1), difference(stress, moment))
    check(off < 1e-11, f"{title}energy and stress differ by {off:.1e}")
finish()
