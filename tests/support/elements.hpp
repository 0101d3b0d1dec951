#pragma once

#include <cmath>
#include <vector>

#include "support/body.hpp"

// Bodies of every element and law, deformed and varied alike.
namespace trocar::test {

using core::Mat3;
using core::Vec3;
using tissue::Dilatation;
using tissue::Model;
using tissue::Tangent;

struct Kind
{
  const char* name;
  Model model;
  Tangent tangent;
  bool quadratic;
  Dilatation dilatation;
};

inline const std::vector<Kind> kinds{
    {"linear p1", Model::linear, Tangent::rotated, false, Dilatation::pointwise},
    {"linear p1_anp", Model::linear, Tangent::rotated, false, Dilatation::nodal},
    {"linear p2", Model::linear, Tangent::rotated, true, Dilatation::pointwise},
    {"linear p2_bbar", Model::linear, Tangent::rotated, true, Dilatation::element},
    {"linear p2_anp", Model::linear, Tangent::rotated, true, Dilatation::nodal},
    {"corotational p1", Model::corotational, Tangent::exact, false, Dilatation::pointwise},
    {"corotational p1_anp", Model::corotational, Tangent::exact, false, Dilatation::nodal},
    {"corotational p2", Model::corotational, Tangent::exact, true, Dilatation::pointwise},
    {"corotational p2_bbar", Model::corotational, Tangent::exact, true, Dilatation::element},
    {"corotational p2_anp", Model::corotational, Tangent::exact, true, Dilatation::nodal},
    {"neo_hookean p1", Model::neo_hookean, Tangent::exact, false, Dilatation::pointwise},
    {"neo_hookean p1_anp", Model::neo_hookean, Tangent::exact, false, Dilatation::nodal},
    {"neo_hookean p2", Model::neo_hookean, Tangent::exact, true, Dilatation::pointwise},
    {"neo_hookean p2_bbar", Model::neo_hookean, Tangent::exact, true, Dilatation::element},
    {"neo_hookean p2_anp", Model::neo_hookean, Tangent::exact, true, Dilatation::nodal},
};

inline const core::TimeStep at_rest{0.0, 0.01, true};

inline tissue::TissueSettings settings_of(const Kind& kind)
{
  tissue::TissueSettings settings;
  settings.model = kind.model;
  settings.tangent = kind.tangent;
  settings.dilatation = kind.dilatation;
  settings.materials = {{4000.0, 0.4, 1000.0, 0.0, 0.0}};
  return settings;
}

/// A distorted block; with quadratic tets its edges are curved.
inline BlockShape shape_of(const Kind& kind)
{
  BlockShape shape{3, 2, 2, Vec3(0.15, 0.1, 0.1), 0.2};
  shape.quadratic = kind.quadratic;
  shape.map = [](const Vec3& X) {
    return Vec3(X + 0.3 * Vec3(X.y() * X.y(), X.z() * X.x(), X.x() * X.x()));
  };
  return shape;
}

/// Some smooth finite deformation, and a direction to vary it in.
inline Vec3 deformed(const Vec3& X)
{
  const Mat3 Q = core::rotation_exp(Vec3(0.4, -0.3, 0.6));
  const Vec3 x = Q * X + Vec3(2.0 * X.x() * X.y(), -1.5 * X.z() * X.z(), 1.2 * X.x() * X.z());
  return x - X;
}
inline Vec3 direction(const Vec3& X)
{
  return 0.02 * Vec3(std::sin(30 * X.x() + 9), std::cos(25 * X.y() - X.z()), std::sin(40 * X.z()));
}

}  // namespace trocar::test
