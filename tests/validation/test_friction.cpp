/// A patch of cloth on a slope: it stays where the slope is less than the friction angle,
/// tan(alpha) = mu, and slides where it is more.
#include "figures.hpp"

#include <cmath>
#include <sloper/body/body.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/materials.hpp>

using namespace sloper;
using namespace sloper::garment;

namespace {

/// A box whose upper face slopes down along +x by `angle`, the middle of that face at the origin.
body::Body make_slope(double angle) {
  body::Body body;
  const int n = 20;
  const double half = 0.6, depth = 0.2;
  const Mat3 turn = Eigen::AngleAxisd(-angle, Vec3::UnitZ()).toRotationMatrix();
  auto& m = body.skin;
  auto add_side = [&](const Vec3& corner, const Vec3& a, const Vec3& b, int na,
                      int nb) { // outward is a x b
    const int first = std::ssize(m.positions);
    for (int i = 0; i <= na; ++i)
      for (int j = 0; j <= nb; ++j)
        m.positions.push_back(turn * (corner + a * i / na + b * j / nb));
    for (int i = 0; i < na; ++i)
      for (int j = 0; j < nb; ++j) {
        const int p = first + i * (nb + 1) + j, q = p + nb + 1;
        m.triangles.push_back({p, q, q + 1});
        m.triangles.push_back({p, q + 1, p + 1});
      }
  };
  const Vec3 x(2 * half, 0, 0), y(0, depth, 0), z(0, 0, 2 * half), low(-half, -depth, -half),
      high(half, 0, half);
  add_side(low + y, z, x, n, n); // top
  add_side(low, x, z, n, n);     // bottom
  add_side(low, z, y, n, 4);
  add_side(high, -y, -z, 4, n);
  add_side(low, y, x, 4, n);
  add_side(high, -x, -y, n, 4);
  body.face_part.assign(m.triangles.size(), body::Part::TORSO);
  return body;
}

/// Whether a patch of 10 cm comes to rest on a slope of `angle`; `moved`: how far it slid until
/// then or until the step limit, m.
bool comes_to_rest(double angle, double mu, double& moved) {
  const body::Body slope = make_slope(angle);
  Garment garment;
  pattern::PanelMesh& p = garment.panels;
  pattern::PanelInfo info;
  info.name = "patch";
  const int n = 5;
  const double side = 0.1;
  const Mat3 turn = Eigen::AngleAxisd(-angle, Vec3::UnitZ()).toRotationMatrix();
  for (int r = 0; r <= n; ++r)
    for (int c = 0; c <= n; ++c) {
      p.pattern.emplace_back(side * c / n, side * r / n);
      p.placed.push_back(turn * Vec3(side * c / n - 0.3, 0.0028, -side * r / n));
      p.ids.push_back({0, static_cast<double>(c) / n, static_cast<double>(r) / n});
    }
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) {
      const int a = r * (n + 1) + c, b = a + 1, d = a + n + 1, e = d + 1;
      p.triangles.push_back({a, b, e});
      p.triangles.push_back({a, e, d});
    }
  info.n_vertices = static_cast<int>(p.pattern.size());
  info.n_triangles = static_cast<int>(p.triangles.size());
  p.panels.push_back(info);
  Material material = material_preset("cotton-poplin");
  material.friction_body = mu;
  garment.materials[""] = material;
  DrapeSettings settings;
  settings.max_steps = 1200;
  settings.settle_force_ratio = 1e-3; // a patch that slides slowly is not at rest
  settings.settle_speed_m_s = 1e-4;
  settings.effects = "auto,-self_contact";
  const DrapeReport report = drape(garment, &slope, settings, silent_reporter());
  moved = 0;
  for (std::size_t i = 0; i < garment.position.size(); ++i)
    moved += (garment.position[i] - p.placed[i]).norm() / static_cast<double>(p.placed.size());
  return report.converged;
}

} // namespace

TEST(Friction, the_angle_at_which_cloth_starts_to_slide_is_atan_mu_within_5_percent) {
  for (double degrees : {10.0, 25.0, 40.0}) {
    const double angle = degrees * M_PI / 180, exact = std::tan(angle);
    double slips = 0.6 * exact, holds = 1.5 * exact;
    double slid = 0, held = 0;
    ASSERT_FALSE(comes_to_rest(angle, slips, slid)) << degrees << " degrees";
    ASSERT_TRUE(comes_to_rest(angle, holds, held)) << degrees << " degrees";
    EXPECT_GT(slid, 0.005);
    EXPECT_LT(held, 0.001);
    while (holds - slips > 0.01 * exact) {
      const double mu = 0.5 * (slips + holds);
      (comes_to_rest(angle, mu, held) ? holds : slips) = mu;
    }
    plot_point("friction", "cloth holds", degrees, holds);
    print_figure("friction at which cloth holds on " + std::to_string(static_cast<int>(degrees)) +
                     " degrees",
                 holds, exact);
    EXPECT_NEAR(holds / exact, 1, 0.05) << degrees << " degrees";
  }
}
