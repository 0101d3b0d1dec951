#pragma once

#include <string>
#include <vector>

namespace trocar::io {

/// What ParaView is shown of one field file: names, shapes, places. XDMF 3.
struct XdmfFrame
{
  struct Attribute
  {
    std::string name;     ///< path of the dataset
    std::size_t columns;  ///< 0 for scalars
    bool cell;            ///< by tet, else by node
  };
  /// A polyline through `points` points: datasets NAME/axis (points, 3) and NAME/radius (points).
  struct Curve
  {
    std::string name;
    std::size_t points;
  };
  int step;
  double time;  ///< [s]
  std::vector<Attribute> attributes;
  std::vector<Curve> curves;
};

/// Of the mesh in run.h5.
struct XdmfMesh
{
  std::size_t nodes, tets;
  int nodes_per_tet;
};

/// Place of a field file below the result folder.
std::string step_file(int step);

/// The text of run.xdmf: a collection over time of the tissue, and one of every curve. (Collections
/// at every time instead would do as well, but ParaView's reader then names their blocks anew.)
std::string xdmf_text(const XdmfMesh& mesh, const std::vector<XdmfFrame>& frames);

}  // namespace trocar::io
