#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fem/space.hpp"
#include "insertion/path.hpp"
#include "mesh/quadratic.hpp"

namespace trocar::insertion {

/// The deformed tissue: reference mesh plus displacement of every node. Maps between places in the
/// world and in the reference. Equal on every rank; not collective. Borrows everything.
class Deformed
{
 public:
  Deformed(const mesh::Mesh& mesh, const mesh::Locator& locator, const fem::GlobalField& u);

  Vec3 position(const constraint::Anchor& anchor) const;  ///< where the anchor is now [m]

  Vec3 place(const Vec3& X, int tet) const;  ///< where the reference place X in a tet is now [m]

  /// A reference place and the tet that it was found in.
  struct Place
  {
    Vec3 X;
    int tet;
  };
  /// Reference place of the world point x, searched first around the reference place `guess`;
  /// nothing when x is in no tet.
  std::optional<Place> reference_place(const Vec3& x, const Vec3& guess) const;

  /// The same with the map of one tet, extrapolated beyond its faces: for a tip outside the tissue.
  Vec3 reference_place_continued(const Vec3& x, int tet) const;

  /// A way of a segment through the tissue: the reference place X and the tet where it enters, the
  /// last tet that it passes before it leaves the tissue or ends, and the part of the line through
  /// P (0) and Q (1) between them.
  struct Entry
  {
    Vec3 X;
    int first_tet, last_tet;
    double low, high;
  };
  /// All ways of the world segment from P to Q, in order. With `body_of_node`, bodies that touch or
  /// overlap have a way each.
  std::vector<Entry> entries(const Vec3& P, const Vec3& Q,
                             std::span<const int> body_of_node = {}) const;

  /// True when the world segment P Q meets the tissue at all.
  bool meets(const Vec3& P, const Vec3& Q) const;

 private:
  std::array<Vec3, 4> corners_now(int tet) const;
  mesh::TetPositions positions_now(int tet) const;
  /// Part of a segment in one tet.
  struct Stretch
  {
    double low, high;
    int tet;
  };
  std::optional<double> through_curved_face(int tet, const Vec3& P, const Vec3& Q, double t,
                                            double stretch) const;
  Entry entry_of(std::vector<Stretch> starts, const Vec3& P, const Vec3& Q) const;
  std::vector<Entry> ways(std::vector<Stretch> stretches, const Vec3& P, const Vec3& Q) const;
  std::vector<int> candidates(const Vec3& low, const Vec3& high) const;
  Vec3 pull_back(int tet, const Vec3& x) const;

  const mesh::Mesh* mesh_;
  const mesh::Locator* locator_;
  const fem::GlobalField* u_;
  double largest_displacement_;  ///< [m]; bounds how far a tet leaves its reference box
};

}  // namespace trocar::insertion
