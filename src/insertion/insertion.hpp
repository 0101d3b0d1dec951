#pragma once

#include <optional>
#include <string>
#include <vector>

#include "constraint/set.hpp"
#include "insertion/deformed.hpp"
#include "insertion/membranes.hpp"
#include "insertion/path.hpp"
#include "insertion/radius_correction.hpp"
#include "insertion/tip.hpp"
#include "law/problem.hpp"
#include "needle/needle.hpp"

namespace trocar::insertion {

/// `contact`: the tip presses on the surface, which is not punctured yet; the path is that place.
enum class Phase { outside, contact, inserted, withdrawn };

/// State of one coupling point: a material place of the tissue held by the shaft. A point is born
/// when the tip passes it, slipping, as if it had slipped for the whole step.
struct CouplingPoint
{
  int site = 0;                ///< index in Path::sites, its identity
  double needle_arc = 0.0;     ///< arc length on the needle it sticks to [m]; moves only in slip
  bool stuck = true;           ///< at the end of the last step
  Vec3 lambda = Vec3::Zero();  ///< two lateral multipliers and the axial one [N]

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("site", "1", self.site);
    v("needle_arc", "m", self.needle_arc);
    v("stuck", "1", self.stuck);
    v("lambda", "N", self.lambda);
  }
};

/// How one needle sits in the tissue. A value, equal on every rank.
struct InsertionState
{
  Phase phase = Phase::outside;
  Path path;
  double tip_arc = 0.0;               ///< where the tip is along the path [m]
  bool withdrawing = false;           ///< the tip last moved backwards along the path
  std::vector<CouplingPoint> points;  ///< by site, all at or behind the tip
  TipState tip;

  bool touches() const { return tip.pressed || !points.empty(); }  ///< rows are to be made

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("phase", "1", self.phase);
    v("path", "", self.path);
    v("tip_arc", "m", self.tip_arc);
    v("withdrawing", "1", self.withdrawing);
    v("point", "", self.points);
    v("tip", "", self.tip);
  }
};

/// Shaft friction per length of one tissue in one direction (docs/theory.md section 5).
struct Friction
{
  double static_limit = 0.0;   ///< F/ℓ of a point that stuck at the start of the step [N/m]
  double dynamic_limit = 0.0;  ///< F/ℓ of a slipping point [N/m]
  double viscous = 0.0;        ///< b: force per length and slip velocity [N s/m²]
};

/// Friction of one tissue while the needle advances and while it is withdrawn.
struct TissueFriction
{
  Friction advance, withdraw;
};

struct InsertionSettings
{
  PlacementSettings placement;
  std::vector<TissueFriction> friction;  ///< by volume of the mesh
  double eta = 0.0;  ///< > 0: the axial force is η times that of sticking, instead of all friction
  double stick_tolerance = 1e-9;  ///< |δ| below which a point has stuck [m]
  TipSettings tip{};
  PunctureSettings puncture{};
  std::optional<RadiusCorrection> radius_correction{};
};

/// Which rows a coupling point got in a set, and where it was on the shaft.
struct PointRows
{
  int first = -1;      ///< first of two lateral rows, -1 when there is none
  int axial = -1;      ///< row of the box (or η) law, -1 when there is none
  int viscous = -1;    ///< row of the dashpot, -1 when there is none
  double bound = 0.0;  ///< F of the box row [N]
  double slid = 0.0;   ///< axial gap when the rows were made [m]
};

/// Rows of one needle in a set.
struct CouplingRows
{
  std::vector<PointRows> points;
  int lever = -1;  ///< first of two lateral rows at a tip that one point alone would let turn
  TipRows tip;
};

/// What one needle's coupling did in a step.
struct CouplingReport
{
  double shaft_friction = 0.0;  ///< Σ axial λ [N], > 0 resists insertion
  double friction_work = 0.0;   ///< Σ λ δ of the axial rows [J], <= 0 (η law: no such bound)
  double tip_force = 0.0;       ///< axial λ on the tip [N], >= 0
  double tip_gap = 0.0;         ///< δ of the tip's axial row [m], < 0 where it advanced
  double cutting_work = 0.0;    ///< λ δ of the tip's axial row [J], <= 0
  TipOutcome tip = TipOutcome::holds;  ///< anything else: call `settle`
};

/// The coupling of needles and tissue: path, coupling points and their rows.
/// Nothing here is collective: every rank computes the same from the same.
class Insertion
{
 public:
  /// Borrows mesh and locator.
  Insertion(const mesh::Mesh& mesh, const mesh::Locator& locator, InsertionSettings settings);

  /// State of a needle that starts `inserted` deep along its direction: path and points are made
  /// on the undeformed mesh. Throws Failure (65) when that path never meets the tissue.
  InsertionState start(const needle::Needle& needle) const;

  /// Events of a step, decided before the solve: the tip at its predicted place is mapped through
  /// the old deformation; the path grows where nothing resists, points are born at the tip or
  /// dropped ahead of it.
  InsertionState advance(const InsertionState& old, const needle::Shaft& predicted,
                         const Deformed& tissue) const;

  /// True when a needle that is not in its channel lies in the tissue all the same: its shaft went
  /// in from the side, which nothing here models.
  bool astray(const InsertionState& state, const needle::Shaft& shaft,
              const Deformed& tissue) const;

  /// Adds this needle's rows at the iterate (deformed tissue and shaft); `body` is its index among
  /// the small bodies, `h` the step length [s], 0 when no time passes: dashpots are then absent.
  CouplingRows add_rows(const InsertionState& state, const needle::Shaft& shaft,
                        const Deformed& tissue, int body, double h, constraint::Set& set) const;

  /// Takes multipliers and end-of-step gaps back into points and tip: stick or slip, hold or yield.
  CouplingReport accept(InsertionState& state, const CouplingRows& rows,
                        const law::Multipliers& multipliers) const;

  /// What the tip did in the step, once shaft and tissue are where they end: where the tissue
  /// yielded the path grows by the tip's advance, up to the next border; on a surface it touches
  /// where it slid to; a tip that came apart is where it is.
  void settle(InsertionState& state, const CouplingReport& report, const needle::Shaft& shaft,
              const Deformed& tissue) const;

  /// Depth: length of the inserted path that lies in tissue [m].
  double depth(const InsertionState& state) const;

  /// ∫ over the piece of path nearest to each point [m] per tissue volume, so that the sum over
  /// points is the inserted length in tissue. Shape (points, volumes).
  core::MatX tributary_lengths(const InsertionState& state) const;

 private:
  InsertionState enter(const InsertionState& old, const needle::Shaft& predicted,
                       const Deformed& tissue) const;
  double border(int from, int to, const Vec3& X) const;
  void touch_surface(InsertionState& state, const Vec3& X, const needle::Shaft& shaft) const;
  void leave_surface(InsertionState& state) const;
  bool stand(InsertionState& state, const needle::Shaft& shaft, const Deformed& tissue) const;
  void grow_to(InsertionState& state, const Vec3& X) const;
  double resistance(const InsertionState& state) const;
  void press(InsertionState& state, double arc, const needle::Shaft& shaft,
             const Deformed& tissue) const;
  int add_lever_rows(const InsertionState& state, const needle::Shaft& shaft,
                     const Deformed& tissue, int body, constraint::Set& set) const;
  Vec3 lead(const InsertionState& state, const needle::Shaft& shaft, const Deformed& tissue) const;
  Friction friction_of(const InsertionState& state, const core::MatX& tributary,
                       std::size_t point) const;
  std::vector<bool> lateral_points(const InsertionState& state) const;
  RadiusCorrection::Softness radius_softness(const Site& site, int body, double length) const;
  PointRows add_point_rows(const CouplingPoint& point, bool lateral, const Path& path,
                           const Friction& friction, double length, double held,
                           const needle::Shaft& shaft, const Deformed& tissue, int body, double h,
                           constraint::Set& set) const;
  void add_axial_rows(const CouplingPoint& point, const Friction& friction, double h,
                      double radius_softness, constraint::Row row, PointRows& mine,
                      constraint::Set& set) const;
  void accept_point(CouplingPoint& point, const PointRows& rows,
                    const law::Multipliers& multipliers, CouplingReport& report) const;
  void drop_points_ahead(InsertionState& state, double arc) const;
  void add_points_behind(InsertionState& state, double arc, double needle_length) const;
  bool passed(const InsertionState& state, std::size_t site, double arc) const;

  const mesh::Mesh* mesh_;
  const mesh::Locator* locator_;
  InsertionSettings settings_;
  Membranes membranes_;
  bool resists_;  ///< some border or tissue resists the tip
};

}  // namespace trocar::insertion
