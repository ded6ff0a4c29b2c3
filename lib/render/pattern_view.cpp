#include <sloper/base/error.hpp>
#include <sloper/base/text.hpp>
#include <sloper/pattern/pattern.hpp>
#include <sloper/render/overlay.hpp>
#include <sloper/render/pattern_view.hpp>
#include <sloper/render/show.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace sloper::render {

namespace {

constexpr double GAP = 0.06; // m between panels: room for the names
constexpr int ASKED_EDGE = 0xf2a900, ASKED_NAME = 0x8a1c00, EDGE_NAME = 0x404040;
constexpr double ASKED_WIDTH = 5, CORNER_DOT = 2.5;    // fine lines
constexpr double TEXT_HEIGHT = 0.9, HALF_DIGIT = 0.36; // of the font's size

struct Sheet {
  DrawMesh mesh;
  struct Panel {
    const garment::Garment* garment;
    const pattern::PanelInfo* info;
    int first;                 ///< of its vertices in the mesh
    Vec2 low, high;            ///< m
    Vec2 shift = Vec2::Zero(); ///< m, from coordinates across and along the warp to the sheet
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
    const int base = std::ssize(sheet.mesh.uv);
    for (std::size_t v = 0; v < cloth.uv.size(); ++v) {
      sheet.mesh.uv.push_back(cloth.uv[v]);
      const Vec3 c = panel_color(cloth.panel_of[v]);
      sheet.mesh.colors.push_back(Vec3(0.35 * c + Vec3::Constant(0.55)));
      sheet.mesh.normals.push_back(Vec3(0, 0, 1));
      sheet.mesh.values.push_back(v < cloth.values.size() ? cloth.values[v] : NO_VALUE);
    }
    for (const Triangle& t : cloth.triangles)
      sheet.mesh.triangles.push_back({base + t[0], base + t[1], base + t[2]});
    for (const auto& [a, b] : cloth.lines)
      sheet.mesh.lines.push_back({base + a, base + b});
    for (const pattern::PanelInfo& info : garment.panels.panels) {
      if (info.n_vertices == 0)
        continue;
      Sheet::Panel panel{&garment, &info, base + info.first_vertex, Vec2::Constant(1e9),
                         Vec2::Constant(-1e9)};
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
    for (int v = panel.first; v < panel.first + panel.info->n_vertices; ++v)
      sheet.mesh.positions[v].head<2>() = sheet.mesh.uv[v] + shift;
    panel.shift = shift;
    panel.low += shift;
    panel.high += shift;
  }
  return sheet;
}

/// A place inside the panel far from its border: where its name is written.
Vec3 middle_of(const Sheet& sheet, const Sheet::Panel& panel) {
  const auto& p = sheet.mesh.positions;
  Vec3 mean = Vec3::Zero(), best = Vec3::Zero();
  for (int v = panel.first; v < panel.first + panel.info->n_vertices; ++v)
    mean += p[v] / panel.info->n_vertices;
  double nearest = 1e9;
  for (int v = panel.first; v < panel.first + panel.info->n_vertices; ++v)
    if ((p[v] - mean).norm() < nearest) {
      nearest = (p[v] - mean).norm();
      best = p[v];
    }
  return best;
}

/// What one panel has of one side of a seam, as it lies on the sheet.
struct SeamSide {
  int seam; ///< its place among the garment's
  const pattern::PanelMesh* panels;
  std::vector<int> run; ///< vertices of `panels`, two at least
  std::vector<Vec2> at; ///< pixels, of all vertices of `panels`
};

int panel_of(const pattern::PanelMesh& panels, int vertex) {
  const auto owns = [&](const pattern::PanelInfo& p) {
    return vertex >= p.first_vertex && vertex < p.first_vertex + p.n_vertices;
  };
  return static_cast<int>(std::find_if(panels.panels.begin(), panels.panels.end(), owns) -
                          panels.panels.begin());
}

/// Both sides of every seam, panel by panel, in the garments' order.
template<class Visit>
void for_each_seam_side(const Sheet& sheet, const Camera& camera, const io::Image& image,
                        const Visit& visit) {
  const garment::Garment* done = nullptr;
  for (const Sheet::Panel& panel : sheet.panels) {
    if (panel.garment == done)
      continue;
    done = panel.garment;
    const pattern::PanelMesh& panels = panel.garment->panels;
    SeamSide side{0, &panels, {}, {}};
    const int base = panel.first - panel.info->first_vertex;
    for (std::size_t v = 0; v < panels.pattern.size(); ++v)
      side.at.push_back(camera
                            .pixel(sheet.mesh.positions[static_cast<std::size_t>(base) + v],
                                   image.width, image.height)
                            .head<2>());
    for (const pattern::MeshSeam& seam : panels.seams) {
      for (const std::vector<int>* run : {&seam.a, &seam.b}) {
        for (std::size_t first = 0, end = 0; first < run->size(); first = end) {
          const int panel_index = panel_of(panels, (*run)[first]);
          for (end = first; end < run->size() && panel_of(panels, (*run)[end]) == panel_index;)
            ++end;
          side.run.assign(run->begin() + static_cast<long>(first),
                          run->begin() + static_cast<long>(end));
          if (side.run.size() > 1)
            visit(side);
        }
      }
      ++side.seam;
    }
  }
}

void draw_seam(io::Image& image, const SeamSide& side, double width) {
  for (std::size_t k = 0; k + 1 < side.run.size(); ++k) {
    const Stroke stroke = {.width = width, .color = seam_color(side.seam)};
    draw_line(image, side.at[side.run[k]], side.at[side.run[k + 1]], stroke);
  }
}

/// Where the number of a seam's side is written: beside its middle, inside the panel. None where
/// there is no room, in a small picture.
std::optional<Vec2> number_place(const SeamSide& side, int font) {
  const std::vector<int>& run = side.run;
  const std::vector<Vec2>& at = side.at;
  double length = 0;
  for (std::size_t i = 0; i + 1 < run.size(); ++i)
    length += (at[run[i + 1]] - at[run[i]]).norm();
  const int first = run[(run.size() - 1) / 2], second = run[(run.size() - 1) / 2 + 1];
  const Vec2 &a = at[first], &b = at[second];
  if (!((b - a).norm() > 0) || length < 2 * font)
    return {};
  const pattern::PanelInfo& info = side.panels->panels[panel_of(*side.panels, first)];
  double low = 1e9, high = -1e9;
  for (int v = info.first_vertex; v < info.first_vertex + info.n_vertices; ++v) {
    low = std::min(low, at[v].y());
    high = std::max(high, at[v].y());
  }
  if (high - low < 1.2 * font)
    return {};
  // the panel lies on the side of the triangle that the segment belongs to
  Vec2 aside = Vec2(a.y() - b.y(), b.x() - a.x()).normalized();
  for (int f = info.first_triangle; f < info.first_triangle + info.n_triangles; ++f) {
    const Triangle& t = side.panels->triangles[f];
    if (std::count(t.begin(), t.end(), first) + std::count(t.begin(), t.end(), second) < 2)
      continue;
    if (aside.dot((at[t[0]] + at[t[1]] + at[t[2]]) / 3 - a) < 0)
      aside = -aside;
    break;
  }
  return 0.5 * (a + b) + 0.75 * font * aside;
}

/// Seams in colours, and with numbers on both their sides: colours repeat after a dozen.
void draw_seams(io::Image& image, const Sheet& sheet, const Camera& camera, double unit, int font,
                bool numbers) {
  for_each_seam_side(sheet, camera, image,
                     [&](const SeamSide& side) { draw_seam(image, side, 3 * unit); });
  if (!numbers)
    return;
  for_each_seam_side(sheet, camera, image, [&](const SeamSide& side) {
    if (const std::optional<Vec2> place = number_place(side, font))
      draw_text_halo(
          image, std::to_string(side.seam + 1), static_cast<int>(std::lround(place->x())),
          static_cast<int>(std::lround(place->y() + HALF_DIGIT * font)),
          {.size = font, .align = Align::CENTER, .color = seam_color(side.seam) >> 1 & 0x7f7f7f});
  });
}

/// A panel edge as it lies in the picture, pixels.
std::vector<Vec2> edge_in_picture(const Sheet::Panel& panel, const pattern::PanelEdge& edge,
                                  const Camera& camera, const io::Image& image) {
  constexpr int PIECES = 24;
  const pattern::ArcLength arc(edge.path);
  const Vec2 warp = panel.info->grain.normalized(), weft(warp.y(), -warp.x());
  std::vector<Vec2> out;
  for (int k = 0; k <= PIECES; ++k) {
    const Vec2 own = arc.at(arc.length() * k / PIECES);
    const Vec2 at = Vec2(own.dot(weft), own.dot(warp)) + panel.shift;
    out.push_back(camera.pixel(Vec3(at.x(), at.y(), 0), image.width, image.height).head<2>());
  }
  return out;
}

/// "1?" for an edge that is asked for, "1.2" for its second answer; several with blanks between.
std::string asked_marks(const Scene& scene, const std::string& panel, const std::string& edge) {
  std::string marks;
  for (const AskedEdge& a : scene.asked)
    if (a.panel == panel && a.edge == edge)
      marks += (marks.empty() ? "" : " ") + std::to_string(a.question) +
               (a.answer > 0 ? "." + std::to_string(a.answer) : "?");
  return marks;
}

/// Names of panel edges, inside them where they meet the middle; edges that are asked about are
/// drawn thick, with their marks.
void draw_edges(io::Image& image, const Scene& scene, const Sheet& sheet, const Camera& camera,
                double unit, int font) {
  for (const bool texts : {false, true}) // no line over a text
    for (const Sheet::Panel& panel : sheet.panels) {
      const auto& source = panel.garment->panels.source;
      const int index = source ? source->find_panel(panel.info->name) : -1;
      if (index < 0)
        continue;
      const pattern::Panel& own = source->panels[index];
      for (int e = 0; e < own.n_edges(); ++e) {
        const std::vector<Vec2> line = edge_in_picture(panel, own.edge(e), camera, image);
        const std::string marks = asked_marks(scene, own.name, own.edge(e).name);
        const Vec2 along = line[line.size() / 2 + 1] - line[line.size() / 2 - 1];
        if (!texts) {
          for (std::size_t k = 0; k + 1 < line.size() && !marks.empty(); ++k)
            draw_line(image, line[k], line[k + 1], {.width = 5 * unit, .color = ASKED_EDGE});
          draw_disc(image, line.front(), CORNER_DOT * unit, EDGE_NAME);
          continue;
        }
        if (marks.empty() && (line.back() - line.front()).norm() < font)
          continue; // names of small edges would cover each other
        // The outline is walked with the cloth at its left; y runs down in the picture.
        const Vec2 inwards = Vec2(along.y(), -along.x()).normalized();
        const std::string name = own.edge(e).name;
        const std::string text = marks.empty() ? name : marks + "  " + name;
        const double aside = text_width(text, font) * std::abs(inwards.x()) / 2 +
                             TEXT_HEIGHT * font * std::abs(inwards.y()) + ASKED_WIDTH * unit;
        // What is asked about is written outside, where no other name is.
        const double side = marks.empty() ? 1 : -1;
        const Vec2 at = line[line.size() / 2] + side * aside * inwards;
        draw_text_halo(image, text, static_cast<int>(std::lround(at.x())),
                       static_cast<int>(std::lround(at.y() + HALF_DIGIT * font)),
                       {.size = font,
                        .align = Align::CENTER,
                        .color = marks.empty() ? EDGE_NAME : ASKED_NAME});
      }
    }
}

/// How a sheet of panels lies in a picture.
struct SheetView {
  const Sheet& sheet;
  const Camera& camera;
  double unit; // pixels, of a fine line
  int font;    // pixels
  bool mapped; // colours of a map lie below: text has a halo
};

/// Name, size and grain of a panel, on it or, where it has no room, above it.
void draw_name(io::Image& image, const SheetView& view, const Sheet::Panel& panel) {
  const auto& [sheet, camera, unit, font, mapped] = view;
  const Vec3 at = camera.pixel(middle_of(sheet, panel), image.width, image.height);
  const Vec2 size = panel.high - panel.low;
  const double pixels_per_m = 0.5 * image.height / camera.half_height,
               arrow = std::min(0.28 * size.y() * pixels_per_m, 60 * unit);
  const auto write = mapped ? draw_text_halo : draw_text;
  const int color = mapped ? 0x101010 : 0x404040;
  const bool narrow =
      size.y() * pixels_per_m < 6 * font; // no room for the name between the numbers of seams
  const std::string text = decimals(100 * size.x(), 1) + " x " + centimetres(size.y());
  const bool outside =
      narrow || std::max(text_width(panel.info->name, font), text_width(text, font - 2)) >
                    0.8 * size.x() * pixels_per_m;
  const Lettering name = {.size = font, .align = Align::CENTER, .color = color};
  const Lettering measures = {.size = font - 2, .align = Align::CENTER, .color = color};
  if (outside) {
    const Vec3 above = camera.pixel(Vec3(0.5 * (panel.low.x() + panel.high.x()), panel.high.y(), 0),
                                    image.width, image.height);
    draw_text(image, panel.info->name, static_cast<int>(above.x()),
              static_cast<int>(above.y() - 0.45 * font), name);
  } else {
    write(image, panel.info->name, static_cast<int>(at.x()), static_cast<int>(at.y()), name);
    write(image, text, static_cast<int>(at.x()), static_cast<int>(at.y() + 1.3 * font), measures);
  }
  if (narrow)
    return;
  const double base =
      outside ? at.y() + 0.5 * arrow : at.y() - 1.6 * font; // the grain: warp runs upwards
  const Vec2 foot(at.x(), base), tip(at.x(), base - arrow);
  if (mapped)
    draw_line(image, foot, tip, {.width = 3 * unit, .color = 0xffffff});
  const Stroke fine = {.width = 1.2 * unit, .color = color};
  draw_line(image, foot, tip, fine);
  for (double side : {-1.0, 1.0})
    draw_line(image, tip, Vec2(at.x() + side * 4 * unit, base - arrow + 7 * unit), fine);
}

} // namespace

std::vector<Vec2> pack_panels(const std::vector<Vec2>& sizes, double gap,
                              double width_over_height) {
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return sizes[a].y() > sizes[b].y(); });
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
    const double height =
        std::max(size.y(), size.x() / width_over_height); // of the picture that holds them
    if (height < least * 0.999) {
      least = height;
      best = trial;
    }
  }
  return best;
}

io::Image draw_pattern(const Scene& scene, const DrawOptions& options, bool name_edges) {
  if (scene.garments.empty())
    throw Error(ErrorKind::USAGE, "render.input-missing"_id, "", "--view pattern",
                "needs a garment, panels or a pattern",
                "give panels.json, shirt.json or the pattern's file");
  DrawOptions flat = options;
  flat.occlusion_directions = 0;
  flat.ground = false;
  const bool mapped = !options.map_colors.empty();
  const double share = mapped ? 0.82 : 1; // of the width: the colour bar stands beside
  const double aspect = static_cast<double>(options.width) / options.height;
  const double unit = std::max(1.0, options.height / 1000.0);
  const int font = std::max(9, static_cast<int>(std::lround(13 * unit)));
  const double name = 1.5 * font / options.height,
               bar_below = (12 * unit + 0.8 * font) / options.height; // of the height, kept free
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
  draw_seams(image, sheet, camera, unit, font - 2, !name_edges);
  if (name_edges)
    draw_edges(image, scene, sheet, camera, unit, font - 1);
  for (const Sheet::Panel& panel : sheet.panels)
    draw_name(image, {sheet, camera, unit, font, mapped}, panel);
  const double bar = 0.1 * pixels_per_m, y = options.height - 12 * unit;
  draw_line(image, Vec2(12 * unit, y), Vec2(12 * unit + bar, y),
            {.width = 2 * unit, .color = 0x303030});
  draw_text(image, "10 cm", static_cast<int>(16 * unit + bar), static_cast<int>(y + 0.35 * font),
            {.size = font});
  return image;
}

} // namespace sloper::render
