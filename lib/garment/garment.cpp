#include <sloper/base/error.hpp>
#include <sloper/garment/garment.hpp>

#include <cmath>

namespace sloper::garment {

namespace {

template<class Points> void check_finite(const Points& points, const char* what) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite())
      throw input_error("garment.not-finite"_id, "", what + (" " + std::to_string(i)),
                        "is not a finite number");
}

void check_range(const std::vector<int>& indices, std::size_t count, const std::string& what) {
  for (std::size_t i = 0; i < indices.size(); ++i)
    if (indices[i] < 0 || static_cast<std::size_t>(indices[i]) >= count)
      throw input_error("garment.damaged"_id, "", what + " " + std::to_string(i),
                        "index " + std::to_string(indices[i]) + " is out of range: there are " +
                            std::to_string(count));
}

void check_count(std::size_t has, std::size_t wants, const char* what) {
  if (has != wants)
    throw input_error("garment.damaged"_id, "", what,
                      "there are " + std::to_string(has) + " for " + std::to_string(wants));
}

} // namespace

void check_garment(const Garment& garment) {
  const pattern::PanelMesh& panels = garment.panels;
  const std::size_t n = panels.pattern.size();
  check_finite(panels.pattern, "pattern point");
  for (std::size_t f = 0; f < panels.triangles.size(); ++f)
    for (const int v : panels.triangles[f])
      if (v < 0 || static_cast<std::size_t>(v) >= n)
        throw input_error("garment.damaged"_id, "", "triangle " + std::to_string(f),
                          "vertex index " + std::to_string(v) + " is out of range: there are " +
                              std::to_string(n));
  for (const pattern::MeshSeam& seam : panels.seams) {
    check_range(seam.a, n, "seam " + seam.name + ", stitch");
    check_range(seam.b, n, "seam " + seam.name + ", stitch");
  }
  if (garment.particle_of.empty()) { // unsewn
    check_count(panels.placed.size(), n, "placed points");
    check_finite(panels.placed, "placed point");
  } else {
    check_count(garment.particle_of.size(), n, "particles of points");
    check_range(garment.particle_of, garment.position.size(), "particle of point");
    check_finite(garment.position, "particle");
  }
  if (garment.rest_scale.empty())
    return;
  check_count(garment.rest_scale.size(), panels.triangles.size(), "rest length factors");
  for (std::size_t f = 0; f < garment.rest_scale.size(); ++f)
    for (const double scale : garment.rest_scale[f])
      if (!(std::isfinite(scale) && scale > 0))
        throw input_error("garment.damaged"_id, "", "triangle " + std::to_string(f),
                          "its rest length factor is not a positive number");
}

std::vector<Triangle> Garment::particle_triangles() const {
  if (particle_of.empty())
    return panels.triangles; // unsewn: every vertex is its own particle
  std::vector<Triangle> triangles;
  triangles.reserve(panels.triangles.size());
  for (const Triangle& t : panels.triangles)
    triangles.push_back({particle_of[t[0]], particle_of[t[1]], particle_of[t[2]]});
  return triangles;
}

} // namespace sloper::garment
