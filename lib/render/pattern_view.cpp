#include <base/error.hpp>
#include <render/overlay.hpp>
#include <render/pattern_view.hpp>
#include <render/show.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace sloper::render {

namespace {

constexpr double GAP = 0.06; // m between panels: room for the names

struct Sheet {
  DrawMesh mesh;
  struct Panel {
    const garment::Garment* garment;
    const pattern::PanelInfo* info;
    int first;      ///< of its vertices in the mesh
    Vec2 low, high; ///< m
  };
  std::vector<Panel> panels;
};

Sheet lay_out(const Scene& scene, double width_over_height) {
  Sheet sheet;
  sheet.mesh.is_cloth = sheet.mesh.is_flat = true;
  std::vector<Vec2> sizes;
  for (std::size_t g = 0; g < scene.garments.size(); ++g) {
    const garment::Garment& garment = scene.garments[g];
    const DrawMesh& cloth = scene.meshes[scene.garment_mesh[g]];
    const int base = static_cast<int>(sheet.mesh.uv.size());
    for (std::size_t v = 0; v < cloth.uv.size(); ++v) {
      sheet.mesh.uv.push_back(cloth.uv[v]);
      const Vec3 c = panel_color(cloth.panel_of[v]);
      sheet.mesh.colors.push_back(Vec3(0.35 * c + Vec3::Constant(0.55)));
      sheet.mesh.normals.push_back(Vec3(0, 0, 1));
      sheet.mesh.values.push_back(v < cloth.values.size() ? cloth.values[v] : NO_VALUE);
    }
    for (const Triangle& t : cloth.triangles) sheet.mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
    for (const auto& [a, b] : cloth.lines) sheet.mesh.lines.push_back({base + a, base + b});
    for (const pattern::PanelInfo& info : garment.panels.panels) {
      if (info.n_vertices == 0) continue;
      Sheet::Panel panel{&garment, &info, base + info.first_vertex, Vec2::Constant(1e9), Vec2::Constant(-1e9)};
      for (int v = panel.first; v < panel.first + info.n_vertices; ++v) {
        panel.low = panel.low.cwiseMin(sheet.mesh.uv[v]);
        panel.high = panel.high.cwiseMax(sheet.mesh.uv[v]);
      }
      sizes.push_back(panel.high - panel.low);
      sheet.panels.push_back(panel);
    }
  }
  const std::vector<Vec2> corners = pack_panels(sizes, GAP, width_over_height);
  sheet.mesh.positions.resize(sheet.mesh.uv.size(), Vec3::Zero());
  for (std::size_t p = 0; p < sheet.panels.size(); ++p) {
    Sheet::Panel& panel = sheet.panels[p];
    const Vec2 shift = corners[p] - panel.low;
    for (int v = panel.first; v < panel.first + panel.info->n_vertices; ++v) sheet.mesh.positions[v].head<2>() = sheet.mesh.uv[v] + shift;
    panel.low += shift;
    panel.high += shift;
  }
  return sheet;
}

/// A place inside the panel far from its border: where its name is written.
Vec3 middle_of(const Sheet& sheet, const Sheet::Panel& panel) {
  const auto& p = sheet.mesh.positions;
  Vec3 mean = Vec3::Zero(), best = Vec3::Zero();
  for (int v = panel.first; v < panel.first + panel.info->n_vertices; ++v) mean += p[v] / panel.info->n_vertices;
  double nearest = 1e9;
  for (int v = panel.first; v < panel.first + panel.info->n_vertices; ++v)
    if ((p[v] - mean).norm() < nearest) {
      nearest = (p[v] - mean).norm();
      best = p[v];
    }
  return best;
}

void draw_seams(io::Image& image, const Sheet& sheet, const Camera& camera, double unit) {
  const garment::Garment* done = nullptr;
  for (const Sheet::Panel& panel : sheet.panels) {
    if (panel.garment == done) continue;
    done = panel.garment;
    const int base = panel.first - panel.info->first_vertex;
    const auto& seams = panel.garment->panels.seams;
    for (std::size_t s = 0; s < seams.size(); ++s)
      for (const std::vector<int>* run : {&seams[s].a, &seams[s].b})
        for (std::size_t k = 0; k + 1 < run->size(); ++k) {
          const Vec3 a = camera.pixel(sheet.mesh.positions[base + (*run)[k]], image.width, image.height);
          const Vec3 b = camera.pixel(sheet.mesh.positions[base + (*run)[k + 1]], image.width, image.height);
          draw_line(image, a.x(), a.y(), b.x(), b.y(), 3 * unit, seam_color(static_cast<int>(s)));
        }
  }
}

/// The number of each seam on both its sides, just inside the panel: colours repeat after a dozen. Left out where there is no room.
void number_seams(io::Image& image, const Sheet& sheet, const Camera& camera, int font) {
  const garment::Garment* done = nullptr;
  for (const Sheet::Panel& panel : sheet.panels) {
    if (panel.garment == done) continue;
    done = panel.garment;
    const int base = panel.first - panel.info->first_vertex;
    const auto& seams = panel.garment->panels.seams;
    const auto at = [&](int v) -> Vec2 { return camera.pixel(sheet.mesh.positions[static_cast<std::size_t>(base + v)], image.width, image.height).head<2>(); };
    for (std::size_t s = 0; s < seams.size(); ++s)
      for (const std::vector<int>* run : {&seams[s].a, &seams[s].b}) {
        if (run->size() < 2) continue;
        const std::size_t k = (run->size() - 1) / 2;
        const Vec2 a = at((*run)[k]), b = at((*run)[k + 1]);
        double length = 0;
        for (std::size_t i = 0; i + 1 < run->size(); ++i) length += (at((*run)[i + 1]) - at((*run)[i])).norm();
        if (!((b - a).norm() > 0) || length < 2 * font) continue; // no room in a small picture
        Vec2 aside = Vec2(a.y() - b.y(), b.x() - a.x()).normalized();
        const auto& info = *std::find_if(panel.garment->panels.panels.begin(), panel.garment->panels.panels.end(),
                                         [&](const pattern::PanelInfo& p) { return (*run)[k] >= p.first_vertex && (*run)[k] < p.first_vertex + p.n_vertices; });
        double low = 1e9, high = -1e9;
        for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v) low = std::min(low, at(v).y()), high = std::max(high, at(v).y());
        if (high - low < 1.2 * font) continue;
        // the panel lies on the side of the triangle that the segment belongs to
        for (int f = info.first_triangle; f < info.first_triangle + info.n_triangles; ++f) {
          const Triangle& t = panel.garment->panels.triangles[static_cast<std::size_t>(f)];
          if (std::count(t.begin(), t.end(), (*run)[k]) + std::count(t.begin(), t.end(), (*run)[k + 1]) < 2) continue;
          if (aside.dot((at(t[0]) + at(t[1]) + at(t[2])) / 3 - a) < 0) aside = -aside;
          break;
        }
        const Vec2 middle = 0.5 * (a + b) + 0.75 * font * aside;
        draw_text_halo(image, std::to_string(s + 1), static_cast<int>(std::lround(middle.x())), static_cast<int>(std::lround(middle.y() + 0.36 * font)), font,
                       Align::CENTER, seam_color(static_cast<int>(s)) >> 1 & 0x7f7f7f);
      }
  }
}

} // namespace

std::vector<Vec2> pack_panels(const std::vector<Vec2>& sizes, double gap, double width_over_height) {
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return sizes[a].y() > sizes[b].y(); });
  double widest = 0, total = 0;
  for (const Vec2& s : sizes) {
    widest = std::max(widest, s.x());
    total += s.x() + gap;
  }
  auto pack = [&](double width, std::vector<Vec2>& corners) {
    corners.assign(sizes.size(), Vec2::Zero());
    double x = 0, top = 0, row = 0, used = 0;
    for (std::size_t k : order) {
      if (x > 0 && x + sizes[k].x() > width) {
        top -= row + gap;
        x = row = 0;
      }
      corners[k] = {x, top - sizes[k].y()};
      x += sizes[k].x() + gap;
      row = std::max(row, sizes[k].y());
      used = std::max(used, x - gap);
    }
    return Vec2(used, row - top);
  };
  std::vector<Vec2> best, trial;
  double least = 1e300;
  for (int k = 0; k <= 40; ++k) {
    const Vec2 size = pack(widest + (total - widest) * k / 40.0, trial);
    const double height = std::max(size.y(), size.x() / width_over_height); // of the picture that holds them
    if (height < least * 0.999) {
      least = height;
      best = trial;
    }
  }
  return best;
}

io::Image draw_pattern(const Scene& scene, const DrawOptions& options) {
  if (scene.garments.empty())
    throw Error(ErrorKind::USAGE, "", "--view pattern", "needs a garment, panels or a pattern", "give panels.json, shirt.json or the pattern's file");
  DrawOptions flat = options;
  flat.occlusion_directions = 0;
  flat.ground = false;
  const bool mapped = !options.map_colors.empty();
  const double share = mapped ? 0.82 : 1; // of the width: the colour bar stands beside
  const double aspect = static_cast<double>(options.width) / options.height;
  const double unit = std::max(1.0, options.height / 1000.0);
  const int font = std::max(9, static_cast<int>(std::lround(13 * unit)));
  const double name = 1.5 * font / options.height, bar_below = (12 * unit + 0.8 * font) / options.height; // of the height, kept free
  std::vector<DrawMesh> meshes;
  const Sheet sheet = lay_out(scene, aspect * share / (1 - name - bar_below));
  meshes.push_back(sheet.mesh);
  CameraOptions view;
  view.field_of_view = 0;
  Camera camera = frame_scene(meshes, view, aspect * share / (1 - name - bar_below));
  camera.half_height /= 1 - name - bar_below;
  camera.center.y() += (name - bar_below) * camera.half_height;
  camera.half_width = camera.half_height * aspect;
  camera.center.x() += camera.half_width * (1 - share);
  Renderer renderer(meshes, flat);
  io::Image image = renderer.draw(camera);
  const double pixels_per_m = 0.5 * options.height / camera.half_height;
  draw_seams(image, sheet, camera, unit);
  number_seams(image, sheet, camera, font - 2);
  for (const Sheet::Panel& panel : sheet.panels) {
    const Vec3 at = camera.pixel(middle_of(sheet, panel), options.width, options.height);
    const Vec2 size = panel.high - panel.low;
    const double arrow = std::min(0.28 * size.y() * pixels_per_m, 60 * unit);
    const auto draw_name = mapped ? draw_text_halo : draw_text;
    const int color = mapped ? 0x101010 : 0x404040;
    const bool narrow = size.y() * pixels_per_m < 6 * font; // no room for the name between the numbers of seams
    char text[64];
    std::snprintf(text, sizeof text, "%.1f x %.1f cm", 100 * size.x(), 100 * size.y());
    const Vec3 above = camera.pixel(Vec3(0.5 * (panel.low.x() + panel.high.x()), panel.high.y(), 0), options.width, options.height);
    const bool outside = narrow || std::max(text_width(panel.info->name, font), text_width(text, font - 2)) > 0.8 * size.x() * pixels_per_m;
    if (outside) {
      draw_text(image, panel.info->name, static_cast<int>(above.x()), static_cast<int>(above.y() - 0.45 * font), font, Align::CENTER, color);
    } else {
      draw_name(image, panel.info->name, static_cast<int>(at.x()), static_cast<int>(at.y()), font, Align::CENTER, color);
      draw_name(image, text, static_cast<int>(at.x()), static_cast<int>(at.y() + 1.3 * font), font - 2, Align::CENTER, color);
    }
    if (narrow) continue;
    const double base = outside ? at.y() + 0.5 * arrow : at.y() - 1.6 * font; // the grain: warp runs upwards
    if (mapped) draw_line(image, at.x(), base, at.x(), base - arrow, 3 * unit, 0xffffff);
    draw_line(image, at.x(), base, at.x(), base - arrow, 1.2 * unit, color);
    for (double side : {-1.0, 1.0}) draw_line(image, at.x(), base - arrow, at.x() + side * 4 * unit, base - arrow + 7 * unit, 1.2 * unit, color);
  }
  const double bar = 0.1 * pixels_per_m, y = options.height - 12 * unit;
  draw_line(image, 12 * unit, y, 12 * unit + bar, y, 2 * unit, 0x303030);
  draw_text(image, "10 cm", static_cast<int>(16 * unit + bar), static_cast<int>(y + 0.35 * font), font);
  return image;
}

} // namespace sloper::render
