#include "drape_scene.hpp"

#include <garment/audit.hpp>
#include <garment/drape.hpp>
#include <gtest/gtest.h>
#include <iostream>

using namespace sloper;
using namespace sloper::garment;

struct Loud : Reporter {
  void info(const std::string& s) override {
    if (getenv("SLOPER_LOUD")) std::cerr << s << "\n";
  }
};

TEST(Drape, a_skirt_is_sewn_hangs_at_the_waist_and_comes_to_rest_without_crossing_anything) {
  const body::Body pillar = make_pillar();
  Garment skirt = make_skirt(0.75, 0.5, 0.02);
  Loud loud;
  const DrapeReport report = drape(skirt, &pillar, {}, loud);
  EXPECT_TRUE(report.converged) << report.stop_reason;
  std::cerr << report.steps << " steps " << report.wall_s << " s\n" << report.quality.dump() << report.solver.dump() << "\n";
  for (auto& e : report.effects) std::cerr << e.name << " " << e.wall_s << "\n";
  for (auto& e : report.phases) std::cerr << e.first << " " << e.second << "\n";
  for (auto& e : report.repairs) std::cerr << e << "\n";
  const collision::BodyCollider body(pillar.skin);
  const Audit a = audit(skirt, &body);
  EXPECT_TRUE(a.clean());
  EXPECT_LT(a.strain_p99, 0.05);
  double top = 0;
  for (const Vec3& p : skirt.position) top = std::max(top, p.y());
  EXPECT_GT(top, 0.9);
}
