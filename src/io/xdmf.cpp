#include "io/xdmf.hpp"

#include <algorithm>
#include <iomanip>
#include <map>
#include <sstream>

namespace trocar::io {
namespace {

/// An XDMF data item. `what`: the path of a dataset (format HDF) or the numbers themselves (XML).
std::string item(const std::string& shape, const char* type, const char* format,
                 const std::string& what)
{
  return "<DataItem Dimensions=\"" + shape + "\" NumberType=\"" + type +
         "\" Precision=\"8\" Format=\"" + format + "\">" + what + "</DataItem>";
}

std::string attribute(const std::string& name, const char* type, const char* center,
                      const std::string& data)
{
  return "    <Attribute Name=\"" + name + "\" AttributeType=\"" + type + "\" Center=\"" + center +
         "\">" + data + "</Attribute>\n";
}

std::string topology(const std::string& kind, const std::string& data)
{
  return "    <Topology " + kind + ">" + data + "</Topology>\n";
}

std::string geometry(const std::string& points, const std::string& where)
{
  return "    <Geometry GeometryType=\"XYZ\">" + item(points + " 3", "Float", "HDF", where) +
         "</Geometry>\n";
}

std::string tissue_grid(const XdmfMesh& mesh, const XdmfFrame& frame)
{
  const std::string nodes = std::to_string(mesh.nodes), tets = std::to_string(mesh.tets);
  const std::string per_tet = std::to_string(mesh.nodes_per_tet);
  std::string text =
      topology(std::string("TopologyType=\"") +
                   (mesh.nodes_per_tet == 10 ? "Tetrahedron_10" : "Tetrahedron") +
                   "\" NumberOfElements=\"" + tets + "\"",
               item(tets + " " + per_tet, "Int", "HDF", "run.h5:/mesh/tets")) +
      geometry(nodes, "run.h5:/mesh/coordinates") +
      attribute("region", "Scalar", "Cell", item(tets, "Int", "HDF", "run.h5:/mesh/region"));
  for (const XdmfFrame::Attribute& one : frame.attributes) {
    const std::string& rows = one.cell ? tets : nodes;
    const std::string shape = one.columns ? rows + " " + std::to_string(one.columns) : rows;
    text += attribute(one.name.substr(1),
                      one.columns == 0   ? "Scalar"
                      : one.columns == 3 ? "Vector"
                                         : "Matrix",
                      one.cell ? "Cell" : "Node",
                      item(shape, "Float", "HDF", step_file(frame.step) + ":" + one.name));
  }
  return text;
}

std::string curve_grid(const XdmfFrame& frame, const XdmfFrame::Curve& curve)
{
  const std::string points = std::to_string(curve.points);
  const std::string in_file = step_file(frame.step) + ":" + curve.name;
  std::ostringstream order;
  for (std::size_t i = 0; i < curve.points; ++i) order << (i > 0 ? " " : "") << i;
  return topology(
             "TopologyType=\"Polyline\" NodesPerElement=\"" + points + "\" NumberOfElements=\"1\"",
             item(std::string("1 ").append(points), "Int", "XML", order.str())) +
         geometry(points, in_file + "/axis") +
         attribute("radius", "Scalar", "Node", item(points, "Float", "HDF", in_file + "/radius"));
}

/// The grid of one frame in a temporal collection.
std::string grid(const XdmfFrame& frame, const std::string& inside)
{
  std::ostringstream time;
  time << std::setprecision(17) << frame.time;
  return "   <Grid Name=\"step_" + std::to_string(frame.step) + "\">\n    <Time Value=\"" +
         time.str() + "\"/>\n" + inside + "   </Grid>\n";
}

std::string collection(const std::string& name, const std::string& grids)
{
  return "  <Grid Name=\"" + name + "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n" +
         grids + "  </Grid>\n";
}

}  // namespace

std::string step_file(int step)
{
  std::ostringstream name;
  name << "fields/step_" << std::setw(6) << std::setfill('0') << step << ".h5";
  return name.str();
}

std::string xdmf_text(const XdmfMesh& mesh, const std::vector<XdmfFrame>& frames)
{
  std::string tissue;
  std::map<std::string, std::string> curves;
  for (const XdmfFrame& frame : frames) {
    tissue += grid(frame, tissue_grid(mesh, frame));
    for (const XdmfFrame::Curve& curve : frame.curves)
      curves[curve.name] += grid(frame, curve_grid(frame, curve));
  }
  std::string text = collection("tissue", tissue);
  for (const auto& [name, grids] : curves) {
    std::string label = name.substr(1);
    std::replace(label.begin(), label.end(), '/', '_');
    text += collection(label, grids);
  }
  return "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n <Domain>\n" + text +
         " </Domain>\n</Xdmf>\n";
}

}  // namespace trocar::io
