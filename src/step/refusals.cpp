#include <algorithm>
#include <limits>
#include <sstream>

#include "core/words.hpp"
#include "step/simulation.hpp"

// Why a step is not taken, in words: where it is, and what may help.
namespace trocar::step {
namespace {

std::string at_place(const Vec3& X)
{
  std::ostringstream text;
  text << '(' << core::shown(X.x()) << ", " << core::shown(X.y()) << ", " << core::shown(X.z())
       << ") m";
  return text.str();
}

}  // namespace

std::string Simulation::folds_at(int tet) const
{
  const mesh::Mesh& mesh = scene_.mesh;
  Vec3 middle = Vec3::Zero();
  for (const Vec3& corner : mesh::corners(mesh, tet)) middle += 0.25 * corner;
  const auto at = static_cast<std::size_t>(tet);
  const bool is_linear = scene_.tissue.model == tissue::Model::linear;
  std::ostringstream text;
  text << "an element of the tissue would turn inside out: tet " << mesh.elem_tag[at]
       << " of volume '" << mesh.volumes[static_cast<std::size_t>(mesh.region[at])] << "' near "
       << at_place(middle)
       << (is_linear ? "; linear tissue is for small strains (take -tissue_model corotational, or "
                       "accept it with -tissue_allow_inversion)"
                     : "; shorter steps or a finer mesh there may help");
  if (scene_.tissue.model == tissue::Model::corotational)
    text << ", or -tissue_model neo_hookean, which resists being crushed";
  return text.str();
}

std::string Simulation::not_balanced(const Effort& effort, double residual) const
{
  const std::string what = residual <= effort.later
                               ? "the gaps of the rows stay open, or single nodes unbalanced"
                               : "relative residual " + core::shown(residual);
  return "equilibrium not reached in " + std::to_string(effort.most) + " linearisations (" + what +
         ")";
}

std::string Simulation::place_of_row(const Pass& pass, int row) const
{
  const constraint::Row& one = pass.rows.set.rows()[static_cast<std::size_t>(row)];
  if (one.wide >= 0) {
    const int k = row - pass.rows.of_cavities.first;
    const int cavity = pass.rows.of_cavities.cavity[static_cast<std::size_t>(k)];
    if (cavity::Cavities::drained(pass.rows.of_cavities.fluid) == cavity)
      return "cavity '" + scene_.cavities.cavities[static_cast<std::size_t>(cavity)].name +
             "': more fluid would flow out within the step than there is";
    return "cavity '" + scene_.cavities.cavities[static_cast<std::size_t>(cavity)].name +
           "': its wall is held all over";
  }
  const Vec3 X = one.anchor.mean(
      [&](int node) -> Vec3 { return scene_.mesh.x[static_cast<std::size_t>(node)]; });
  return "needle '" + needles_[static_cast<std::size_t>(one.body)].settings().name +
         "' where the undeformed tissue has " + at_place(X) + ", which a support holds";
}

/// Stiff parts round off what soft ones carry. Beyond what could be mended by iterating, supports
/// and loads differ.
std::optional<std::string> Simulation::cannot_stand(const core::TimeStep& now,
                                                    const tissue::Balance& balance) const
{
  constexpr double most = 1e-6, rounded = 10.0 * std::numeric_limits<double>::epsilon();
  if (!now.is_static || balance.lost <= most * balance.carried) return std::nullopt;
  const auto [soft, stiff] = std::minmax_element(
      scene_.tissue.materials.begin(), scene_.tissue.materials.end(),
      [](const tissue::Material& a, const tissue::Material& b) { return a.young < b.young; });
  const double contrast = stiff->young / soft->young;
  if (rounded * contrast <= most) return std::nullopt;
  return "supports and loads differ by " + core::shown(balance.lost / balance.carried) +
         " of them: the stiffness contrast of " + core::shown(contrast) +
         " between the volumes is more than rounding allows (hold the stiff part with -fix)";
}

/// Walls that have gone through each other: nothing keeps them apart.
std::optional<std::string> Simulation::collapsed(const StepReport& report) const
{
  for (std::size_t i = 0; i < report.cavities.size(); ++i)
    if (!(report.cavities[i].volume > 0.0))
      return "cavity '" + scene_.cavities.cavities[i].name + "' has no volume left (" +
             core::shown(report.cavities[i].volume) +
             " m^3): its walls would go through each other, and contact of walls is not modelled";
  return std::nullopt;
}

}  // namespace trocar::step
