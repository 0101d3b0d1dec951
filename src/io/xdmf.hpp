#pragma once

#include <string>
#include <vector>

namespace trocar::io {

/// One field file as run.xdmf (XDMF 3) describes it to ParaView: names and shapes of datasets.
struct XdmfFrame
{
  struct Attribute
  {
    std::string name;     ///< path of the dataset
    std::size_t columns;  ///< values per row; 0 for scalars
    bool cell;            ///< values per tet; false: per node

    bool operator==(const Attribute&) const = default;
  };
  /// A polyline through `points` points: datasets NAME/axis (points, 3) and NAME/radius (points).
  struct Curve
  {
    std::string name;
    std::size_t points;

    bool operator==(const Curve&) const = default;
  };
  int step;
  double time;  ///< [s]
  std::vector<Attribute> attributes;
  std::vector<Curve> curves;

  bool operator==(const XdmfFrame&) const = default;
};

/// Sizes of the mesh in run.h5.
struct XdmfMesh
{
  std::size_t nodes, tets;
  int nodes_per_tet;
};

/// Path of a field file, relative to the result folder.
std::string step_file(int step);

/// The text of run.xdmf: one temporal collection for the tissue and one for each curve. (One
/// collection per time would do too, but ParaView's reader then renames the blocks.)
std::string xdmf_text(const XdmfMesh& mesh, const std::vector<XdmfFrame>& frames);

}  // namespace trocar::io
