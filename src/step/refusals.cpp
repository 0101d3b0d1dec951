#include "step/refusals.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include "core/place.hpp"
#include "core/words.hpp"

namespace trocar::step {

std::string inverted_at(const Scene& scene, int tet)
{
  const mesh::Mesh& mesh = scene.mesh;
  Vec3 middle = Vec3::Zero();
  for (const Vec3& corner : mesh::corners(mesh, tet)) middle += 0.25 * corner;
  const auto at = static_cast<std::size_t>(tet);
  const tissue::Model model = scene.tissue.model_of(static_cast<std::size_t>(mesh.region[at]));
  const bool is_linear = model == tissue::Model::linear;
  const bool own = model != scene.tissue.model;  // this volume has a model option of its own
  const std::string volume = mesh.volumes[static_cast<std::size_t>(mesh.region[at])];
  const std::string option = "-tissue_" + (own ? volume + "_" : std::string()) + "model";
  std::ostringstream text;
  text << "an element of the tissue would turn inside out: tet " << mesh.elem_tag[at]
       << " of volume '" << mesh.volumes[static_cast<std::size_t>(mesh.region[at])] << "' near "
       << core::shown(middle)
       << (is_linear ? "; linear tissue is for small strains (take " + option +
                           " corotational, or "
                           "accept it with -tissue_allow_inversion)"
                     : "; shorter steps or a finer mesh there may help");
  if (model == tissue::Model::corotational)
    text << ", or " << option << " neo_hookean, which resists being crushed";
  return text.str();
}

std::string not_held(const Model& model)
{
  std::string names;
  for (std::size_t b = 0; b < model.bodies.all.size(); ++b) {
    if (model.bodies.all[b].held) continue;
    const std::string name = model.bodies.name(model.scene.mesh, b);
    names += (names.empty() ? "" : "; ") + (name.empty() ? "the tissue" : name);
  }
  return "neither supports nor contact hold " + names +
         " (the loads push it off or along or crush it, or the surfaces are farther apart than "
         "-contact_search)";
}

std::string place_of(const Scene& scene, const Solution& solution, int row)
{
  const constraint::Row& one = solution.system.set().rows()[static_cast<std::size_t>(row)];
  if (!one.distributed.empty()) {
    const int k = row - solution.of_cavities.first;
    const int cavity = solution.of_cavities.cavity[static_cast<std::size_t>(k)];
    if (cavity::drained(solution.of_cavities.fluid) == cavity)
      return "cavity '" + scene.cavities.cavities[static_cast<std::size_t>(cavity)].name +
             "': more fluid would flow out within the step than there is";
    return "cavity '" + scene.cavities.cavities[static_cast<std::size_t>(cavity)].name +
           "': its wall is held all over";
  }
  const Vec3 X = one.tissue.back().anchor.mean(
      [&](int node) -> Vec3 { return scene.mesh.x[static_cast<std::size_t>(node)]; });
  if (one.body < 0) {
    for (const contact::Group& group : solution.of_contact.groups)
      if (row >= group.first && row < group.first + group.rows)
        return "contact '" + scene.contact.pairs[static_cast<std::size_t>(group.pair)].name +
               "' where the undeformed slave surface has " + core::shown(X);
  }
  return "needle '" + scene.needles[static_cast<std::size_t>(one.body)].name +
         "' where the undeformed tissue has " + core::shown(X) + ", which a support holds";
}

std::optional<core::Refusal> cannot_stand(const Scene& scene, const core::TimeStep& now,
                                          const tissue::Balance& balance)
{
  constexpr double most = 1e-6, rounded = 10.0 * std::numeric_limits<double>::epsilon();
  if (!now.is_static || balance.lost <= most * balance.carried) return std::nullopt;
  const auto [soft, stiff] = std::minmax_element(
      scene.tissue.materials.begin(), scene.tissue.materials.end(),
      [](const tissue::Material& a, const tissue::Material& b) { return a.young < b.young; });
  const double contrast = stiff->young / soft->young;
  if (rounded * contrast <= most) return std::nullopt;
  return core::Refusal{
      "supports and loads differ by " + core::shown(balance.lost / balance.carried) +
      " of them: the stiffness contrast of " + core::shown(contrast) +
      " between the volumes is more than rounding allows (hold the stiff part with -fix)"};
}

std::optional<core::Refusal> collapsed(const Scene& scene, const StepReport& report)
{
  for (std::size_t i = 0; i < report.cavities.size(); ++i)
    if (!(report.cavities[i].volume > 0.0))
      return core::Refusal{
          "cavity '" + scene.cavities.cavities[i].name + "' has no volume left (" +
          core::shown(report.cavities[i].volume) +
          " m^3): its walls would go through each other, and contact of walls is not modelled"};
  return std::nullopt;
}

}  // namespace trocar::step
