#include "contact/mortar.hpp"

#include <algorithm>
#include <boost/geometry/index/rtree.hpp>
#include <iterator>
#include <map>

#include "contact/flats.hpp"

namespace trocar::contact {
namespace {

/// Integrals of one corner, not yet divided by `area`.
struct Sums
{
  std::map<int, double> slave, master;
  double gap = 0.0, area = 0.0;
  double least = std::numeric_limits<double>::infinity();  ///< distance of a point [m]
  Vec3 normal = Vec3::Zero();

  void add(const Sums& other)
  {
    least = std::min(least, other.least);
    for (const auto& [node, weight] : other.slave) slave[node] += weight;
    for (const auto& [node, weight] : other.master) master[node] += weight;
    gap += other.gap;
    area += other.area;
    normal += other.normal;
  }
};

/// A point of the integration: place and normal on the slave, weight [m²].
struct SlavePoint
{
  int face;
  Param at;
  double weight;
  Vec3 x, normal;
};

void add_weights(const Surface& surface, int face, const Param& at, double w,
                 std::map<int, double>& weights)
{
  const FaceShape shape = face_shape(surface.nodes_per_face(), at);
  for (int k = 0; k < surface.nodes_per_face(); ++k)
    weights[surface.face(face)[static_cast<std::size_t>(k)]] += w * shape.value[k];
}

/// Integrates over the slave surface of a pair.
class Mortar
{
 public:
  Mortar(const Pair& pair, const Deformation& now)
      : pair_(pair),
        now_(now),
        slave_(pair.slave),
        corner_normal_(slave_.normals(now)),
        sums_(slave_.corners().size())
  {
  }

  std::vector<Meeting> run()
  {
    const auto* obstacle = std::get_if<Obstacle>(&pair_.master);
    if (obstacle && obstacle->shape != Obstacle::Shape::surface)
      against(*obstacle);
    else
      against_faces();
    join();
    return meetings();
  }

 private:
  SlavePoint slave_point(const FacePlaces& face, const Flat& flat, const Eigen::Vector3d& at,
                         double area) const
  {
    SlavePoint point{flat.face, flat.param(at), area, {}, Vec3::Zero()};
    const FacePoint place = face_point(face, point.at);
    point.x = place.x;
    const double parts = flat_count(face.count);
    const double flat_area = 0.5 * (flat.x[1] - flat.x[0]).cross(flat.x[2] - flat.x[0]).norm();
    point.weight *= area_element(place) / (parts * flat_area);
    const FaceShape linear = face_shape(3, point.at);
    for (std::size_t k = 0; k < 3; ++k)
      point.normal +=
          linear.value[static_cast<Eigen::Index>(k)] * corner_normal_[corner(flat.face, k)];
    point.normal.normalize();
    return point;
  }
  std::size_t corner(int face, std::size_t k) const
  {
    return static_cast<std::size_t>(slave_.corner_of(slave_.face(face)[k]));
  }

  /// Adds a point with the distance `gap` to what is before it.
  template <class AddMaster>
  void add(const SlavePoint& point, double gap, const Vec3& normal, const AddMaster& add_master)
  {
    const FaceShape linear = face_shape(3, point.at);
    for (std::size_t k = 0; k < 3; ++k) {
      Sums& sums = sums_[corner(point.face, k)];
      const double w = point.weight * linear.value[static_cast<Eigen::Index>(k)];
      sums.gap += w * gap;
      sums.least = std::min(sums.least, gap);
      sums.area += w;
      sums.normal += w * normal;
      add_weights(slave_, point.face, point.at, w, sums.slave);
      add_master(w, sums.master);
    }
  }

  /// The master's faces: those of a surface of the tissue, or of a rigid one.
  void against_faces()
  {
    master_ = std::get_if<Surface>(&pair_.master);
    others_ = master_ ? flats(*master_, now_) : flats(std::get<Obstacle>(pair_.master), now_.t);
    const Box reach = bounds_of(slave_, now_).grown(pair_.search);
    const auto apart = [&](const Flat& other) {
      return !bg::intersects(reach, other.bounds().grown(0.0));
    };
    others_.erase(std::remove_if(others_.begin(), others_.end(), apart), others_.end());
    std::vector<std::pair<Box, int>> boxes;
    for (std::size_t k = 0; k < others_.size(); ++k)
      boxes.emplace_back(others_[k].bounds().grown(0.0), static_cast<int>(k));
    const bg::index::rtree<std::pair<Box, int>, bg::index::quadratic<16>> tree(boxes);
    for (const Flat& mine : flats(slave_, now_)) {
      std::vector<std::pair<Box, int>> hits;
      tree.query(bg::index::intersects(mine.bounds().grown(pair_.search)),
                 std::back_inserter(hits));
      std::sort(hits.begin(), hits.end(),
                [](const auto& a, const auto& b) { return a.second < b.second; });
      const FacePlaces face = slave_.places(mine.face, now_);
      hits_.clear();
      for (const auto& hit : hits) hits_.push_back(hit.second);
      for (int hit : hits_) overlapping(face, mine, others_[static_cast<std::size_t>(hit)]);
    }
  }

  void overlapping(const FacePlaces& face, const Flat& mine, const Flat& other)
  {
    for (const Overlap& piece : overlap(mine.x, other.x, pair_.search)) {
      const FacePlaces onto = master_ ? master_->places(other.face, now_)
                                      : FacePlaces{3, {other.x[0], other.x[1], other.x[2]}};
      for (const TrianglePoint& at : triangle_points()) {
        const SlavePoint point =
            slave_point(face, mine, piece.slave * at.at, at.weight * piece.area);
        const Projection there =
            project(onto, point.x, point.normal, other.param(piece.master * at.at));
        if (!there.found || std::abs(there.t) > pair_.search || behind(point, there.t)) continue;
        add(point, there.t, point.normal, [&](double w, std::map<int, double>& weights) {
          if (master_) add_weights(*master_, other.face, there.at, w, weights);
        });
      }
    }
  }

  /// True when another master face is met nearer than at the distance t: a body may have several
  /// layers within the search distance. Nearer by less than a tenth of its edge is the same layer.
  /// An overlap (t < 0) with the back of a face in between is none: the face there belongs to the
  /// far side of the master.
  bool behind(const SlavePoint& point, double t) const
  {
    constexpr double same = 0.1, rim = 1e-9, oblique = 0.2;
    for (int hit : hits_) {
      const Triangle& x = others_[static_cast<std::size_t>(hit)].x;
      core::Mat3 sides;
      sides << x[1] - x[0], x[2] - x[0], -point.normal;
      const Vec3 normal = sides.col(0).cross(sides.col(1));
      const double facing = -normal.dot(point.normal) / normal.norm();
      const bool back = facing < -oblique && t < 0.0;
      if (facing <= oblique && !back) continue;
      const Vec3 at = sides.inverse() * (point.x - x[0]);
      const bool inside = at[0] >= -rim && at[1] >= -rim && at[0] + at[1] <= 1.0 + rim;
      if (!inside) continue;
      if (back && at[2] < 0.0 && at[2] > t) return true;
      const bool nearer = std::abs(at[2]) < std::abs(t) - same * sides.col(0).norm();
      if (!back && nearer) return true;
    }
    return false;
  }

  void against(const Obstacle& obstacle)
  {
    const Vec3 by = obstacle.moved(now_.t);
    for (const Flat& mine : flats(slave_, now_)) {
      const FacePlaces face = slave_.places(mine.face, now_);
      const double area = 0.5 * (mine.x[1] - mine.x[0]).cross(mine.x[2] - mine.x[0]).norm();
      for (const TrianglePoint& at : triangle_points()) {
        const SlavePoint point = slave_point(face, mine, at.at, at.weight * area);
        const Clearance there = clearance(obstacle, point.x - by);
        add(point, there.distance, -there.outward, [](double, std::map<int, double>&) {});
      }
    }
  }

  /// Corners that cannot carry a multiplier of their own give their part to a neighbour. The
  /// functions still add up to 1 on the covered part, which is all that a patch test needs.
  void join()
  {
    constexpr double least_covered = 1e-3;
    const std::vector<double> whole = slave_.areas(now_);
    std::vector<bool> weak(sums_.size());
    for (std::size_t j = 0; j < sums_.size(); ++j)
      weak[j] = sums_[j].area < least_covered * whole[j] || (!pair_.held.empty() && pair_.held[j]);
    for (std::size_t j = 0; j < sums_.size(); ++j) {
      if (!weak[j]) continue;
      int strongest = -1;
      for (int near : slave_.neighbours(static_cast<int>(j))) {
        const auto n = static_cast<std::size_t>(near);
        if (weak[n]) continue;
        if (strongest < 0 || sums_[n].area > sums_[static_cast<std::size_t>(strongest)].area)
          strongest = near;
      }
      const bool held = !pair_.held.empty() && pair_.held[j];
      if (strongest < 0 && !held) continue;  // nobody takes its part
      if (strongest >= 0) sums_[static_cast<std::size_t>(strongest)].add(sums_[j]);
      sums_[j] = {};
    }
  }

  std::vector<Meeting> meetings() const
  {
    std::vector<Meeting> found;
    const bool obstacle = std::holds_alternative<Obstacle>(pair_.master);
    for (std::size_t j = 0; j < sums_.size(); ++j) {
      const Sums& sums = sums_[j];
      if (!(sums.area > 0.0)) continue;
      const double gap = sums.gap / sums.area;
      if (obstacle && gap > pair_.search) continue;
      Meeting meeting{slave_.corners()[j], {}, {}, gap, corner_normal_[j], sums.area, sums.least};
      if (obstacle) meeting.normal = sums.normal.normalized();
      meeting.slave = mean(sums.slave, sums.area);
      if (!obstacle) meeting.master = mean(sums.master, sums.area);
      found.push_back(std::move(meeting));
    }
    return found;
  }
  static constraint::Anchor mean(std::map<int, double> weights, double area)
  {
    for (auto& [node, weight] : weights) weight /= area;
    return constraint::anchor_of(weights);
  }

  const Pair& pair_;
  const Deformation& now_;
  const Surface& slave_;
  std::vector<Vec3> corner_normal_;
  std::vector<Sums> sums_;           ///< by corner
  const Surface* master_ = nullptr;  ///< nothing: an obstacle
  std::vector<Flat> others_;         ///< of the master
  std::vector<int> hits_;            ///< those near the present triangle of the slave
};

}  // namespace

std::vector<Meeting> meet(const Pair& pair, const Deformation& now)
{
  return Mortar(pair, now).run();
}

bool near(const Pair& pair, const Deformation& now)
{
  const Bounds mine = bounds_of(pair.slave, now);
  if (const auto* surface = std::get_if<Surface>(&pair.master))
    return bg::intersects(mine.grown(pair.search), bounds_of(*surface, now).grown(0.0));
  const Vec3 middle = 0.5 * (mine.low + mine.high);
  const double reach = 0.5 * (mine.high - mine.low).norm() + pair.search;
  const auto& obstacle = std::get<Obstacle>(pair.master);
  if (obstacle.skin)
    return bg::intersects(mine.grown(pair.search), bounds_of(obstacle, now.t).grown(0.0));
  return clearance(obstacle, middle - obstacle.moved(now.t)).distance < reach;
}

}  // namespace trocar::contact
