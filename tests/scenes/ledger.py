"""The work ledger: a scene pays only for what it uses."""
import os

import numpy as np

from harness import (check, completed, finish, geometry, histories, ledger, options, run, structured,
                     small_block)

small = options("small_insertion.opts")
small["-mesh"] = small_block()

work = ledger(completed(small))
check(work["assemblies"] == 1 and work["factorisations"] == 1,
      f"linear tissue: one assembly and one factorisation in {work['steps']} steps")
check(work["columns_built"] <= 12, f"each isolated dof solved once ({work['columns_built']} columns)")
check(work["columns_reused"] > 100 * work["columns_built"], "and then reused")

# 0.5 / 0.04 is not whole: thirteen equal steps, one operator.
folder = completed({**small, "-time_step": "0.04", "-time_end": "0.5"})
work = ledger(folder)
check(work["assemblies"] == 1 and work["steps"] == 13, "an end between two steps: equal steps")
check(abs(np.diff(histories(folder)["time"]) - 0.5 / 13).max() < 1e-15, "of a thirteenth each")

none = {**small, "-needles": '""', "-gravity": "0,0,-9.81", "-time_end": "0.5"}
folder = completed(none)
work = ledger(folder)
check(work["constraint_solves"] == 0 and work["columns_built"] == 0,
      "no needle: no compliance column and no constraint solve")
check(work["half_sweeps"] == 2 * work["steps"] and work["solves"] == 0,
      "no needle: one forward and one backward half-sweep per step")
check(not any(name.startswith("needle") for name in histories(folder)), "no needle: no histories")

outside = {**small, "-needle_velocity": "0", "-time_end": "0.2"}
work = ledger(completed(outside))
check(work["constraint_solves"] == 0, "a needle outside costs no constraint solve")

folder = completed({**small, "-output_fields": '""', "-time_end": "0.2"})
check(os.listdir(os.path.join(folder, "fields")) == [], "no output fields: no field file")

work = ledger(completed({**small, "-time_end": "1"}))
check(work["half_sweeps"] == 2 * work["steps"] and work["solves"] == 0,
      "free motion, constraints and correction: one sweep per step")

tight = {**small, "-time_end": "0.2", "-compliance_memory": "1000"}
work = ledger(completed(tight))
check(work["half_sweeps"] == 0 and work["solves"] > 0, "a factor that is too large: PETSc instead")
said = run({**tight, "-check": ""}).stdout
check("because a supernodal factor would take" in said, "and the log says why")
work = ledger(completed({**small, "-compliance_reuse": "none", "-time_end": "1"}))
check(work["columns_reused"] == 0 and work["columns_built"] > 100, "reuse none: nothing is kept")

for provider, more in (("ksp", {}), ("ksp_block", {}), ("auto", {"-tissue_ksp_type": "cg"}),
                       ("auto", {"-tissue_mat_mumps_icntl_14": "80"})):
    work = ledger(completed({**small, "-compliance_provider": provider, "-time_end": "1", **more}))
    solves = 2 * work["steps"] - (work["steps"] - work["constraint_solves"])
    expected = solves + (0 if provider == "ksp_block" else work["columns_built"])
    check(work["solves"] == expected, f"{provider}: {work['solves']} solves accounted for")

layers = options("layers.opts")
layers.update({"-time_end": "2.5"})
work = ledger(completed(layers))
check(work["assemblies"] == 1 and work["factorisations"] == 1,
      "puncture and cutting of linear tissue: one assembly and one factorisation")

# Bodies that do not meet cost nothing.
apart = {"-obstacles": "floor", "-obstacle_floor_origin": "0,0,-0.5", "-contact_pairs": "rest:skin:floor"}
free = ledger(completed({**layers, "-time_end": "0.5"}))
check(free == ledger(completed({**layers, "-time_end": "0.5", **apart})), "a pair that is apart changes no count")
check(free["contact_queries"] == free["repeated_steps"] == 0, "and is not looked at closely")
ball = options("ball_on_block.opts")
ball.update({"-mesh": geometry("ball_on_block"), "-time_end": "0.2"})
work = [ledger(completed(ball, ranks)) for ranks in (1, 2)]
check(work[0]["contact_queries"] >= 2 * work[0]["constraint_solves"] > 0,
      f"surfaces in reach meet at every iterate and at its end: {work[0]['contact_queries']}")
check(work[0] == work[1], "as often on two ranks")

gel = options("gel_insertion.opts")
gel.update({"-time_end": "0.4"})
work = ledger(completed(gel))
check(work["factorisations"] < work["assemblies"] / 4,
      f"corotational: {work['factorisations']} factorisations for {work['assemblies']} assemblies")
check(work["columns_reused"] > 2 * work["columns_built"], "and columns are kept with the factor")
work = ledger(completed({**gel, "-compliance_lag": "0"}))
check(work["assemblies"] == work["factorisations"], "lag 0: one factorisation per assembly")
for steps in (1, 5):
    folder = completed({**gel, "-compliance_reuse": "stale", "-compliance_stale_steps": str(steps),
                        "-compliance_stale_error": "", "-needle_velocity": "0.1"})
    work, h = ledger(folder), histories(folder)
    gap, error = h["compliance/leftover_gap"].max(), h["compliance/stale_error"].max()
    if steps == 1:
        check(work["assemblies"] == work["factorisations"] and gap == 0.0 and error == 0.0,
              "stale for one step is exact")
    else:
        check(h["compliance/factor_age"].max() == 5, "stale: 5 steps share a factor")
        plain = histories(completed({**gel, "-compliance_reuse": "stale", "-needle_velocity": "0.1",
                                     "-compliance_stale_steps": "5"}))
        check(plain["compliance/leftover_gap"].max() == gap, "asking for the error changes nothing")
        check(1e-9 < gap < 1e-3 and 1e-9 < error < 1e-3,
              f"stale: gap off by {gap:.1e} m, displacement by {error:.1e} m")
# At rest, with a needle on its way and with one that slides without friction nothing is left to do:
# one factor for ever, one pass a step and at most two, whatever the tissue turns by its weight.
rest = {"-mesh": structured("gel_cube", *"--nodes 7 7 7 --size 0.25 0.25 0.25 --split 6".split()),
        "-tissue_young": "1e6", "-tissue_density": "64", "-gravity": "0,0,-9.81", "-fix": "z0",
        "-time_step": "0.01", "-time_end": "0.3"}
needle = {"-needles": "n", "-needle_entry": "0.129,0.123,0.25", "-needle_direction": "0,0,-1",
          "-needle_length": "0.2", "-needle_radius": "0.001"}
slides = {**needle, "-needle_velocity": "0.3", "-needle_depth": "0.08"}
for name, scene in {"still": {"-time_initial": "equilibrium"},
                    "needle before it": {**needle, "-time_initial": "equilibrium"},
                    "slides without friction": {**slides, "-time_initial": "equilibrium", "-needle_model": "rigid"},
                    "slides, beam": {**slides, "-time_initial": "equilibrium"},
                    "slides, neo-Hookean": {**slides, "-time_initial": "equilibrium",
                                            "-tissue_model": "neo_hookean"},
                    "slides, p2": {**slides, "-time_initial": "equilibrium", "-tissue_element": "p2"},
                    "slides, statics": {**slides, "-analysis": "static"}}.items():
    for ranks in (1, 2):
        folder = completed({**rest, **scene}, ranks)
        passes, work = histories(folder)["compliance/passes"][1:], ledger(folder)
        # The start and what follows it have operators of their own.
        most = 2 if "static" not in name else 1
        check(np.median(passes) <= 1 and passes[2:].max() <= 2 and work["factorisations"] <= most + 1,
              f"{name}, {ranks} ranks: {passes.max():.0f} passes at most, {work['factorisations']} factors")
static = {**rest, "-analysis": "static", "-time_end": "0", "-tissue_model": "linear"}
for solver in ({}, {"-tissue_ksp_type": "cg", "-tissue_pc_type": "jacobi"},
               {"-tissue_ksp_type": "cg", "-tissue_pc_type": "gamg"}):
    for element in ("p1", "p2"):
        folder = completed({**static, **solver, "-tissue_element": element})
        check(histories(folder)["time_linearisations"][-1] == 1, f"linear statics by {solver} {element}: solved once")
# Points that stick and slip much closer than the elements, turning back: rows that repeat each other.
close = {**options("close_points.opts"), "-insertion_spacing": "0.0005", "-insertion_friction_dynamic": "6",
         "-needle_depth": "0.1156", "-needle_hold": "0.03", "-needle_withdraw_velocity": "0.003", "-time_end": "0.35",
         "-output_fields": '""', "-mesh": structured(
             "gel_block", *"--nodes 16 8 8 --size 0.15 0.07 0.07 --split 5".split())}
h = histories(completed(close))
most, off = h["constraint/iterations"].max(), h["constraint/residual"].max()
check(most <= 20 and off <= 1e-9, f"close points turning back: {most:.0f} factorisations at most, {off:.1e} m")
work = ledger(completed(small))
check(work["surface_passes"] == 0 and work["pressure_updates"] == 0, "no cavity: no pass over a wall")
phantom = options("phantom.opts")
phantom["-mesh"] = geometry("phantom")
for model in ("linear", "frozen"):
    folder = completed({**phantom, "-cavity_model": model})
    work, steps = ledger(folder), 4
    check(work["factorisations"] == 1 and work["assemblies"] == 1, f"{model}: one factorisation")
    if model == "linear":
        check(work["columns_built"] == 1 and work["constraint_solves"] == steps,
              "linear: one column for ever, one dense solve per equilibrium")
        check(work["half_sweeps"] == 2 * steps and work["surface_passes"] == 1 + steps,
              "linear: one sweep per equilibrium, one pass over the wall for the report")
    else:
        check(work["columns_built"] == 0 and work["constraint_solves"] == 0, "frozen: no dense problem")
        check(work["half_sweeps"] == 2 * steps + 2, "frozen: one sweep more in all, for A^-1 g_0")
        check(work["pressure_updates"] == 3, f"exact: one update for each load ({work['pressure_updates']})")
folder = completed(phantom)
work = ledger(folder)
linearisations = histories(folder)["time_linearisations"].sum()
check(work["factorisations"] == 1, "follower: the factor is kept")
check(work["columns_built"] == linearisations, "follower: one column per linearisation, the wall's new slope")
check(work["stress_evaluations"] == 0, "stress that is not asked for is not computed")
given = {**phantom, "-cavity_model": "linear", "-cavity_pocket_law": "pressure",
         "-cavity_pocket_pressure": "100"}
work = ledger(completed(given))
check(work["constraint_solves"] == 0 and work["columns_built"] == 0, "a given pressure is a load: no row")

keys = {"assemblies", "factorisations", "solves", "half_sweeps", "columns_built", "columns_reused",
        "constraint_solves", "contact_queries", "surface_passes", "pressure_updates", "stress_evaluations", "steps",
        "rejected_steps", "repeated_steps"}
check(set(work) == keys, "the ledger holds every count of the contract")
finish()
