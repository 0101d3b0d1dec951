#include "insertion/line_compliance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace trocar::insertion {
namespace {

/// Repeated antiderivatives of a kernel, from the first to the fourth.
struct Antiderivatives
{
  double first, second, third, fourth;
};

/// Of 1/√(d² + R²).
Antiderivatives of_distance(double d, double R)
{
  const double rho = std::hypot(d, R), a = std::asinh(d / R), R2 = R * R;
  return {a, d * a - rho, (0.5 * d * d - 0.25 * R2) * a - 0.75 * d * rho,
          d * (d * d / 6.0 - 0.25 * R2) * a + rho * (5.0 / 12.0 * R2 - 11.0 / 36.0 * rho * rho)};
}

/// Of R²/(d² + R²)^{3/2}.
Antiderivatives of_cube(double d, double R)
{
  const double rho = std::hypot(d, R), a = std::asinh(d / R), R2 = R * R;
  return {d / rho, rho, 0.5 * (d * rho + R2 * a), rho * rho * rho / 6.0 + 0.5 * R2 * (d * a - rho)};
}

/// One corner of the double integral by parts: what s = `a` and s' = `b` contribute.
double corner(const Antiderivatives& K, double f, double slope_f, double g, double slope_g)
{
  return -g * (f * K.second - slope_f * K.third) - slope_g * (f * K.third - slope_f * K.fourth);
}

}  // namespace

Potential potential(const LinearPart& f, const LinearPart& g, double r, double R)
{
  Potential sum{0.0, 0.0};
  for (int at_f : {0, 1})
    for (int at_g : {0, 1}) {
      const double s = at_f ? f.end : f.begin, other = at_g ? g.end : g.begin;
      const double value_f = f.value + f.slope * (s - f.begin);
      const double value_g = g.value + g.slope * (other - g.begin);
      const auto part = [&](const Antiderivatives& K) {
        return (at_f == at_g ? 1.0 : -1.0) * corner(K, value_f, f.slope, value_g, g.slope);
      };
      const double d = s - other;
      const double distance = part(of_distance(d, r)) - part(of_distance(d, R));
      sum.along += distance;
      sum.across += distance + 0.5 * (part(of_cube(d, r)) - part(of_cube(d, R)));
    }
  return sum;
}

Potential potential_at(double s, const LinearPart& g, double r, double R)
{
  Potential sum{0.0, 0.0};
  for (int end : {0, 1}) {
    const double other = end ? g.end : g.begin;
    const double value = g.value + g.slope * (other - g.begin);
    const auto part = [&](const Antiderivatives& K) {
      return (end ? -1.0 : 1.0) * (value * K.first + g.slope * K.second);
    };
    const double d = s - other;
    const double distance = part(of_distance(d, r)) - part(of_distance(d, R));
    sum.along += distance;
    sum.across += distance + 0.5 * (part(of_cube(d, r)) - part(of_cube(d, R)));
  }
  return sum;
}

EffectiveRadius effective_radius(bool quadratic, tissue::Dilatation dilatation, double poisson)
{
  // Fitted at ν = 0.3, 0.45 and 0.49, linear between them. Linear tets lock above 0.45.
  const double part = std::clamp((poisson - 0.3) / 0.15, 0.0, 1.0);
  const double more = std::clamp((poisson - 0.45) / 0.04, 0.0, 1.0);
  if (!quadratic && dilatation == tissue::Dilatation::pointwise)
    return {0.165 + 0.060 * part, 0.027 + 0.015 * part, 0.967};
  if (!quadratic) return {0.143, 0.027, 0.927};
  if (dilatation == tissue::Dilatation::pointwise)
    return {0.062 + 0.007 * part + 0.016 * more, 0.0, 1.0 + 0.05 * more};
  if (dilatation == tissue::Dilatation::element)
    return {0.062, 0.0, 0.985 - 0.040 * part - 0.02 * more};
  return {0.062, 0.0, 1.0};
}

namespace {

/// What the mesh resolves around the path, and the roots of the factors before the kernels, so that
/// their product is the factor of a pair.
struct Around
{
  double axial_radius = 0.0, lateral_radius = 0.0;  ///< effective [m]
  double axial = 0.0, across = 0.0, along = 0.0;    ///< [(m²/N)^½]
};

/// In the tissue of a tet, with edges of this length [m] around a shaft of this radius [m].
Around around(const Ground& ground, int tet, double edge, double radius)
{
  const tissue::Material& tissue = ground.material(tet);
  const double nu = tissue.poisson, mu = tissue.mu();
  const double x = std::max(radius / edge, ground.settings.line.ring);
  const EffectiveRadius fit =
      effective_radius(ground.mesh.quadratic(), ground.settings.line.dilatation, nu);
  const double f = (x + fit.offset + fit.inverse / x) * edge;
  const double least = ground.settings.line.ring / x;
  const double across = 16.0 * std::numbers::pi * mu * (1.0 - nu);
  return {f, f * (1.0 - (1.0 - fit.lateral) * least * least),
          1.0 / std::sqrt(4.0 * std::numbers::pi * mu), 1.0 / std::sqrt(across),
          std::sqrt(std::max(2.0 - 4.0 * nu, 0.0) / across)};
}

/// A cell of the grid behind the tip: the part of two hats.
struct Cell
{
  int node, chain;
  double begin, end;
  double surface;  ///< arc of the surface where the tissue begins [m]
  Around tissue{};
};

/// Means over the stations of a cell. False where it has none.
bool add_tissue(const Ground& ground, const Line& line, double radius, Cell& cell)
{
  const LineNode& node = line.nodes[static_cast<std::size_t>(cell.node)];
  double length = 0.0;
  Around& mean = cell.tissue;
  each_station(line, [&](const Station& station) {
    if (station.stretch != node.stretch || station.arc <= cell.begin || station.arc >= cell.end)
      return;
    const Around here = around(ground, station.tet, node.edge, radius);
    const double w = station.length;
    length += w;
    mean.axial_radius += w * here.axial_radius;
    mean.lateral_radius += w * here.lateral_radius;
    mean.axial += w * here.axial;
    mean.across += w * here.across;
    mean.along += w * here.along;
  });
  for (double* sum :
       {&mean.axial_radius, &mean.lateral_radius, &mean.axial, &mean.across, &mean.along})
    *sum /= length;
  return length > 0.0;
}

std::vector<Cell> cells_behind(const Ground& ground, const Line& line, double tip, double radius)
{
  std::vector<Cell> cells;
  int chain = -1;
  double surface = 0.0;
  for (std::size_t s = 0; s < line.stretches.size(); ++s) {
    const Stretch& stretch = line.stretches[s];
    const bool goes_on = s > 0 && line.stretches[s - 1].end == stretch.begin &&
                         ground.body(line.stretches[s - 1].tet) == ground.body(stretch.tet);
    if (!goes_on) {
      ++chain;
      surface = stretch.begin;
    }
    const int last = s + 1 < line.stretches.size() ? line.stretches[s + 1].first : line.hats();
    for (int node = stretch.first; node + 1 < last; ++node) {
      const double begin = line.nodes[static_cast<std::size_t>(node)].arc;
      const double next = line.nodes[static_cast<std::size_t>(node) + 1].arc;
      Cell cell{node, chain, begin, std::min({next, stretch.end, tip}), surface};
      if (add_tissue(ground, line, radius, cell)) cells.push_back(cell);
    }
  }
  return cells;
}

/// The two hats of a cell: falling and rising.
std::array<LinearPart, 2> hats_of(const Line& line, const Cell& cell)
{
  const double length = line.nodes[static_cast<std::size_t>(cell.node) + 1].arc - cell.begin;
  return {{{cell.begin, cell.end, 1.0, -1.0 / length}, {cell.begin, cell.end, 0.0, 1.0 / length}}};
}

LinearPart mirrored(const LinearPart& f, double surface)
{
  return {2.0 * surface - f.end, 2.0 * surface - f.begin, f.value + f.slope * (f.end - f.begin),
          -f.slope};
}

/// 1/∫φ ds of every hat that holds something behind the tip, else 0 [1/m].
core::VecX per_length(const Line& line, double tip)
{
  core::VecX held(line.hats());
  for (int k = 0; k < line.hats(); ++k) {
    const double length = moments(line, k, 0.0, tip).length;
    held[k] = length > 0.0 ? 1.0 / length : 0.0;
  }
  return held;
}

/// Adds what a pair of cells contributes to the compliances of their hats.
void add_pair(const Line& line, const Cell& a, const Cell& b, double radius, LineCompliance& C)
{
  // The lesser radius of two cells keeps the matrix positive semidefinite: the kernel is an
  // integral over R of positive definite ones, and each cell takes part up to its own R.
  const double R = std::min(a.tissue.axial_radius, b.tissue.axial_radius);
  const double R_across = std::min(a.tissue.lateral_radius, b.tissue.lateral_radius);
  const auto f = hats_of(line, a), g = hats_of(line, b);
  for (int i : {0, 1})
    for (int j : {0, 1}) {
      const LinearPart& fi = f[static_cast<std::size_t>(i)];
      const LinearPart& gj = g[static_cast<std::size_t>(j)];
      if (R > radius)
        C.axial(a.node + i, b.node + j) +=
            a.tissue.axial * b.tissue.axial * potential(fi, gj, radius, R).along;
      if (!(R_across > radius)) continue;
      for (const LinearPart& part : {gj, mirrored(gj, b.surface)}) {
        const Potential p = potential(fi, part, radius, R_across);
        C.lateral(a.node + i, b.node + j) += a.tissue.along * b.tissue.along * p.along +
                                             a.tissue.across * b.tissue.across * p.across;
      }
    }
}

}  // namespace

LineCompliance hidden_compliance(const Ground& ground, const Line& line, double tip, double radius)
{
  const Eigen::Index hats = line.hats();
  LineCompliance C{core::MatX::Zero(hats, hats), core::MatX::Zero(hats, hats)};
  const std::vector<Cell> cells = cells_behind(ground, line, tip, radius);
  for (const Cell& a : cells)
    for (const Cell& b : cells)
      if (a.chain == b.chain) add_pair(line, a, b, radius, C);
  const core::VecX held = per_length(line, tip);
  for (core::MatX* all : {&C.axial, &C.lateral}) {
    *all = held.asDiagonal() * *all * held.asDiagonal();
    *all = 0.5 * (*all + all->transpose()).eval();
  }
  return C;
}

TipCompliance hidden_at_tip(const Ground& ground, const Line& line, double tip, double radius)
{
  TipCompliance C{core::VecX::Zero(line.hats()), core::VecX::Zero(line.hats())};
  const std::vector<Cell> cells = cells_behind(ground, line, tip, radius);
  if (cells.empty()) return C;
  const int chain = cells.back().chain;
  for (const Cell& cell : cells) {
    if (cell.chain != chain) continue;
    // With the radius of the cell, not of the tip's: so nothing jumps when the tip enters a cell.
    const Around& at = cell.tissue;
    const auto hats = hats_of(line, cell);
    for (int i : {0, 1}) {
      const LinearPart& g = hats[static_cast<std::size_t>(i)];
      if (at.axial_radius > radius)
        C.axial[cell.node + i] +=
            at.axial * at.axial * potential_at(tip, g, radius, at.axial_radius).along;
      if (!(at.lateral_radius > radius)) continue;
      for (const LinearPart& part : {g, mirrored(g, cell.surface)}) {
        const Potential p = potential_at(tip, part, radius, at.lateral_radius);
        C.lateral[cell.node + i] +=
            at.along * at.along * p.along + at.across * at.across * p.across;
      }
    }
  }
  const core::VecX held = per_length(line, tip);
  C.axial.array() *= held.array();
  C.lateral.array() *= held.array();
  return C;
}

double length_passed(const Ground& ground, const TipMove& move)
{
  const double edge = ground.edges->at(move.tet, move.X);
  const Around at = around(ground, move.tet, edge, move.radius);
  if (!(move.density > 0.0 && move.moved > 0.0 && at.axial_radius > move.radius)) return move.moved;
  const double factor = move.density * at.axial * at.axial;
  const auto hidden = [&](double s) {
    return factor * (std::asinh(s / move.radius) - std::asinh(s / at.axial_radius));
  };
  const auto slope = [&](double s) {
    return factor * (1.0 / std::hypot(s, move.radius) - 1.0 / std::hypot(s, at.axial_radius));
  };
  // Concave and growing: Newton's method from 0 comes from one side and stays between 0 and
  // `moved`.
  double passed = 0.0;
  for (int k = 0; k < 50; ++k) {
    const double rest = move.moved - passed - (hidden(move.depth + passed) - hidden(move.depth));
    passed += rest / (1.0 + slope(move.depth + passed));
    if (std::abs(rest) <= 1e-14 * move.moved) break;
  }
  return std::clamp(passed, 0.0, move.moved);
}

}  // namespace trocar::insertion
