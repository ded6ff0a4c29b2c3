/// The drape coefficient of the presets against the literature, and its independence of the mesh
/// (Cusick 1965, BS 5058, ISO 9073-9). Slow ones run with SLOPER_VALIDATION=1 (make validation).
#include "cusick.hpp"
#include "figures.hpp"

#include <sloper/garment/materials.hpp>

using namespace sloper;
using namespace sloper::cloth;

namespace {

Fabric preset(const std::string& name) {
  return garment::material_preset(name);
}

/// Mean of three specimens, as the standard asks: one specimen may settle on another number of
/// folds, 2-3 points away.
double mean_coefficient(const Fabric& fabric, int rings, const char* model) {
  double sum = 0;
  for (std::uint64_t seed : {1, 2, 3})
    sum += drape_cusick(fabric, rings, model, seed).coefficient / 3;
  return sum;
}

#define SLOW_TEST()                      \
  if (!std::getenv("SLOPER_VALIDATION")) \
  GTEST_SKIP() << "slow: run it with make validation"

} // namespace

TEST(Cusick, cotton_s_coefficient_is_that_of_the_literature_and_does_not_hang_on_the_mesh) {
  // 60-76 % for plain cotton, 68.4 % measured by Gan, Ly and Steven 1991. Drapemeters repeat to
  // about 3 points.
  const Cusick coarse = drape_cusick(preset("cotton-poplin"), 5, "springs"),
               fine = drape_cusick(preset("cotton-poplin"), 7, "springs");
  print_figure("drape coefficient of cotton poplin, %, springs, 5 rings", coarse.coefficient, 68.4);
  print_figure("drape coefficient of cotton poplin, %, springs, 7 rings", fine.coefficient, 68.4);
  EXPECT_GT(fine.steps, 0);
  EXPECT_GT(fine.coefficient, 60);
  EXPECT_LT(fine.coefficient, 76);
  EXPECT_NEAR(coarse.coefficient, fine.coefficient, 3);
  EXPECT_GE(fine.nodes, 4); // Cusick counts 4-8 on cotton of this stiffness
  EXPECT_LE(fine.nodes, 10);
}

TEST(Cusick, presets_lie_in_the_bands_of_the_literature) {
  SLOW_TEST();
  // Silk: Matsudaira and Yang 2003. Cotton: Gan, Ly and Steven 1991. Wool and denim: bands of
  // worsted suitings and heavy twills. A limp fabric needs a finer mesh: its folds are about three
  // bending lengths (B / rho g)^(1/3) wide.
  struct Case {
    const char* name;
    int rings;
    double low, high;
  };
  for (const Case& c : {Case{"silk", 14, 20, 40},
                        {"cotton-poplin", 8, 60, 76},
                        {"wool-suiting", 8, 40, 70},
                        {"denim", 8, 70, 90}}) {
    const Cusick d = drape_cusick(preset(c.name), c.rings, "fem");
    print_figure(std::string("drape coefficient, %, fem, ") + c.name + ", nodes " +
                     std::to_string(d.nodes),
                 d.coefficient, 0.5 * (c.low + c.high));
    for (std::size_t i = 0; i <= d.rim.size(); ++i)
      plot_point("cusick-rim", c.name, d.rim[i % d.rim.size()].x(), d.rim[i % d.rim.size()].y());
    plot_point("cusick", c.name, c.low, c.high);
    plot_point("cusick-measured", c.name, d.coefficient, d.nodes);
    EXPECT_GT(d.steps, 0) << c.name;
    EXPECT_GE(d.coefficient, c.low) << c.name;
    EXPECT_LE(d.coefficient, c.high) << c.name;
  }
}

TEST(Cusick, coefficient_hardly_changes_with_the_mesh) {
  SLOW_TEST();
  double low = 100, high = 0;
  for (int rings : {7, 8, 10}) {
    const double dc = mean_coefficient(preset("cotton-poplin"), rings, "fem");
    print_figure("drape coefficient of cotton poplin, %, fem, rings " + std::to_string(rings), dc,
                 68.4);
    low = std::min(low, dc);
    high = std::max(high, dc);
  }
  EXPECT_LT(high - low, 3);
}

TEST(Cusick, the_models_of_stretch_agree_on_cotton_within_6_points) {
  SLOW_TEST();
  // Edge springs bring a shear stiffness of 3/8 Y of their own, so they drape stiffer; see the
  // figures.
  const double fem = drape_cusick(preset("cotton-poplin"), 8, "fem").coefficient;
  for (const char* model : {"springs", "triangles"}) {
    const double dc = drape_cusick(preset("cotton-poplin"), 8, model).coefficient;
    print_figure(std::string("drape coefficient of cotton poplin, %, ") + model + " against fem",
                 dc, fem);
    EXPECT_NEAR(dc, fem, 6) << model;
  }
}

TEST(Cusick, coefficient_rises_with_the_logarithm_of_the_bending_rigidity) {
  SLOW_TEST();
  // The paper's criterion of exactness: the result in linear relation to the parameter. Between the
  // flat ends of 0 and 100 % the drape coefficient is linear in log B.
  std::vector<double> x, y;
  for (double factor : {1.0, 1.5, 2.2, 3.3}) {
    Fabric fabric = preset("wool-suiting");
    fabric.bend_n_m *= factor;
    x.push_back(std::log10(fabric.bend_n_m));
    y.push_back(mean_coefficient(fabric, 8, "fem"));
    print_figure("drape coefficient, %, fem, wool of B times " + std::to_string(factor), y.back(),
                 y.front());
    if (y.size() > 1) {
      EXPECT_GT(y.back(), y[y.size() - 2]) << "factor " << factor;
    }
  }
  double mx = 0, my = 0, sxx = 0, sxy = 0, syy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mx += x[i] / 4;
    my += y[i] / 4;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    sxx += (x[i] - mx) * (x[i] - mx);
    sxy += (x[i] - mx) * (y[i] - my);
    syy += (y[i] - my) * (y[i] - my);
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    plot_point("linear", "wool, mean of three", std::pow(10, x[i]), y[i]);
  const double r2 = sxy * sxy / (sxx * syy);
  print_figure("slope of the drape coefficient, points a decade of B", sxy / sxx, sxy / sxx);
  print_figure("its R2", r2, 1);
  EXPECT_GT(r2,
            0.9); // measured 0.93 and 41 points a decade; what remains is one fold more or fewer
}
