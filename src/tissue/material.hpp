#pragma once

#include <optional>

namespace trocar::tissue {

enum class Model { linear, corotational, neo_hookean };

/// Tangent of corotational tissue. `rotated`: R K₀ Rᵀ, the rotations held, as in the needle paper.
/// `exact`: the full derivative. `automatic`: `rotated` until it converges too slowly in a step,
/// then `exact`.
enum class Tangent { rotated, exact, automatic };

/// Isotropic elasticity and mass of one tissue.
struct Material
{
  double young = 5000.0;            ///< E [Pa]
  double poisson = 0.45;            ///< ν, < 0.5
  double density = 1000.0;          ///< ρ [kg/m³]
  double rayleigh_mass = 0.0;       ///< α [1/s] in B = αM + βK
  double rayleigh_stiffness = 0.0;  ///< β [s]
  std::optional<Model> model{};     ///< law; empty: ElementSettings::model

  double lambda() const  ///< first Lamé constant [Pa]
  {
    return young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
  }
  double mu() const { return young / (2.0 * (1.0 + poisson)); }  ///< shear modulus [Pa]
};

}  // namespace trocar::tissue
