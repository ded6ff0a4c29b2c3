#include <pattern/read/spec_placement.hpp>
#include <sloper/base/units.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <array>

namespace sloper::pattern {
namespace {

constexpr double ONE_PLANE =
    1e-3; // units of the file between panels, and between their unit normals: placed by nobody
constexpr double ALIKE = 0.99;    // of the gaps of seams: neither order is better
constexpr double SAME = 1 - 1e-9; // both orders are one

enum class CurveStyle { NONE, LIST, TYPED };

/// GarmentCode names the type of a curve; the writers before it list the coordinates of one control
/// point.
CurveStyle curve_style(const io::Node& panels) {
  CurveStyle style = CurveStyle::NONE;
  for (const std::string& name : panels.keys()) {
    const io::Node edges = panels.at(name).at("edges");
    for (std::size_t k = 0; k < edges.size(); ++k) {
      if (!edges.at(k).has("curvature") || edges.at(k).at("curvature").is_null())
        continue;
      if (!edges.at(k).at("curvature").is_array())
        return CurveStyle::TYPED;
      style = CurveStyle::LIST;
    }
  }
  return style;
}

/// Both ends of a panel edge in the world, in units of the file; nothing where the stitch names
/// none, which is an error where the stitch is read.
std::optional<std::array<Vec3, 2>> edge_ends(const io::Node& panels, const io::Node& item,
                                             EulerOrder order) {
  const std::string name = item.at("panel").string();
  const int index = item.at("edge").integer();
  if (!panels.has(name) || index < 0)
    return std::nullopt;
  const io::Node panel = panels.at(name);
  const std::size_t edge = static_cast<std::size_t>(index);
  if (!panel.has("translation") || !panel.has("rotation") || edge >= panel.at("edges").size())
    return std::nullopt;
  const Mat4 placed = spec_placement(panel, 1, order);
  const io::Node ends = panel.at("edges").at(edge).at("endpoints");
  std::array<Vec3, 2> out;
  for (std::size_t k : {0, 1}) {
    const int vertex = ends.at(k).integer();
    if (vertex < 0 || static_cast<std::size_t>(vertex) >= panel.at("vertices").size())
      return std::nullopt;
    const Vec2 p = panel.at("vertices").at(static_cast<std::size_t>(vertex)).vec2();
    out[k] = (placed * Eigen::Vector4d(p.x(), p.y(), 0, 1)).head<3>();
  }
  return out;
}

/// Sum over the seams of how far their ends are apart, in the nearer order, in units of the file.
double seam_gaps(const io::Node& source, EulerOrder order) {
  const io::Node panels = source.at("panels"), stitches = source.at("stitches");
  double sum = 0;
  for (std::size_t k = 0; k < stitches.size(); ++k) {
    const io::Node stitch = stitches.at(k);
    std::vector<std::array<Vec3, 2>> sides;
    for (std::size_t i = 0; i < stitch.size(); ++i) {
      if (stitch.at(i).is_string())
        continue;
      if (const auto ends = edge_ends(panels, stitch.at(i), order))
        sides.push_back(*ends);
    }
    if (sides.size() != 2)
      continue;
    const auto& [a, b] = std::tie(sides[0], sides[1]);
    sum += std::min((a[0] - b[0]).norm() + (a[1] - b[1]).norm(),
                    (a[0] - b[1]).norm() + (a[1] - b[0]).norm());
  }
  return sum;
}

} // namespace

EulerOrder euler_order(const io::Node& source) {
  const CurveStyle style = curve_style(source.at("panels"));
  if (style == CurveStyle::TYPED)
    return EulerOrder::XYZ;
  const EulerOrder usual = style == CurveStyle::LIST ? EulerOrder::ZYX : EulerOrder::XYZ;
  if (!source.has("stitches"))
    return usual;
  const double xyz = seam_gaps(source, EulerOrder::XYZ), zyx = seam_gaps(source, EulerOrder::ZYX);
  if (std::min(xyz, zyx) >= SAME * std::max(xyz, zyx))
    return EulerOrder::XYZ;
  if (std::min(xyz, zyx) > ALIKE * std::max(xyz, zyx))
    return usual;
  return xyz < zyx ? EulerOrder::XYZ : EulerOrder::ZYX;
}

Mat4 spec_placement(const io::Node& panel, double unit, EulerOrder order) {
  const Vec3 t = panel.at("translation").vec3() * unit;
  const Vec3 r = panel.at("rotation").vec3() * (units::PI / 180);
  const Eigen::AngleAxisd x(r.x(), Vec3::UnitX()), y(r.y(), Vec3::UnitY()), z(r.z(), Vec3::UnitZ());
  Mat4 m = Mat4::Identity();
  m.topLeftCorner<3, 3>() =
      order == EulerOrder::XYZ ? (x * y * z).toRotationMatrix() : (z * y * x).toRotationMatrix();
  m.topRightCorner<3, 1>() = t;
  return m;
}

bool tells_placement(const io::Node& panels) {
  const std::vector<std::string> names = panels.keys();
  std::optional<Mat4> first;
  for (const std::string& name : names) {
    const io::Node panel = panels.at(name);
    if (!panel.has("translation") || !panel.has("rotation"))
      return true;
    const Mat4 placed = spec_placement(panel, 1, EulerOrder::XYZ);
    if (!first)
      first = placed;
    const Vec3 normal = first->col(2).head<3>();
    const double off = normal.dot((placed.col(3) - first->col(3)).head<3>());
    if ((placed.col(2).head<3>() - normal).norm() > ONE_PLANE || std::abs(off) > ONE_PLANE)
      return true;
  }
  return names.size() < 2;
}

namespace {

/// m by which the seams of a panel may lead away from it on the mean, across, up and to front or
/// back. Of 1,311 panels of 140 specifications as their makers wrote them the largest were 0.63
/// (godets), 0.21 and 0.45.
constexpr double FAR_OFF[3] = {0.8, 0.3, 0.7};

struct SeamOffset {
  std::size_t a, b; ///< panels
  Vec3 gap;         ///< m, from a's side to b's, at the mean
  double length;    ///< m
};

std::vector<SeamOffset> seam_offsets(const Pattern& pattern) {
  const auto middle = [&](const Run& run) {
    const Panel& panel = pattern.panels[run.panel];
    const Path& path = panel.edge(run.edge).path;
    const Vec2 p = 0.5 * (path.front().p[0] + path.back().p[3]);
    return Vec3((*panel.hint.rigid * Eigen::Vector4d(p.x(), p.y(), 0, 1)).head<3>());
  };
  std::vector<SeamOffset> out;
  for (const Seam& seam : pattern.seams) {
    const Run &a = seam.a[0], &b = seam.b[0];
    if (a.panel != b.panel)
      out.push_back({static_cast<std::size_t>(a.panel), static_cast<std::size_t>(b.panel),
                     middle(b) - middle(a), run_length(pattern, a)});
  }
  return out;
}

/// Of each panel the mean offset to what it is sewn to, m.
std::vector<Vec3> offsets_to_seams(const std::vector<SeamOffset>& offsets, std::size_t n) {
  std::vector<Vec3> sum(n, Vec3::Zero());
  std::vector<double> length(n, 0);
  for (const SeamOffset& o : offsets) {
    sum[o.a] += o.length * o.gap;
    sum[o.b] -= o.length * o.gap;
    length[o.a] += o.length;
    length[o.b] += o.length;
  }
  for (std::size_t k = 0; k < n; ++k)
    if (length[k] > 0)
      sum[k] /= length[k];
  return sum;
}

bool is_far(const Vec3& offset) {
  for (long k = 0; k < 3; ++k)
    if (std::abs(offset[k]) > FAR_OFF[k])
      return true;
  return false;
}

} // namespace

void mend_translation(Pattern& pattern) {
  const std::size_t n = pattern.panels.size();
  if (!std::all_of(pattern.panels.begin(), pattern.panels.end(),
                   [](const Panel& p) { return p.hint.rigid.has_value(); }))
    return;
  const std::vector<SeamOffset> offsets = seam_offsets(pattern);
  const std::vector<Vec3> mean_gap = offsets_to_seams(offsets, n);
  if (std::none_of(mean_gap.begin(), mean_gap.end(), is_far))
    return;
  std::size_t best = n;
  double least = 1e300;
  for (std::size_t k = 0; k < n; ++k) {
    if (!is_far(mean_gap[k]))
      continue;
    std::vector<SeamOffset> moved = offsets;
    for (SeamOffset& o : moved) {
      if (o.a == k)
        o.gap -= mean_gap[k];
      if (o.b == k)
        o.gap += mean_gap[k];
    }
    const std::vector<Vec3> left = offsets_to_seams(moved, n);
    if (std::any_of(left.begin(), left.end(), is_far))
      continue;
    double sum = 0;
    for (const SeamOffset& o : moved)
      sum += o.length * o.gap.norm();
    if (sum < least) {
      least = sum;
      best = k;
    }
  }
  if (best == n)
    return;
  Panel& panel = pattern.panels[best];
  // Front and back start apart, whatever their seams say.
  Vec3 move = mean_gap[best];
  for (long k = 0; k < 3; ++k)
    if (std::abs(move[k]) <= FAR_OFF[k])
      move[k] = 0;
  panel.hint.rigid->topRightCorner<3, 1>() += move;
  pattern.findings.push_back({"pattern.placement-by-seams"_id,
                              panel.name + ": its translation puts it " + centimetres(move.norm()) +
                                  " away from all that it is sewn to; it is placed by its seams"});
}

} // namespace sloper::pattern
