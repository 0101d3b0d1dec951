#include "post/stress_fields.hpp"

#include <string>

#include "post/stress.hpp"

namespace trocar::post {
namespace {

io::Field field(const std::string& name, std::size_t columns, const std::string& units,
                const VecX& values, bool nodal)
{
  return {name,  columns, units, {values.data(), values.data() + values.size()},
          nodal, false,   !nodal};
}

}  // namespace

std::vector<io::Field> stress_fields(const step::Model& model, const step::State& state,
                                     const StressOutput& wanted)
{
  std::vector<io::Field> fields;
  if (!wanted.any()) return fields;
  const tissue::StressField found = model.tissue.stresses(state.tissue.u);
  if (!model.space.comm().root()) return fields;  // only rank 0 writes
  const Eigen::Index tets = found.energy.size();
  VecX mises(wanted.von_mises ? tets : 0), principal(wanted.principal_stress ? 3 * tets : 0);
  for (Eigen::Index t = 0; t < tets; ++t) {
    const Voigt s = found.stress.segment<6>(6 * t);
    if (wanted.von_mises) mises[t] = von_mises(s);
    if (wanted.principal_stress) principal.segment<3>(3 * t) = principal_values(s);
  }
  if (wanted.stress) fields.push_back(field("/stress", 6, "Pa", found.stress, false));
  if (wanted.von_mises) fields.push_back(field("/von_mises", 0, "Pa", mises, false));
  if (wanted.principal_stress)
    fields.push_back(field("/principal_stress", 3, "Pa", principal, false));
  if (wanted.strain_energy)
    fields.push_back(field("/strain_energy", 0, "J/m^3", found.energy, false));
  if (wanted.nodal_stress)
    fields.push_back(field("/nodal_stress", 6, "Pa", nodal_means(model.scene.mesh, found), true));
  return fields;
}

}  // namespace trocar::post
