#pragma once

#include <vector>

#include "constraint/set.hpp"

namespace trocar::contact {

using core::Vec3;

/// A slave corner that touched at the end of a step. Friction is measured from where it last
/// slipped: with the weights of then, from the tangential distance of then.
struct Touch
{
  int node = -1;                     ///< file node of the corner
  Vec3 lambda = Vec3::Zero();        ///< multipliers (n, t1, t2) [N]
  constraint::Anchor slave, master;  ///< weights; no master nodes: an obstacle
  Vec3 apart = Vec3::Zero();  ///< (0, t1, t2): tangential distance from slave to master then [m]
  /// Mean place of the slave then, on an obstacle, as if that had not moved; else zero [m].
  Vec3 place = Vec3::Zero();

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("node", "1", self.node);
    v("lambda", "N", self.lambda);
    v("slave", "", self.slave);
    v("master", "", self.master);
    v("apart", "m", self.apart);
    v("place", "m", self.place);
  }
};

/// How far a slave corner overlapped the master at the start: what counts as closed there.
struct Overlapped
{
  int node = -1;    ///< file node of the corner
  double by = 0.0;  ///< > 0 [m]

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("node", "1", self.node);
    v("by", "m", self.by);
  }
};

/// State of one pair; lists by ascending node.
struct PairState
{
  std::vector<Touch> touches;          ///< corners that touch
  std::vector<Overlapped> overlapped;  ///< as the bodies were given

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("touch", "", self.touches);
    v("overlapped", "", self.overlapped);
  }
};

struct State
{
  std::vector<PairState> pairs;

  /// See core/visit.hpp.
  template <class Self, class Visitor>
  static void visit(Self& self, Visitor& v)
  {
    v("pair", "", self.pairs);
  }
};

/// Whether the same corners touch.
bool same_touching(const State& a, const State& b);

}  // namespace trocar::contact
