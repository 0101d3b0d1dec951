#include "insertion/membranes.hpp"

#include <algorithm>
#include <cmath>

#include "mesh/quadratic.hpp"

namespace trocar::insertion {

Membranes::Membranes(const mesh::Mesh& mesh, PunctureSettings settings)
    : mesh_(&mesh), settings_(std::move(settings))
{
  settings_.volume.resize(mesh.volumes.size(), 0.0);
  const auto positive = [](double f) { return f > 0.0; };
  any_ = std::any_of(settings_.volume.begin(), settings_.volume.end(), positive) ||
         std::any_of(settings_.surface.begin(), settings_.surface.end(), positive);
  if (!any_) return;
  for (std::size_t s = 0; s < settings_.surface.size(); ++s)
    for (mesh::Face face : mesh.surfaces[s].faces) {
      std::sort(face.begin(), face.end());
      // A face that belongs to two surfaces takes the larger threshold.
      const auto [at, fresh] = tagged_.try_emplace(face, settings_.surface[s]);
      if (!fresh) at->second = std::max(at->second, settings_.surface[s]);
    }
}

/// Threshold of the physical surface that contains the face of the tet on which X lies. -1: that
/// surface has no threshold of its own. -2: X lies on no face of a physical surface.
double Membranes::of_surface(int tet, const Vec3& X) const
{
  if (tet < 0) return -2.0;
  const mesh::Tet& nodes = mesh_->tets[static_cast<std::size_t>(tet)];
  // At a curved face, X may lie on the flat face between the corners, where paths cross, or on the
  // curved face itself, where a tip enters the tissue.
  const Eigen::Vector4d at_chord = mesh::barycentric(mesh::corners(*mesh_, tet), X);
  const Eigen::Vector4d at_face = mesh::local_coordinates(mesh::positions(*mesh_, tet), X);
  const Eigen::Vector4d weight = at_chord.cwiseAbs().cwiseMin(at_face.cwiseAbs());
  double found = -2.0;
  for (std::size_t opposite = 0; opposite < 4; ++opposite) {
    if (weight[static_cast<Eigen::Index>(opposite)] > 1e-5) continue;
    mesh::Face face{nodes[(opposite + 1) % 4], nodes[(opposite + 2) % 4],
                    nodes[(opposite + 3) % 4]};
    std::sort(face.begin(), face.end());
    const auto at = tagged_.find(face);
    if (at != tagged_.end()) found = std::max(found, at->second);
  }
  return found;
}

double Membranes::threshold(int from, int to, const Vec3& X) const
{
  if (!any_ || from == to) return 0.0;
  const double surface = std::max(of_surface(from, X), of_surface(to, X));
  if (surface >= 0.0) return surface;
  const auto region = [&](int tet) {
    return tet < 0 ? -1 : mesh_->region[static_cast<std::size_t>(tet)];
  };
  // Inside one volume only a face of a physical surface is a membrane.
  if (region(from) == region(to) && surface < -1.5) return 0.0;
  const int volume = region(to) >= 0 ? region(to) : region(from);
  return volume < 0 ? 0.0 : settings_.volume[static_cast<std::size_t>(volume)];
}

}  // namespace trocar::insertion
