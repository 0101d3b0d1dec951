#include "driver/contact_options.hpp"

#include <map>
#include <set>
#include <sstream>

#include "core/words.hpp"
#include "driver/option_kinds.hpp"
#include "driver/option_source.hpp"
#include "io/stl.hpp"

namespace trocar::driver {

void add_contact_options(std::vector<OptionSpec>& t)
{
  t.push_back(list("contact_pairs",
                   "surfaces that may touch: NAME:SLAVE:MASTER,… (SLAVE: a surface, better the "
                   "finer; MASTER: a surface or an obstacle)"));
  with_override(t, not_negative("contact_friction", "0", "1", "Coulomb's coefficient of contact"),
                "<pair>");
  with_override(t,
                not_negative("contact_shear_limit", "0", "Pa",
                             "largest shear stress of contact with friction; 0 = none"),
                "<pair>");
  with_override(t,
                not_negative("contact_search", "0", "m",
                             "farthest distance that is looked at; 0 = a mean edge of the slave"),
                "<pair>");
  with_override(
      t,
      choice("contact_initial", "closed", {"closed", "keep"},
             "overlap at the start: a closed gap without force, or kept and pushed apart"),
      "<pair>");
  t.push_back(list("obstacles", "rigid bodies that tissue may touch"));
  t.push_back(choice("obstacle_<obstacle>_shape", "plane",
                     {"plane", "sphere", "cylinder", "surface"},
                     "half space, ball, long cylinder, or what the surface of a file encloses"));
  t.push_back(vector("obstacle_<obstacle>_origin", "0,0,0", "m",
                     "a point of the plane or of the cylinder's axis, the ball's middle; where the "
                     "origin of a file is put"));
  t.push_back(vector("obstacle_<obstacle>_normal", "0,0,1", "1",
                     "out of the half space; along the cylinder's axis"));
  t.push_back(not_negative("obstacle_<obstacle>_radius", "0", "m", "of ball and cylinder"));
  t.push_back(file("obstacle_<obstacle>_file", "STL file of a closed surface, text or binary"));
  t.push_back(positive("obstacle_<obstacle>_scale", "1", "m", "length of the file's unit"));
  t.push_back(file("obstacle_<obstacle>_curve",
                   "CSV (columns time,x,y,z): its displacement over time [m]"));
}

namespace {

using core::Options;

/// The displacement of an obstacle over time; nothing without a file.
std::optional<core::Csv> read_path(const std::string& file, const base::Comm& comm)
{
  if (file.empty()) return std::nullopt;
  core::Csv path = read_csv(file, comm);
  core::require_time_column(path);
  if (path.columns != std::vector<std::string>{"time", "x", "y", "z"})
    throw core::data_error(file + ": columns must be time,x,y,z");
  return path;
}

/// The surface of a file, in metres. Every rank reads the same text.
std::shared_ptr<const mesh::Skin> read_skin(const std::string& file, double scale,
                                            const base::Comm& comm)
{
  std::vector<mesh::Triangle> triangles = io::parse_stl(read_bytes(file, comm), file);
  for (mesh::Triangle& triangle : triangles)
    for (core::Vec3& x : triangle) x *= scale;
  return std::make_shared<const mesh::Skin>(mesh::skin_of(triangles, file));
}

contact::Obstacle read_obstacle(Options& options, const std::string& name, const base::Comm& comm)
{
  using Shape = contact::Obstacle::Shape;
  const std::map<std::string, Shape> shapes{{"plane", Shape::plane},
                                            {"sphere", Shape::sphere},
                                            {"cylinder", Shape::cylinder},
                                            {"surface", Shape::surface}};
  const std::string at = "obstacle_<obstacle>_";
  const auto bad = [&](const std::string& option, const std::string& why) {
    return core::option_error("option -obstacle_" + name + "_" + option + ": " + why);
  };
  contact::Obstacle obstacle{name,
                             shapes.at(options.text(at + "shape", name)),
                             options.vector(at + "origin", name),
                             options.vector(at + "normal", name),
                             options.real(at + "radius", name),
                             read_path(options.text(at + "curve", name), comm)};
  const std::string file = options.text(at + "file", name);
  const double scale = options.real(at + "scale", name);
  if (obstacle.shape == Shape::surface) {
    if (file.empty()) throw bad("file", "a surface needs an STL file");
    for (const char* one : {"radius", "normal"})
      if (options.given_for(at + one, name)) throw bad(one, "a surface of a file has none");
    obstacle.skin = read_skin(file, scale, comm);
    return obstacle;
  }
  for (const char* one : {"file", "scale"})
    if (options.given_for(at + one, name)) throw bad(one, "is for the shape 'surface'");
  const bool plane = obstacle.shape == Shape::plane;
  if (plane && options.given_for(at + "radius", name)) throw bad("radius", "a plane has none");
  if (!plane && !(obstacle.radius > 0.0)) throw bad("radius", "must be positive");
  if (obstacle.shape == Shape::sphere && options.given_for(at + "normal", name))
    throw bad("normal", "a sphere has none");
  if (!(obstacle.normal.norm() > 0.0)) throw bad("normal", "must not be zero");
  return obstacle;
}

/// The three words of NAME:SLAVE:MASTER.
std::vector<std::string> words_of(const std::string& entry)
{
  std::vector<std::string> words;
  std::istringstream text(entry);
  for (std::string word; std::getline(text, word, ':');) words.push_back(word);
  if (words.size() != 3 || words[1].empty() || words[2].empty())
    throw core::option_error("option -contact_pairs: '" + entry +
                             "' is not of the form NAME:SLAVE:MASTER");
  return words;
}

}  // namespace

contact::Settings read_contact(Options& options, const mesh::Mesh& mesh, const base::Comm& comm)
{
  contact::Settings settings;
  std::set<std::string> used, pairs;
  for (const std::string& name : options.new_names("obstacles"))
    settings.obstacles.push_back(read_obstacle(options, name, comm));
  for (const std::string& entry : options.new_names("contact_pairs")) {
    const std::vector<std::string> words = words_of(entry);
    contact::PairSettings pair{words[0], words[1], words[2]};
    if (!pairs.insert(pair.name).second)
      throw core::option_error("option -contact_pairs: two pairs are named '" + pair.name + "'");
    mesh::surface_group(mesh, pair.slave);  // refuses an unknown one
    pair.friction = options.real("contact_<pair>_friction", pair.name);
    const double shear = options.real("contact_<pair>_shear_limit", pair.name);
    if (shear > 0.0 && pair.friction == 0.0)
      throw core::option_error("option -contact_shear_limit: pair '" + pair.name +
                               "' has no friction to be limited (-contact_friction)");
    if (shear > 0.0) pair.shear_limit = shear;
    pair.search = options.real("contact_<pair>_search", pair.name);
    pair.closed = options.text("contact_<pair>_initial", pair.name) == "closed";
    used.insert(pair.master);
    settings.pairs.push_back(pair);
  }
  for (const char* name :
       {"contact_friction", "contact_shear_limit", "contact_search", "contact_initial"})
    if (settings.pairs.empty() && options.given(name))
      throw core::option_error("option -" + std::string(name) +
                               ": there is no contact (-contact_pairs)");
  for (const contact::Obstacle& obstacle : settings.obstacles)
    for (const mesh::SurfaceGroup& surface : mesh.surfaces)
      if (surface.name == obstacle.name)
        throw core::option_error("option -obstacles: '" + obstacle.name +
                                 "' is the name of a surface of the mesh");
  for (const contact::Obstacle& obstacle : settings.obstacles)
    if (used.count(obstacle.name) == 0)
      throw core::option_error("option -obstacles: '" + obstacle.name +
                               "' is in no pair (-contact_pairs)");
  return settings;
}

}  // namespace trocar::driver
