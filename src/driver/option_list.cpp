#include "driver/option_list.hpp"

#include "driver/option_kinds.hpp"

namespace trocar::driver {
namespace {

std::vector<OptionSpec> general_options()
{
  return {
      file("mesh", "Gmsh file (2.2 or 4.1, ascii or binary), or several between commas"),
      positive("mesh_scale", "1", "1", "factor on the mesh's coordinates, 1e-3 for millimetres"),
      choice("analysis", "dynamic", {"dynamic", "static", "pv_curve"},
             "steps in time; equilibrium: one, or a quasi-static path with time_end; or "
             "equilibria with a cavity held at one volume after the other"),
      positive("time_step", "0.01", "s",
               "step length h; equal shorter ones where time_end is no whole number of them"),
      not_negative("time_end", "0", "s", "end of the run, 0 = no steps (static: one equilibrium)"),
      choice("time_initial", "unstressed", {"unstressed", "equilibrium"},
             "start at rest without stress, or in balance with gravity and loads"),
      choice("time_scheme", "backward_euler", {"backward_euler", "bdf2"},
             "for inertia and damping; bdf2 is of order 2 in smooth motion, friction and flows of "
             "fluids stay of order 1"),
      word(
          "time_newton_max", "auto",
          "linearisations per dynamic step: 1 is the papers' single one, more iterate to "
          "newton_tolerance; auto: one where that leaves 1e-3 of the forces at every node, else as "
          "many as it takes to 1e-6"),
      {"newton_tolerance", OptionType::real, "1e-8", "1",
       "part of the forces at a node that may stay unbalanced in static steps, in those told to be "
       "iterated and where pressures follow the walls",
       1e-12, 1e-2, false, false},
      vector("gravity", "0,0,0", "m/s^2", "acceleration of gravity"),
      choice("tissue_element", "auto", {"auto", "p1", "p1_anp", "p2", "p2_bbar", "p2_anp"},
             "tets: linear, quadratic (middle nodes are added where the mesh has none); _anp: with "
             "nodal, _bbar: with element averages of the dilatation; auto: p2, beyond nu = 0.49 "
             "p2_anp"),
      choice("tissue_tangent", "auto", {"auto", "rotated", "exact"},
             "of corotational tissue: with the rotations held, as in the paper, or exact "
             "(neo_hookean is always exact); auto: exact for the rest of a step in which three "
             "linearisations left more than half of what was unbalanced"),
      flag("tissue_allow_inversion",
           "go on, with a warning, when linear tissue turns an element inside out"),
      choice("tissue_mass", "consistent", {"consistent", "lumped"}, "tissue mass matrix"),
  };
}

void add_tissue(std::vector<OptionSpec>& t)
{
  with_override(
      t, choice("tissue_model", "corotational", {"linear", "corotational", "neo_hookean"}, "law"),
      "<volume>");
  with_override(t, positive("tissue_young", "5000", "Pa", "Young's modulus"), "<volume>");
  with_override(t, poisson("tissue_poisson", "0.45"), "<volume>");
  with_override(t, positive("tissue_density", "1000", "kg/m^3", "mass density"), "<volume>");
  with_override(t,
                not_negative("tissue_rayleigh_mass", "0", "1/s", "alpha in B = alpha M + beta K"),
                "<volume>");
  with_override(t,
                not_negative("tissue_rayleigh_stiffness", "0", "s", "beta in B = alpha M + beta K"),
                "<volume>");
}

void add_boundary(std::vector<OptionSpec>& t)
{
  const std::vector<OptionSpec> boundary{
      list("fix",
           "physical surfaces, curves or points held still: NAME[:axes],… (axes such as xz)"),
      vector("boundary_<surf>_displacement", "free,free,free", "m",
             "prescribed displacement of a surface or point group, 'free' per axis"),
      vector("boundary_<surf>_traction", "0,0,0", "Pa", "dead traction on a physical surface"),
      file("boundary_<surf>_field",
           "CSV (columns node,x,y,z: Gmsh's node tag and displacement [m]) for a displacement that "
           "differs from node to node"),
      file("boundary_<surf>_curve",
           "CSV (columns time,factor) that scales displacement and traction of the group"),
  };
  t.insert(t.end(), boundary.begin(), boundary.end());
}

void add_needles(std::vector<OptionSpec>& t)
{
  t.push_back(list("needles", "names of the needles"));
  const std::vector<OptionSpec> needle{
      choice("needle_model", "beam", {"rigid", "beam"}, "corotational Timoshenko beam, or rigid"),
      vector("needle_entry", "0,0,0", "m", "where the needle's path enters the tissue"),
      vector("needle_direction", "1,0,0", "1", "direction of insertion (made unit)"),
      positive("needle_length", "0.12", "m", "length"),
      positive("needle_radius", "0.0005", "m", "outer radius"),
      not_negative("needle_inner_radius", "0", "m", "inner radius, 0 = solid"),
      positive("needle_young", "2e11", "Pa", "Young's modulus"),
      poisson("needle_poisson", "0.3"),
      not_negative("needle_density", "0", "kg/m^3", "0 = neither weight nor inertia"),
      count("needle_elements", "20", 1, 5000, "beam elements"),
      {"needle_bevel", OptionType::real, "0", "rad",
       "angle between the tip's face and the axis: tissue that is cut pushes the tip away along "
       "the "
       "face's normal; 0 = symmetric tip",
       0.0, 1.5708, false, false},
      {"needle_roll", OptionType::real, "0", "rad",
       "turn of the base about its direction at the start: which way a bevel looks"},
      not_negative("needle_velocity", "0", "m/s", "velocity of the advance"),
      not_negative("needle_depth", "0", "m", "depth of the tip beyond the entry at which it ends"),
      not_negative("needle_hold", "0", "s", "rest between advance and withdrawal"),
      not_negative("needle_withdraw_velocity", "0", "m/s",
                   "velocity of withdrawal, until the end of the run; 0 = never"),
      not_negative("needle_inserted", "0", "m",
                   "depth of the tip at the start, coupled on the undeformed mesh"),
      file("needle_trajectory",
           "CSV of the base: time,x,y,z[,dx,dy,dz[,roll]]; replaces velocity, depth, hold"),
  };
  for (const OptionSpec& spec : needle) with_override(t, spec, "<needle>");
}

void add_insertion(std::vector<OptionSpec>& t)
{
  t.push_back(choice("insertion_placement", "crossings", {"crossings", "spacing", "line"},
                     "coupling points where the path crosses faces, or at a spacing; or means "
                     "along the line, which converge (docs/line.md)"));
  t.push_back(positive("insertion_spacing", "0.005", "m",
                       "distance for placement spacing; for placement line, where it is given, "
                       "that of the grid"));
  t.push_back(not_negative("insertion_line_kappa", "0", "1",
                           "distance of the grid of placement line, in edges; 0 = 1.4 with linear "
                           "elements, 0.8 with quadratic ones"));
  t.push_back(not_negative("insertion_line_ring", "0", "1",
                           "least radius of the ring around the shaft, in edges; 0 = 0.35 with "
                           "linear elements, 0.25 with quadratic ones"));
  t.push_back({"insertion_merge", OptionType::real, "0.3", "1",
               "crossings closer than this part of the local edge are merged, 0 = raw", 0.0, 1.0,
               false, true});
  with_override(t,
                not_negative("insertion_friction_static", "0", "N/m",
                             "shaft friction per length of a point at rest"),
                "<volume>");
  with_override(t,
                not_negative("insertion_friction_dynamic", "0", "N/m",
                             "shaft friction per length of a slipping point"),
                "<volume>");
  with_override(t,
                not_negative("insertion_friction_viscous", "0", "N s/m^2",
                             "shaft friction per length and slip velocity, needs time"),
                "<volume>");
  for (const char* kind : {"static", "dynamic", "viscous"}) {
    OptionSpec spec = withdrawal("insertion_friction_" + std::string(kind) + "_withdraw");
    with_override(t, spec, "<volume>");
  }
  t.push_back(flag("insertion_radius_correction",
                   "soften the rows by what a coarse mesh hides of the tissue next to a thin "
                   "shaft; off for the paper's tables"));
  t.push_back({"insertion_eta", OptionType::real, "0", "1",
               "axial force as this part of the sticking one (the papers' law; depends on mesh and "
               "step, for reproduction only); 0 = off",
               0.0, 1.0, false, true});
}

void add_tip(std::vector<OptionSpec>& t)
{
  with_override(t,
                not_negative("insertion_puncture_force", "0", "N",
                             "axial force that pierces a surface, an interface of volumes or a "
                             "physical surface inside them"),
                "<volume>");
  with_override(t,
                not_negative("insertion_cutting_force", "0", "N",
                             "axial force that cuts tissue ahead of the tip"),
                "<volume>");
  t.push_back(not_negative("insertion_tip_radius", "0", "m",
                           "tissue that carries the tip's force; at least one local edge"));
  t.push_back(not_negative("insertion_tip_friction", "1", "1",
                           "lateral over axial force at which the tip slides on a surface"));
}

void add_constraint(std::vector<OptionSpec>& t)
{
  const std::vector<OptionSpec> rest{
      choice("constraint_solver", "auto", {"auto", "pgs", "hybrid", "active_set", "interior_point"},
             "solver of the dense constraint problem"),
      positive("constraint_tolerance", "1e-9", "m", "stop at this residual (or step norm)"),
      count("constraint_max_iterations", "1000", 1, 1e9, "sweeps or factorisations"),
      count(
          "constraint_direction_max", "1", 1, 1000,
          "times per linearisation that constraint directions follow the bending needle, at most; "
          "fewer when the lateral gaps are closed; 1 freezes them as in the papers"),
      choice("constraint_norm", "residual", {"residual", "step"},
             "what pgs and hybrid stop on: the true residual, or the paper's step norm"),
      list(
          "constraint_compare",
          "solvers to be timed on every constraint problem beside the one of the run, for studies: "
          "METHOD[:NORM[:TOLERANCE]],…"),
  };
  t.insert(t.end(), rest.begin(), rest.end());
}

void add_compliance(std::vector<OptionSpec>& t)
{
  const std::vector<OptionSpec> rest{
      choice("compliance_provider", "auto", {"auto", "supernodal", "ksp", "ksp_block"},
             "tissue solver and columns of the isolated compliance: a supernodal factor, or PETSc "
             "with one solve per column or blocks of them; auto takes ksp when a tissue_ksp or "
             "tissue_pc option is given, ksp_block when the factor would not fit in memory"),
      not_negative("compliance_memory", "0", "B",
                   "memory that the supernodal factor may take before auto falls back to "
                   "ksp_block; 0 = 70 % of what is free"),
      choice("compliance_reuse", "exact", {"exact", "stale", "none"},
             "keep columns from step to step as long as that is exact; or, as in the needle paper, "
             "meet the laws with those of a factor that some steps of turning tissue share; or "
             "build all in every step"),
      count("compliance_stale_steps", "10", 1, 1e9,
            "linearisations that share a factor with compliance_reuse stale"),
      flag("compliance_stale_error",
           "with compliance_reuse stale, solve every step exactly as well and record the worst "
           "displacement error"),
      not_negative(
          "compliance_lag", "1e-8", "1",
          "equilibrium, as a part of the load, that a step of turning tissue must reach with "
          "the factor of an earlier one, by several sweeps; 0 = factor in every step"),
      count("compliance_tube", "1", 0, 100,
            "layers of nodes around the needles' planned paths that are eliminated last, so that "
            "their columns are a table; at most 3000 dofs and 10 % more work for the factor; 0 = "
            "off"),
  };
  t.insert(t.end(), rest.begin(), rest.end());
}

void add_checkpoints(std::vector<OptionSpec>& t)
{
  const std::vector<OptionSpec> rest{
      count("checkpoint_every", "0", 0, 1e9, "checkpoint every so many steps; 0 = none"),
      not_negative("checkpoint_seconds", "0", "s",
                   "checkpoint after the step in which so much wall time has passed since the last "
                   "one; 0 = none"),
      not_negative("time_wall", "0", "s",
                   "wall time after which the run ends with a checkpoint and exit code 75, as it "
                   "does on SIGUSR1; 0 = none"),
      word("restart", "none",
           "folder of results in which a run goes on from its last checkpoint; wins over "
           "restart_from"),
      word("restart_from", "none",
           "folder whose last checkpoint this run begins with, its results going to output_dir; "
           "needles may move otherwise from there on"),
  };
  t.insert(t.end(), rest.begin(), rest.end());
}

void add_output(std::vector<OptionSpec>& t)
{
  const std::vector<OptionSpec> rest{
      word("output_dir", "results", "folder of the results"),
      count("output_every", "1", 1, 1e9, "field files every so many steps"),
      [] {
        OptionSpec spec =
            list("output_fields",
                 "nodal: displacement, velocity, contact, nodal_stress; by tet: stress, von_mises, "
                 "principal_stress, strain_energy; \"\" = none");
        spec.fallback = "displacement";
        return spec;
      }(),
      flag("output_energy", "energy account in log and histories: one more element loop per step"),
      flag("error_estimate",
           "estimate the discretisation error at the end of the run from the stress, by volume"),
      {"error_target", OptionType::real, "0", "1",
       "energy error to be told how far off the run is, from 1e-6 on; 0 = none", 0.0, 1.0, false,
       false},
      flag("locking_gauge",
           "compare every cavity's dP/dV with that of p2_bbar on the same mesh before the run"),
      word(
          "error_size_field", "",
          "file for the edge lengths of a mesh with that error, a background field for Gmsh in the "
          "mesh's own unit"),
      flag("check", "stop after set-up: options, mesh, operator"),
      flag("quiet", "no progress lines"),
  };
  t.insert(t.end(), rest.begin(), rest.end());
}

std::vector<OptionSpec> build_table()
{
  std::vector<OptionSpec> t = general_options();
  for (auto* add :
       {add_tissue, add_boundary, add_needles, add_insertion, add_tip, add_cavity_options,
        add_contact_options, add_constraint, add_compliance, add_checkpoints, add_output})
    add(t);
  return t;
}

}  // namespace

const std::vector<OptionSpec>& option_table()
{
  static const std::vector<OptionSpec> table = build_table();
  return table;
}

}  // namespace trocar::driver
