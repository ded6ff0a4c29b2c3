#include <garment/retarget/pattern_mirror.hpp>

#include <sloper/collision/triangle_tree.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr int SAMPLES = 128; // of an outline, evenly spaced
constexpr double ALIKE =
    0.002; // m that outlines of mirror images may differ: drawn by hand, digitised
constexpr double PERIMETER_SHARE = 0.005; // by which their lengths may
constexpr double SAME_PLACE = 0.2; // m, mean distance of mirrored places on the body; twisted cloth
                                   // is nearer than another limb's

/// An outline as evenly spaced points in the pattern and on the body.
struct Ring {
  std::vector<Vec2> flat;
  std::vector<Vec3> body;
};

struct WornOutline {
  std::vector<Vec2> flat;
  std::vector<Vec3> body;
  double perimeter = 0;
  int corner = 0; ///< position of its sharpest corner

  int n() const { return static_cast<int>(flat.size()); }
  /// @param step  +1 along the outline, -1 against it
  Ring walk(int start, int step) const {
    Ring ring;
    int at = start;
    double done = 0; // from the start to `at`
    for (int k = 0; k < SAMPLES; ++k) {
      const double wanted = perimeter * k / SAMPLES;
      for (;;) {
        const int next = (at + step + n()) % n();
        const double side = (flat[next] - flat[at]).norm();
        if (done + side < wanted && next != start) {
          done += side;
          at = next;
          continue;
        }
        const double share = side > 0 ? std::clamp((wanted - done) / side, 0.0, 1.0) : 0;
        ring.flat.push_back(flat[at] + share * (flat[next] - flat[at]));
        ring.body.push_back(body[at] + share * (body[next] - body[at]));
        break;
      }
    }
    return ring;
  }
};

WornOutline outline_of(const pattern::PanelMesh& panels, const pattern::PanelInfo& info,
                       const std::vector<Vec3>& position) {
  WornOutline o;
  for (const int v : info.outline) {
    o.flat.push_back(panels.pattern[v]);
    o.body.push_back(position[v]);
  }
  double sharpest = 2;
  for (int i = 0; i < o.n(); ++i) {
    const Vec2 before = o.flat[i] - o.flat[(i + o.n() - 1) % o.n()],
               after = o.flat[(i + 1) % o.n()] - o.flat[i];
    o.perimeter += after.norm();
    const double cosine = before.normalized().dot(after.normalized());
    if (cosine < sharpest - 1e-9) {
      sharpest = cosine;
      o.corner = i;
    }
  }
  return o;
}

/// The reflection that brings a best on b in the least squares, and the largest distance that is
/// left.
PanelMirror reflection(const std::vector<Vec2>& a, const std::vector<Vec2>& b) {
  Vec2 center_a = Vec2::Zero(), center_b = Vec2::Zero();
  for (std::size_t i = 0; i < a.size(); ++i) {
    center_a += a[i] / SAMPLES;
    center_b += b[i] / SAMPLES;
  }
  Eigen::Matrix2d m = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < a.size(); ++i)
    m += (b[i] - center_b) * (a[i] - center_a).transpose();
  const double angle = std::atan2(m(0, 1) + m(1, 0), m(0, 0) - m(1, 1)), c = std::cos(angle),
               s = std::sin(angle);
  PanelMirror mirror;
  mirror.linear << c, s, s, -c;
  mirror.shift = center_b - mirror.linear * center_a;
  for (std::size_t i = 0; i < a.size(); ++i)
    mirror.largest_difference_m =
        std::max(mirror.largest_difference_m, (mirror.linear * a[i] + mirror.shift - b[i]).norm());
  return mirror;
}

/// The partner's grain lies along or across the mirrored one, or the threads would not be each
/// other's.
bool grain_agrees(const pattern::PanelInfo& from, const pattern::PanelInfo& to,
                  PanelMirror& mirror) {
  const double cosine =
      std::abs((mirror.linear * from.grain.normalized()).dot(to.grain.normalized()));
  mirror.grain_across = cosine < 0.02;
  return mirror.grain_across || cosine > 0.9998;
}

} // namespace

std::vector<PanelMirror> panel_mirrors(const pattern::PanelMesh& panels,
                                       const std::vector<Vec3>& position) {
  const int n = std::ssize(panels.panels);
  std::vector<WornOutline> outlines;
  for (const pattern::PanelInfo& info : panels.panels)
    outlines.push_back(outline_of(panels, info, position));
  struct Pair {
    double apart; ///< mean distance of mirrored places on the body, m
    int p, q;
    PanelMirror mirror;
  };
  std::vector<Pair> pairs;
  for (int p = 0; p < n; ++p) {
    if (outlines[p].n() < 3)
      continue;
    const Ring ring = outlines[p].walk(outlines[p].corner, 1);
    for (int q = p; q < n; ++q) {
      if (outlines[q].n() < 3 ||
          std::abs(outlines[q].perimeter / outlines[p].perimeter - 1) > PERIMETER_SHARE)
        continue;
      Pair best{SAME_PLACE, p, q, {}};
      for (int start = 0; start < outlines[q].n(); ++start) {
        const Ring image = outlines[q].walk(start, -1);
        PanelMirror mirror = reflection(ring.flat, image.flat);
        if (mirror.largest_difference_m > ALIKE ||
            !grain_agrees(panels.panels[p], panels.panels[q], mirror))
          continue;
        double apart = 0;
        for (int k = 0; k < SAMPLES; ++k)
          apart +=
              (Vec3(-ring.body[k].x(), ring.body[k].y(), ring.body[k].z()) - image.body[k]).norm() /
              SAMPLES;
        if (apart < best.apart) {
          best.apart = apart;
          best.mirror = mirror;
          best.mirror.partner = q;
        }
      }
      if (best.mirror.partner >= 0)
        pairs.push_back(best);
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.apart < b.apart; });
  std::vector<PanelMirror> mirrors(n);
  for (const Pair& pair : pairs) {
    if (mirrors[pair.p].partner >= 0 || mirrors[pair.q].partner >= 0)
      continue;
    mirrors[pair.p] = pair.mirror;
    if (pair.p == pair.q)
      continue;
    PanelMirror back = pair.mirror; // a reflection's inverse has its transpose
    back.partner = pair.p;
    back.linear = pair.mirror.linear.transpose();
    back.shift = -(back.linear * pair.mirror.shift);
    mirrors[pair.q] = back;
  }
  return mirrors;
}

Eigen::MatrixX2d seen_from_mirror(const pattern::PanelMesh& panels, const pattern::PanelInfo& panel,
                                  const pattern::PanelInfo& image, const PanelMirror& mirror,
                                  const Eigen::MatrixX2d& values) {
  std::vector<Vec3> flat;
  for (int i = 0; i < panel.n_vertices; ++i) {
    const Vec2& p = panels.pattern[panel.first_vertex + i];
    flat.emplace_back(p.x(), p.y(), 0);
  }
  std::vector<Triangle> triangles;
  for (int f = panel.first_triangle; f < panel.first_triangle + panel.n_triangles; ++f) {
    const Triangle& t = panels.triangles[f];
    triangles.push_back(
        {t[0] - panel.first_vertex, t[1] - panel.first_vertex, t[2] - panel.first_vertex});
  }
  const collision::TriangleTree tree(flat, triangles);
  Eigen::MatrixX2d seen(image.n_vertices, 2);
  for (int i = 0; i < image.n_vertices; ++i) {
    const Vec2 p = mirror.linear * panels.pattern[image.first_vertex + i] + mirror.shift;
    const collision::ClosestPoint at =
        tree.closest_point(Vec3(p.x(), p.y(), 0), std::numeric_limits<double>::infinity());
    seen.row(i).setZero();
    for (int k = 0; k < 3; ++k)
      seen.row(i) += at.barycentric[k] * values.row(triangles[at.triangle][k]);
  }
  return seen;
}

} // namespace sloper::garment
