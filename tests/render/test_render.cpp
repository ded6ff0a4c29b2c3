#include <gtest/gtest.h>
#include <sloper/base/error.hpp>
#include <sloper/base/parallel.hpp>
#include <sloper/io/files.hpp>
#include <sloper/render/draw.hpp>
#include <sloper/render/overlay.hpp>

#include <cmath>
#include <cstdlib>
#include <map>

#if defined(__SANITIZE_ADDRESS__) // OpenGL forgets some of what it made, and EGL unloads who did
extern "C" const char* __asan_default_options() {
  return "detect_leaks=0";
}
#endif

using namespace sloper;
using namespace sloper::render;

namespace {

/// A ball of 0.5 m around (0, 1, 0).
DrawMesh make_ball() {
  DrawMesh mesh;
  const int n = 24;
  for (int r = 0; r <= n; ++r)
    for (int c = 0; c < 2 * n; ++c) {
      const double polar = M_PI * r / n, around = M_PI * c / n;
      const Vec3 direction(std::sin(polar) * std::sin(around), std::cos(polar),
                           std::sin(polar) * std::cos(around));
      mesh.positions.push_back(Vec3(0, 1, 0) + 0.5 * direction);
      mesh.normals.push_back(direction);
      mesh.colors.emplace_back(0.5, 0.2, 0.1);
    }
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < 2 * n; ++c) {
      const int a = r * 2 * n + c, b = r * 2 * n + (c + 1) % (2 * n);
      mesh.triangles.push_back({a, a + 2 * n, b});
      mesh.triangles.push_back({b, a + 2 * n, b + 2 * n});
    }
  return mesh;
}

io::Image draw_ball(std::optional<int> background, ContextKind context = built_contexts().front(),
                    const CameraOptions& view = {}) {
  const std::vector<DrawMesh> meshes{make_ball()};
  DrawOptions options;
  options.width = 120;
  options.height = 160;
  options.background = background;
  options.context = context;
  options.ground = false;
  return Renderer(meshes, options).draw(frame_scene(meshes, view, 0.75));
}

} // namespace

TEST(Render, the_whole_scene_is_inside_the_picture_and_fills_it) {
  const io::Image image = draw_ball(std::nullopt);
  int covered = 0, border = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const bool on = image.at(x, y)[3] > 0;
      covered += on;
      border += on && (x == 0 || y == 0 || x == image.width - 1 || y == image.height - 1);
    }
  EXPECT_EQ(border, 0);
  EXPECT_GT(covered, image.width * image.height * 45 / 100);
  EXPECT_EQ(image.at(60, 80)[3], 255);
}

TEST(Render, the_same_scene_gives_the_same_bytes) {
  const auto a = io::png_bytes(draw_ball(0xffffff), {{"Software", "test"}});
  EXPECT_EQ(a, io::png_bytes(draw_ball(0xffffff), {{"Software", "test"}}));
}

TEST(Render, the_number_of_threads_changes_no_byte) {
  const io::Image one = draw_ball(0xffffff);
  set_thread_count(3);
  unsetenv("LP_NUM_THREADS");
  const io::Image three = draw_ball(0xffffff);
  set_thread_count(1);
  unsetenv("LP_NUM_THREADS");
  EXPECT_EQ(one.rgba, three.rgba);
}

TEST(Render, every_built_in_context_draws_the_same_picture) {
  if (built_contexts().size() < 2)
    GTEST_SKIP() << "only one context was built in";
  const io::Image osmesa = draw_ball(0xffffff);
  io::Image egl;
  try {
    egl = draw_ball(0xffffff, ContextKind::EGL);
  } catch (const Error& error) {
    GTEST_SKIP() << error.what();
  }
  const Comparison c = compare(osmesa, egl);
  EXPECT_GT(c.ssim, 0.995);
  EXPECT_LT(c.different, osmesa.width * osmesa.height / 100);
}

TEST(Camera, a_point_goes_where_the_picture_shows_it) {
  CameraOptions options;
  options.target = Vec3(0, 1, 0);
  options.field_height = 2;
  for (double field_of_view : {0.0, 0.3}) {
    options.field_of_view = field_of_view;
    const Camera camera = frame_scene({make_ball()}, options, 0.75);
    EXPECT_LT((camera.pixel(Vec3(0, 1, 0), 300, 400).head<2>() - Vec2(150, 200)).norm(), 1e-9);
    EXPECT_LT((camera.pixel(Vec3(0.5, 1.5, 0), 300, 400).head<2>() - Vec2(250, 100)).norm(), 1e-9);
    const double near = camera.pixel(Vec3(0, 1, 0.5), 300, 400).z(),
                 far = camera.pixel(Vec3(0, 1, -0.5), 300, 400).z();
    EXPECT_GT(near, 0);
    EXPECT_LT(near, far);
    EXPECT_LT(far, 1);
  }
}

TEST(Camera, views_that_share_a_scale_show_all_from_all_sides) {
  std::vector<DrawMesh> meshes{make_ball()};
  for (Vec3& p : meshes[0].positions)
    p.x() *= 4; // arms out
  std::vector<std::optional<CameraOptions>> views = {named_view("front"), named_view("left"),
                                                     std::nullopt, named_view("iso")};
  share_scale(meshes, views, 0.75, 0, 0);
  EXPECT_FALSE(views[2]);
  double widest = 0;
  for (const auto& view : views) {
    if (!view)
      continue;
    const Camera camera = frame_scene(meshes, *view, 0.75);
    EXPECT_NEAR(camera.half_height, frame_scene(meshes, *views[0], 0.75).half_height, 1e-12);
    for (const Vec3& p : meshes[0].positions) {
      const Vec3 at = camera.pixel(p, 300, 400);
      EXPECT_TRUE(at.x() > 0 && at.x() < 300 && at.y() > 0 && at.y() < 400);
      widest = std::max(widest, std::abs(at.x() - 150));
    }
  }
  EXPECT_GT(widest, 120) << "and no smaller than need be";
}

TEST(Camera, a_document_with_an_unknown_key_or_an_absurd_angle_is_refused) {
  const std::string path = std::string(SLOPER_BINARY_DIR) + "/camera.json";
  io::write_file(path, R"({"azimuth_deg": 90, "orthographic": true})");
  EXPECT_NEAR(read_camera(path).azimuth, M_PI / 2, 1e-12);
  EXPECT_EQ(read_camera(path).field_of_view, 0);
  io::write_file(path, R"({"format": "camera", "version": 1, "azimuth_deg": 90})");
  EXPECT_NEAR(read_camera(path).azimuth, M_PI / 2, 1e-12)
      << "a head as other documents have one is no mistake";
  for (const char* bad :
       {R"({"azimut_deg": 90})", R"({"elevation_deg": 90})", R"({"field_of_view_deg": 0})", "[]",
        R"({"format": "scene", "version": 1})", R"({"format": "camera", "version": 2})"}) {
    io::write_file(path, bad);
    EXPECT_THROW(read_camera(path), Error) << bad;
  }
}

TEST(Render, the_far_side_of_a_closed_body_is_left_out_and_never_missed) {
  TriangleMesh pyramid{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                       {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  EXPECT_TRUE(is_closed(pyramid));
  const std::vector<Triangle> outwards = pyramid.triangles;
  for (Triangle& t : pyramid.triangles)
    std::swap(t[0], t[1]);
  EXPECT_FALSE(is_closed(pyramid)) << "inside out";
  pyramid.triangles = outwards;
  pyramid.triangles.pop_back();
  EXPECT_FALSE(is_closed(pyramid)) << "a hole shows the far side";
  pyramid.triangles.push_back(outwards[0]);
  EXPECT_FALSE(is_closed(pyramid)) << "as many triangles, one of them twice";
  std::vector<DrawMesh> meshes{make_ball()};
  DrawOptions options;
  options.width = 120;
  options.height = 160;
  const Camera camera = frame_scene(meshes, named_view("iso"), 0.75);
  const io::Image whole = Renderer(meshes, options).draw(camera);
  meshes[0].is_closed = true;
  const io::Image front = Renderer(meshes, options).draw(camera);
  const Comparison c = compare(whole, front);
  EXPECT_LE(c.largest, 2);
  EXPECT_GT(c.ssim, 0.9999);
}

TEST(Render, a_seam_shows_on_its_cloth_and_not_through_cloth_in_front_of_it) {
  const auto sheet = [](double half, double z, bool has_seam) {
    DrawMesh mesh;
    for (const auto& [x, y] : {std::pair{-1, -1}, {0, -1}, {1, -1}, {-1, 1}, {0, 1}, {1, 1}}) {
      mesh.positions.emplace_back(half * x, half * y, z);
      mesh.normals.emplace_back(0, 0, 1);
      mesh.colors.emplace_back(0.5, 0.2, 0.1);
    }
    mesh.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    mesh.is_flat = true;
    if (has_seam) {
      mesh.lines = {{1, 4}};
      mesh.is_hem = {0};
    }
    return mesh;
  };
  const auto drawn = [](const std::vector<DrawMesh>& meshes) {
    DrawOptions options;
    options.width = options.height = 100;
    options.ground = false;
    return Renderer(meshes, options).draw(frame_scene(meshes, {}, 1)).rgba;
  };
  EXPECT_NE(drawn({sheet(0.5, 0, true)}), drawn({sheet(0.5, 0, false)}));
  for (const double apart : {0.0005, 0.0001})
    EXPECT_EQ(drawn({sheet(0.5, 0, true), sheet(0.6, apart, false)}),
              drawn({sheet(0.5, 0, false), sheet(0.6, apart, false)}))
        << apart;
}

TEST(Render, a_ball_throws_its_shadow_on_the_floor) {
  const std::vector<DrawMesh> meshes{make_ball()};
  DrawOptions options;
  options.width = 120;
  options.height = 160;
  CameraOptions view = named_view("iso");
  view.field_height = 1.6;
  const io::Image image = Renderer(meshes, options).draw(frame_scene(meshes, view, 0.75));
  EXPECT_LT(image.at(60, 136)[0], 225);
  EXPECT_EQ(image.at(3, 3)[0], 255);
}

TEST(Render, light_comes_from_above) {
  const io::Image image = draw_ball(0xffffff);
  EXPECT_GT(image.at(60, 40)[0], image.at(60, 125)[0] + 10);
}

TEST(Png, a_picture_survives_writing_and_reading) {
  const io::Image image = draw_ball(std::nullopt);
  const std::string path = std::string(SLOPER_BINARY_DIR) + "/round-trip.png";
  io::write_png(path, image, {});
  EXPECT_EQ(io::read_png(path).rgba, image.rgba);
  EXPECT_THROW(io::read_png(SLOPER_SOURCE_DIR "/CMakeLists.txt"), Error);
}

TEST(Png, an_animation_has_numbered_frames_and_its_first_picture_is_read_by_others) {
  std::vector<io::Image> images(3);
  for (std::size_t k = 0; k < images.size(); ++k) {
    images[k].width = 5;
    images[k].height = 4;
    images[k].rgba.assign(80, static_cast<std::uint8_t>(100 + k));
  }
  const std::string bytes = io::apng_bytes(images, 0.25, {{"Software", "test"}});
  EXPECT_EQ(bytes, io::apng_bytes(images, 0.25, {{"Software", "test"}}));
  auto u32 = [&](std::size_t at) {
    std::uint32_t x = 0;
    for (std::size_t k = 0; k < 4; ++k)
      x = x << 8 | static_cast<unsigned char>(bytes[at + k]);
    return x;
  };
  std::uint32_t sequence = 0;
  std::map<std::string, int> seen;
  std::string order;
  for (std::size_t at = 8; at + 12 <= bytes.size(); at += 12 + u32(at)) {
    const std::string name = bytes.substr(at + 4, 4);
    ++seen[name];
    order += name + " ";
    if (name == "acTL") {
      EXPECT_EQ(u32(at + 8), 3u);
    }
    if (name == "fcTL" || name == "fdAT") {
      EXPECT_EQ(u32(at + 8), sequence++);
    }
    if (name == "fcTL") {
      EXPECT_EQ(u32(at + 8 + 20), 250u << 16 | 1000u) << "a quarter of a second";
    }
  }
  EXPECT_EQ(seen["fcTL"], 3);
  EXPECT_EQ(seen["IDAT"], 1);
  EXPECT_EQ(seen["fdAT"], 2);
  EXPECT_LT(order.find("acTL"), order.find("IDAT"));
  const std::string path = ::testing::TempDir() + "animation.png";
  io::write_file(path, bytes);
  EXPECT_EQ(io::read_png(path).rgba, images[0].rgba);
}

TEST(Overlay, equal_pictures_compare_equal_and_a_defect_is_seen) {
  const io::Image a = draw_ball(0xffffff);
  EXPECT_EQ(compare(a, a).ssim, 1);
  io::Image b = a;
  for (int y = 60; y < 70; ++y)
    for (int x = 50; x < 60; ++x)
      b.at(x, y)[0] = 0;
  const Comparison c = compare(a, b);
  EXPECT_EQ(c.different, 100);
  EXPECT_LT(c.ssim, 0.999);
  EXPECT_EQ(c.far, 100);
  EXPECT_EQ(c.counted, a.width * a.height);
  io::Image dark = a, bright = a;
  for (std::size_t k = 0; k < dark.rgba.size(); ++k) {
    dark.rgba[k] = k % 4 == 3 ? 255 : 0;
    bright.rgba[k] = 255;
  }
  for (int y = 60; y < 70; ++y)
    for (int x = 50; x < 60; ++x)
      bright.at(x, y)[0] = 0;
  EXPECT_THROW(compare(a, b, &dark), Error) << "nothing would be compared";
  EXPECT_EQ(compare(a, b, &bright).far, 0) << "the defect is outside the mask";
  io::Image other = a;
  other.width /= 2;
  EXPECT_THROW(compare(a, other), Error);
}

TEST(Maps, scales_run_from_dark_to_light_and_from_blue_over_white_to_red) {
  double before = -1;
  for (int k = 0; k <= 20; ++k) {
    const Vec3 c = scale_color(k / 20.0, false);
    const double lightness = 0.2126 * c.x() + 0.7152 * c.y() + 0.0722 * c.z();
    EXPECT_GT(lightness, before);
    before = lightness;
  }
  EXPECT_GT(scale_color(-1, true).z(), scale_color(-1, true).x());
  EXPECT_GT(scale_color(1, true).x(), scale_color(1, true).z());
}

// In a picture of 200 x 250 the last line of a long legend had run off the lower edge.
TEST(Overlay, a_legend_has_room_for_all_its_lines_in_a_small_picture) {
  Legend legend;
  legend.title = "strain";
  legend.unit = "%";
  legend.low = -4;
  legend.high = 4;
  legend.diverging = legend.has_gaps = true;
  legend.below = legend.beyond = 0.1;
  legend.steps.assign(8, Vec3(0.9, 0.1, 0.1));
  io::Image image;
  image.width = 200;
  image.height = 250;
  image.rgba.assign(4 * 200 * 250, 255);
  draw_legend(image, legend);
  int swatch = 0, last = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.at(x, y);
      if (p[0] == 255)
        continue;
      last = y;
      swatch += x < 140 && y > 200 && p[0] == p[1] && p[0] > 120 &&
                p[0] < 150; // of "no value", left of its words
    }
  EXPECT_GT(swatch, 60) << "of 100, less the halo of words";
  EXPECT_LT(last, 248);
}

TEST(Overlay, a_sheet_gives_each_column_the_width_of_its_widest_picture) {
  io::Image wide, narrow;
  wide.width = 60;
  narrow.width = 20;
  wide.height = narrow.height = 40;
  wide.rgba.assign(4 * 60 * 40, 1);
  narrow.rgba.assign(4 * 20 * 40, 2);
  const io::Image sheet = contact_sheet({wide, narrow, narrow, wide}, {}, 2);
  EXPECT_EQ(sheet.width, 120);
  EXPECT_EQ(sheet.height, 80);
  const io::Image row = contact_sheet({wide, narrow}, {}, 2);
  EXPECT_EQ(row.width, 80);
  EXPECT_EQ(row.at(59, 0)[0], 1);
  EXPECT_EQ(row.at(60, 0)[0], 2);
}

TEST(Scene, what_cannot_be_drawn_is_refused_with_a_reason) {
  EXPECT_THROW(read_scene({"no-such-file.json"}), Error);
  const std::string path = std::string(SLOPER_BINARY_DIR) + "/fit.json";
  io::write_file(path, "{\"format\": \"fit\", \"version\": 1}");
  EXPECT_THROW(read_scene({path}), Error);
  Scene scene;
  EXPECT_THROW(apply_map(scene, Map::STRAIN), Error);
}
