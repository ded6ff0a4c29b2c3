#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <render/srgb.hpp>
#include <sloper/base/error.hpp>
#include <sloper/io/json.hpp>
#include <sloper/render/export.hpp>
#include <sloper/render/maps.hpp>
#include <sloper/render/pattern_view.hpp>
#include <sloper/render/show.hpp>
#include <support/sheet.hpp>

#include <cmath>
#include <cstring>
#include <sstream>

using namespace sloper;
using namespace sloper::render;
using sloper::support::flat;
using sloper::support::make_sheet;

namespace {

Scene scene_of(std::vector<garment::Garment> garments) {
  Scene scene;
  for (garment::Garment& g : garments) {
    scene.garment_mesh.push_back(std::ssize(scene.meshes));
    scene.meshes.push_back(cloth_mesh(g));
    scene.garments.push_back(std::move(g));
  }
  return scene;
}

} // namespace

TEST(Maps, strain_along_warp_weft_and_bias_is_that_of_a_homogeneous_stretch) {
  const auto stretched = [](const Vec2& p) { return Vec3(1.10 * p.x(), 1.04 * p.y(), 0); };
  const double bias = std::sqrt(0.5 * (1.10 * 1.10 + 1.04 * 1.04)) - 1;
  for (const auto& [map, expected] : {std::pair{Map::WARP, 4.0},
                                      {Map::WEFT, 10.0},
                                      {Map::BIAS, 100 * bias},
                                      {Map::STRAIN, 10.0}}) {
    Scene scene = scene_of({make_sheet(4, stretched)});
    const Legend legend = apply_map(scene, map);
    EXPECT_TRUE(legend.diverging);
    EXPECT_EQ(legend.steps.size(), 8u);
    for (double v : scene.meshes[0].values)
      EXPECT_NEAR(v, expected, 1e-9);
  }
}

TEST(Maps, strain_is_compared_with_the_limit_of_its_own_fabric) {
  const auto stretched = [](const Vec2& p) { return Vec3(1.02 * p.x(), 1.01 * p.y(), 0); };
  garment::Garment soft = make_sheet(4, stretched), stiff = make_sheet(4, stretched);
  soft.materials[""].stretch_weft_n_m = 98.0665; // doubles its length under 100 gf/cm
  stiff.materials[""].stretch_weft_n_m = 4903.325;
  stiff.materials[""].stretch_warp_n_m = 980.665;
  soft.materials[""].stretch_warp_n_m = 1;
  Scene scene = scene_of({soft, stiff});
  const Legend legend = apply_map(scene, Map::LIMIT);
  EXPECT_FALSE(legend.diverging);
  for (double v : scene.meshes[0].values)
    EXPECT_NEAR(v, 2, 1e-9);
  for (double v : scene.meshes[1].values)
    EXPECT_NEAR(v, 100, 1e-9);
}

TEST(Maps, edited_rest_lengths_count_in_strain) {
  garment::Garment g = make_sheet(3, flat);
  g.rest_scale.assign(g.panels.triangles.size(), {2, 2, 2});
  Scene scene = scene_of({g});
  apply_map(scene, Map::WARP);
  for (double v : scene.meshes[0].values)
    EXPECT_NEAR(v, -50, 1e-9);
}

TEST(Maps, two_drapes_of_different_meshes_differ_by_how_far_one_was_moved) {
  const auto moved = [](const Vec2& p) { return Vec3(flat(p) + Vec3(0, 0, 0.007)); };
  for (double d : drape_difference(make_sheet(5, flat), make_sheet(5, moved)))
    EXPECT_NEAR(d, 0.007, 1e-12);
  for (double d : drape_difference(make_sheet(7, flat), make_sheet(4, moved)))
    EXPECT_NEAR(d, 0.007, 1e-12);
  garment::Garment other = make_sheet(4, flat);
  other.panels.panels[0].name = "sleeve";
  EXPECT_THROW(drape_difference(make_sheet(4, flat), other), Error);
}

TEST(Maps, gap_and_penetration_are_signed_distances_to_the_skin) {
  Scene scene = scene_of(
      {make_sheet(4, [](const Vec2& p) { return Vec3(p.x() - 0.15, p.y() - 0.15, 0.02); })});
  body::Body body; // a large box whose front face is z = 0
  for (int k = 0; k < 8; ++k)
    body.skin.positions.emplace_back(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 0 : -1);
  body.skin.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                         {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  body.face_part.assign(12, body::Part::TORSO);
  scene.body = body;
  apply_map(scene, Map::GAP);
  for (double v : scene.meshes[0].values)
    EXPECT_NEAR(v, 20, 1e-9);
  for (Vec3& p : scene.garments[0].position)
    p.z() = -0.003;
  const Legend legend = apply_map(scene, Map::PENETRATION);
  for (double v : scene.meshes[0].values)
    EXPECT_NEAR(v, 3, 1e-9);
  EXPECT_EQ(legend.high, 4);
}

TEST(Maps, what_lies_beyond_the_scale_or_has_no_value_is_counted) {
  Scene scene = scene_of({make_sheet(
      4, [](const Vec2& p) { return Vec3(p.x() * (p.x() < 0.16 ? 1.02 : 1.06), p.y(), 0); })});
  Legend legend = apply_map(scene, Map::WEFT, 4);
  EXPECT_GT(legend.beyond, 0.2);
  EXPECT_LT(legend.beyond, 0.8);
  EXPECT_EQ(legend.below, 0);
  EXPECT_FALSE(legend.has_gaps);
  // One triangle in a corner, whose vertices' means stay within the scale: the bar says what the
  // quantiles say.
  scene = scene_of({make_sheet(12, [](const Vec2& p) {
    return Vec3(p.x() + (p.x() + p.y() < 0.001 ? -0.0012 : 0), p.y(), 0);
  })});
  legend = apply_map(scene, Map::WEFT, 4);
  const std::vector<double>& drawn = scene.meshes[0].values;
  ASSERT_LE(*std::max_element(drawn.begin(), drawn.end()), 4);
  ASSERT_GT(legend.largest, 4);
  EXPECT_GT(legend.beyond, 0);
  EXPECT_LT(legend.beyond, 0.02);
  scene = scene_of({make_sheet(4, flat)});
  scene.garments[0].panels.triangles.resize(8); // vertices that no triangle names have no strain
  scene.garments[0].panels.panels[0].n_triangles = 8;
  legend = apply_map(scene, Map::WEFT, 4);
  EXPECT_TRUE(legend.has_gaps);
  EXPECT_EQ(legend.beyond, 0);
}

// Between a vertex with a high value and one without any, the colours of all lower values had been
// drawn.
TEST(Maps, cloth_without_a_value_has_a_border_of_two_colours) {
  Scene scene = scene_of({make_sheet(8, flat)});
  Legend legend = apply_map(scene, Map::STRAIN, 1);
  std::vector<double>& values = scene.meshes[0].values;
  for (std::size_t v = 0; v < values.size(); ++v)
    values[v] = scene.garments[0].panels.pattern[v].x() < 0.15 ? 0.9 : NO_VALUE;
  DrawOptions options;
  options.width = options.height = 200;
  options.map_colors = legend.steps;
  options.map_low = legend.low;
  options.map_high = legend.high;
  options.border_lines = false;
  const io::Image image = draw_pattern(scene, options);
  const auto srgb = [](double linear) { return 255 * to_srgb(linear); };
  const Vec3 high = legend.steps.back().unaryExpr(srgb), none = no_value_color().unaryExpr(srgb);
  int highs = 0, nones = 0, strange = 0;
  for (int y = 130; y < 140; ++y) // below the name
    for (int x = 30; x < 140; ++x) {
      const std::uint8_t* p = image.at(x, y);
      const Vec3 c(p[0], p[1], p[2]);
      const double t = std::clamp((c - none).dot(high - none) / (high - none).squaredNorm(), 0.0,
                                  1.0); // mixed where the two meet in a pixel
      highs += (c - high).norm() < 6;
      nones += (c - none).norm() < 6;
      strange += (c - none - t * (high - none)).norm() > 30 && c.minCoeff() < 235;
    }
  EXPECT_GT(highs, 100);
  EXPECT_GT(nones, 100);
  EXPECT_EQ(strange, 0);
}

TEST(PatternView, a_seam_that_goes_over_two_panels_is_drawn_on_each_and_not_between_them) {
  garment::Garment three;
  for (int k = 0; k < 3; ++k) {
    const garment::Garment one = make_sheet(6, flat);
    pattern::PanelInfo info = one.panels.panels[0];
    info.first_vertex = static_cast<int>(three.position.size());
    info.first_triangle = static_cast<int>(three.panels.triangles.size());
    for (const Triangle& t : one.panels.triangles)
      three.panels.triangles.push_back(
          {t[0] + info.first_vertex, t[1] + info.first_vertex, t[2] + info.first_vertex});
    for (int i : one.particle_of)
      three.particle_of.push_back(i + info.first_vertex);
    three.panels.panels.push_back(info);
    three.panels.pattern.insert(three.panels.pattern.end(), one.panels.pattern.begin(),
                                one.panels.pattern.end());
    three.panels.ids.insert(three.panels.ids.end(), one.panels.ids.begin(), one.panels.ids.end());
    three.position.insert(three.position.end(), one.position.begin(), one.position.end());
  }
  three.panels.placed = three.position;
  DrawOptions options;
  options.width = 900;
  options.height = 300;
  const io::Image without = draw_pattern(scene_of({three}), options);
  pattern::MeshSeam seam; // all of the first panel's left edge, and halves of the others', which
                          // lie beside each other on the sheet
  for (int r = 0; r <= 6; ++r) {
    seam.a.push_back(7 * r);
    seam.b.push_back(7 * r + (r <= 3 ? 49 : 98));
  }
  three.panels.seams = {seam};
  const io::Image with = draw_pattern(scene_of({three}), options);
  const auto same = [](const std::uint8_t* a, const std::uint8_t* b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
  };
  int gaps = 0, drawn = 0, crossed = 0;
  for (int x = 0; x < with.width; ++x) {
    bool empty = true, changed = false;
    for (int y = 0; y < 250; ++y) { // above the scale's bar
      empty = empty && same(without.at(x, y), without.at(0, 0));
      changed = changed || !same(without.at(x, y), with.at(x, y));
    }
    gaps += empty;
    drawn += changed;
    crossed += empty && changed;
  }
  EXPECT_LT(crossed, 15) << "the width of the lines beside the panels";
  EXPECT_GT(gaps, 30);
  EXPECT_GT(drawn, 10);
}

TEST(Maps, what_a_map_needs_is_named) {
  Scene scene = scene_of({make_sheet(2, flat)});
  EXPECT_THROW(apply_map(scene, Map::GAP), Error);
  EXPECT_THROW(apply_map(scene, Map::PARTS), Error);
  EXPECT_THROW(apply_map(scene, Map::DIFFERENCE), Error);
  Scene empty;
  EXPECT_THROW(apply_map(empty, Map::STRAIN), Error);
}

TEST(Maps, the_values_table_has_a_row_for_each_vertex_and_no_number_is_lost) {
  Scene scene =
      scene_of({make_sheet(2, [](const Vec2& p) { return Vec3(1.05 * p.x(), p.y(), 0); })});
  scene.garments[0].panels.panels[0].name = "a,b";
  const Legend legend = apply_map(scene, Map::WEFT);
  std::istringstream text(values_csv(scene, legend));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "document,panel,s,t,x_m,y_m,z_m,strain_percent");
  int rows = 0;
  while (std::getline(text, line)) {
    EXPECT_EQ(line.rfind("1,\"a,b\",", 0), 0u) << line;
    EXPECT_NEAR(std::stod(line.substr(line.rfind(',') + 1)), 5, 1e-9);
    ++rows;
  }
  EXPECT_EQ(rows, 9);
}

TEST(Maps, the_values_ply_holds_the_value_of_each_vertex) {
  Scene scene =
      scene_of({make_sheet(2, [](const Vec2& p) { return Vec3(1.05 * p.x(), p.y(), 0); })});
  const Legend legend = apply_map(scene, Map::WEFT);
  const std::string bytes = values_ply(scene, legend);
  const std::size_t data = bytes.find("end_header\n") + 11;
  EXPECT_NE(bytes.find("element vertex 9\n"), std::string::npos);
  EXPECT_NE(bytes.find("value is strain, weft, %"), std::string::npos);
  for (std::size_t v = 0; v < 9; ++v) {
    float value = 0;
    std::memcpy(&value, bytes.data() + data + v * 31 + 27, sizeof value);
    EXPECT_NEAR(value, 5, 1e-4);
  }
}

TEST(PatternView, panels_do_not_overlap_and_none_is_turned) {
  const std::vector<Vec2> sizes{{0.3, 0.7}, {0.3, 0.7}, {0.5, 0.2}, {0.1, 0.1}, {0.9, 0.05}};
  const auto corners = pack_panels(sizes, 0.03, 0.8);
  for (std::size_t a = 0; a < sizes.size(); ++a)
    for (std::size_t b = a + 1; b < sizes.size(); ++b) {
      const Vec2 apart =
          (corners[a] - corners[b] - sizes[b]).cwiseMax(corners[b] - corners[a] - sizes[a]);
      EXPECT_GE(apart.maxCoeff(), 0.03 - 1e-12) << a << " and " << b;
    }
}

TEST(Scene, fabrics_have_colours_of_their_own_once_each_unless_told_otherwise) {
  const auto color_of = [](const std::vector<std::string>& materials, const std::vector<int>& given,
                           std::size_t garment) {
    std::vector<garment::Garment> garments;
    for (const std::string& name : materials) {
      garments.push_back(make_sheet(1, flat));
      garments.back().panels.panels[0].material = name;
    }
    Scene scene = scene_of(std::move(garments));
    color_cloth(scene, ClothColors::GARMENTS, given);
    return scene.meshes[garment].colors[0];
  };
  const Vec3 denim = color_of({"denim"}, {}, 0);
  EXPECT_NE(denim, color_of({"silk"}, {}, 0));
  EXPECT_NE(denim, color_of({""}, {}, 0));
  EXPECT_EQ(color_of({"of a scene"}, {}, 0), color_of({""}, {}, 0));
  EXPECT_EQ(color_of({"silk", "denim"}, {}, 1), denim);
  EXPECT_NE(color_of({"denim", "denim"}, {}, 1), denim); // two garments are told apart
  EXPECT_EQ(color_of({"denim"}, {0x102030}, 0), linear_color(0x102030));
}

TEST(Export, a_glb_is_whole_and_describes_what_it_holds) {
  Scene scene = scene_of({make_sheet(3, flat)});
  scene.meshes[0].name = "sheet";
  color_cloth(scene, ClothColors::PANELS);
  const std::string bytes = glb_bytes(scene.meshes, {});
  ASSERT_EQ(bytes.compare(0, 4, "glTF"), 0);
  std::uint32_t total = 0, json = 0;
  std::memcpy(&total, bytes.data() + 8, 4);
  std::memcpy(&json, bytes.data() + 12, 4);
  EXPECT_EQ(total, bytes.size());
  const auto document = nlohmann::json::parse(bytes.substr(20, json));
  EXPECT_EQ(document["meshes"].size(), 1u);
  EXPECT_EQ(document["accessors"][0]["count"], 16);
  EXPECT_EQ(document["buffers"][0]["byteLength"].get<std::size_t>() + 28 + json, bytes.size());
  EXPECT_EQ(bytes, glb_bytes(scene.meshes, {}));
}

TEST(Show, a_level_cut_of_a_box_is_as_long_as_its_girth) {
  TriangleMesh box;
  for (int k = 0; k < 8; ++k)
    box.positions.emplace_back(k & 1 ? 0.2 : 0, k & 2 ? 1 : 0, k & 4 ? 0.1 : 0);
  box.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  double length = 0;
  for (const auto& [a, b] : cut_level(box, 0.37, {}))
    length += (b - a).norm();
  EXPECT_NEAR(length, 0.6, 1e-12);
  EXPECT_THROW(parse_show("landmark"), Error);
}
