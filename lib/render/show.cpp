#include <sloper/base/error.hpp>
#include <sloper/base/text.hpp>
#include <sloper/render/overlay.hpp>
#include <sloper/render/show.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::render {

namespace {

constexpr int LANDMARK = 0xc0392b, BONE = 0x1f6f8b, SLICE = 0xb4531a, INK = 0x303030;
constexpr int AXES[] = {0xc0392b, 0x2e8b57, 0x2b5fa8};
constexpr double SLACK_M = 0.012; // a mark may lie this far below the surface that it marks

double fine_line(int height) {
  return std::max(1.0, height / 1000.0);
} // pixels
int label_font(int height) {
  return std::max(9, static_cast<int>(std::lround(12.5 * fine_line(height))));
}

/// Projects and draws; sizes follow the picture's height.
class Pen {
public:
  Pen(io::Image& image, const Camera& camera, const Renderer& renderer)
      : m_image(image), m_camera(camera), m_renderer(renderer),
        m_slack(SLACK_M / (2 * camera.half_depth)), unit(fine_line(image.height)) {}
  Vec3 at(const Vec3& p) const { return m_camera.pixel(p, m_image.width, m_image.height); }
  bool sees(const Vec3& p) const { return m_renderer.is_visible(at(p), m_slack); }
  void line(const Vec3& a, const Vec3& b, double width, int color, bool hide) {
    const Vec3 p = at(a), q = at(b);
    const bool hidden =
        hide && !(m_renderer.is_visible(p, m_slack) && m_renderer.is_visible(q, m_slack));
    draw_line(m_image, p.head<2>(), q.head<2>(),
              {.width = width * unit, .color = color, .opacity = hidden ? 0.18 : 1});
  }
  void disc(const Vec3& a, double radius, int color, bool filled) {
    const Vec2 p = at(a).head<2>();
    if (filled)
      draw_disc(m_image, p, (radius + 1.2) * unit, 0xffffff);
    draw_disc(m_image, p, radius * unit, color, filled ? 0 : 1.2 * unit, filled ? 1 : 0.45);
  }
  int font() const { return label_font(m_image.height); }
  io::Image& image() { return m_image; }

private:
  io::Image& m_image;
  const Camera& m_camera;
  const Renderer& m_renderer;
  double m_slack;

public:
  const double unit; ///< pixels of a fine line
};

struct Label {
  Vec3 at;
  std::string text;
  int color;
  bool always_left = false;
};

/// Heights in rising order, moved apart to `pitch` by as little as possible (least squares, pooling
/// neighbours that violate it) and kept within [low, high] where they fit.
std::vector<double> move_apart(const std::vector<double>& wanted, double pitch, double low,
                               double high) {
  struct Pool {
    double sum; ///< of wanted heights less their place in the row
    int n;
    double mean() const { return sum / n; }
  };
  std::vector<Pool> pools;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    pools.push_back({wanted[k] - pitch * static_cast<double>(k), 1});
    for (; pools.size() > 1 && pools[pools.size() - 2].mean() >= pools.back().mean();
         pools.pop_back()) {
      pools[pools.size() - 2].sum += pools.back().sum;
      pools[pools.size() - 2].n += pools.back().n;
    }
  }
  std::vector<double> y;
  const double last = pitch * static_cast<double>(wanted.size()) - pitch;
  for (const Pool& pool : pools)
    for (int k = 0; k < pool.n; ++k)
      y.push_back(std::max(low, std::min(pool.mean(), high - last)) +
                  pitch * static_cast<double>(y.size()));
  return y;
}

/// Names in two columns at the sides, each with a line to its point; moved apart so that none
/// covers another.
void draw_labels(Pen& pen, std::vector<Label> labels, int right_edge) {
  io::Image& image = pen.image();
  const int font = pen.font(), pitch = font + font / 3;
  std::sort(labels.begin(), labels.end(),
            [](const Label& a, const Label& b) { return a.at.y() < b.at.y(); });
  for (bool right : {false, true}) {
    std::vector<Label> column;
    for (const Label& l : labels)
      if ((l.at.x() >= 0.5 * right_edge && !l.always_left) == right)
        column.push_back(l);
    std::vector<double> wanted;
    wanted.reserve(column.size());
    for (const Label& l : column)
      wanted.push_back(l.at.y());
    const std::vector<double> y = move_apart(wanted, pitch, pitch, image.height - 0.4 * font);
    for (std::size_t k = 0; k < column.size(); ++k) {
      const int width = text_width(column[k].text, font), margin = font / 2;
      const double edge = right ? right_edge - margin - width - 4 : margin + width + 4;
      draw_line(image, Vec2(edge, y[k]), column[k].at.head<2>(),
                {.width = 0.8 * pen.unit, .color = column[k].color, .opacity = 0.55});
      draw_text_halo(image, column[k].text, right ? right_edge - margin - width : margin,
                     static_cast<int>(y[k] + 0.36 * font), {.size = font, .color = INK});
    }
  }
}

[[noreturn]] void lacks(const std::string& what, const std::string& needs) {
  throw Error(ErrorKind::USAGE, "render.input-missing"_id, "", "--show " + what, "needs " + needs,
              "give it as a document");
}

std::string slice_label(const std::string& name, const body::Level& level) {
  return name + "  " + centimetres(level.girth_m);
}

void show_slices(Pen& pen, const body::Body& body, std::vector<Label>& labels) {
  std::vector<char> trunk(body.face_part.size());
  for (std::size_t f = 0; f < trunk.size(); ++f)
    trunk[f] = body.face_part[f] == body::Part::TORSO || body.face_part[f] == body::Part::LEG_L ||
               body.face_part[f] == body::Part::LEG_R;
  for (const auto& [name, level] : body.levels) {
    const auto cut = cut_level(body.skin, level.y, trunk);
    Vec3 outermost(1e9, 0, 0);
    for (const auto& [a, b] : cut) {
      pen.line(a, b, 1.8, SLICE, true);
      const Vec3 p = pen.at(a);
      if (p.x() < outermost.x())
        outermost = p;
    }
    if (!cut.empty())
      labels.push_back({outermost, slice_label(name, level), SLICE, true});
  }
}

void show_frames(Pen& pen, const body::Body& body, std::vector<Label>& labels) {
  for (const auto& [name, part] : body.frames) {
    const PartFrame& f = part.frame;
    const double reach = 0.08;
    pen.line(f.lower, f.upper, 2, AXES[1], false);
    pen.line(f.lower, f.lower + reach * f.theta_zero, 2, AXES[2], false);
    pen.line(f.lower, f.lower + (f.mirrored ? -reach : reach) * f.axis().cross(f.theta_zero), 2,
             AXES[0], false);
    pen.disc(f.lower, 3, AXES[1], true);
    pen.disc(f.upper, 3, AXES[1], true);
    labels.push_back({pen.at(0.7 * f.lower + 0.3 * f.upper), name, AXES[1]});
  }
}

void show_seams(Pen& pen, const Scene& scene) {
  for (const garment::Garment& g : scene.garments)
    for (std::size_t s = 0; s < g.panels.seams.size(); ++s)
      for (const std::vector<int>* run : {&g.panels.seams[s].a, &g.panels.seams[s].b})
        for (std::size_t k = 0; k + 1 < run->size(); ++k)
          pen.line(g.position[g.particle_of[(*run)[k]]], g.position[g.particle_of[(*run)[k + 1]]],
                   2.4, seam_color(static_cast<int>(s)), true);
}

void show_names(Pen& pen, const Scene& scene, std::vector<Label>& labels) {
  for (const garment::Garment& g : scene.garments)
    for (const pattern::PanelInfo& panel : g.panels.panels) {
      if (panel.n_vertices == 0)
        continue;
      Vec3 middle = Vec3::Zero();
      for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v)
        middle += g.position[g.particle_of[v]] / panel.n_vertices;
      double nearest = 1e9;
      Vec3 at = middle; // a vertex of the panel: the middle of a sleeve lies in the arm
      for (int v = panel.first_vertex; v < panel.first_vertex + panel.n_vertices; ++v) {
        const Vec3& p = g.position[g.particle_of[v]];
        if (pen.sees(p) && (p - middle).squaredNorm() < nearest) {
          nearest = (p - middle).squaredNorm();
          at = p;
        }
      }
      if (nearest > 1e8)
        continue;
      pen.disc(at, 2.5, INK, true);
      labels.push_back({pen.at(at), panel.name, INK});
    }
}

} // namespace

Show parse_show(const std::string& list) {
  Show show;
  const std::pair<const char*, bool Show::*> words[] = {
      {"landmarks", &Show::landmarks}, {"bones", &Show::bones}, {"frames", &Show::frames},
      {"slices", &Show::slices},       {"seams", &Show::seams}, {"names", &Show::names},
      {"edges", &Show::edges}};
  for (const std::string& word : split(list)) {
    const auto found = std::find_if(std::begin(words), std::end(words),
                                    [&](const auto& w) { return word == w.first; });
    if (found == std::end(words)) {
      std::vector<std::string> names;
      for (const auto& w : words)
        names.emplace_back(w.first);
      throw unknown_word(
          "--show", word, names,
          "known are landmarks, bones, frames, slices, seams, names and edges, joined by commas");
    }
    show.*found->second = true;
  }
  return show;
}

int seam_color(int k) {
  static const int colors[] = {0xd62728, 0x1f77b4, 0x2ca02c, 0xff7f0e, 0x9467bd, 0x17becf,
                               0x8c564b, 0xe377c2, 0x7f7f7f, 0xbcbd22, 0x00429d, 0x7a4900};
  return colors[k % 12];
}

std::vector<std::array<Vec3, 2>> cut_level(const TriangleMesh& mesh, double height,
                                           const std::vector<char>& takes_part) {
  std::vector<std::array<Vec3, 2>> cut;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (!takes_part.empty() && !takes_part[f])
      continue;
    std::array<Vec3, 3> hit;
    int n = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = mesh.positions[mesh.triangles[f][k]],
                 &b = mesh.positions[mesh.triangles[f][(k + 1) % 3]];
      if ((a.y() < height) != (b.y() < height))
        hit[n++] = a + (height - a.y()) / (b.y() - a.y()) * (b - a);
    }
    if (n == 2)
      cut.push_back({hit[0], hit[1]});
  }
  return cut;
}

double label_share(const Scene& scene, const Show& show, int width, int height) {
  const int font = label_font(height);
  int widest = 0;
  const auto holds = [&](const std::string& text) {
    widest = std::max(widest, text_width(text, font));
  };
  if (scene.body) {
    if (show.landmarks)
      for (const auto& [name, landmark] : scene.body->landmarks)
        holds(name);
    if (show.slices)
      for (const auto& [name, level] : scene.body->levels)
        holds(slice_label(name, level));
    if (show.frames)
      for (const auto& [name, frame] : scene.body->frames)
        holds(name);
  }
  if (show.names)
    for (const garment::Garment& g : scene.garments)
      for (const pattern::PanelInfo& panel : g.panels.panels)
        holds(panel.name);
  return widest == 0 ? 0 : std::min(0.2, (widest + 1.5 * font) / width);
}

void draw_show(io::Image& image, const Scene& scene, const Camera& camera, const Renderer& renderer,
               const Show& show, int legend_width) {
  Pen pen(image, camera, renderer);
  std::vector<Label> labels;
  if (!scene.body) {
    const std::pair<bool, const char*> of_body[] = {{show.landmarks, "landmarks"},
                                                    {show.bones, "bones"},
                                                    {show.frames, "frames"},
                                                    {show.slices, "slices"}};
    for (const auto& [shown, name] : of_body)
      if (shown)
        lacks(name, "a body.json");
  }
  if (scene.garments.empty() && (show.seams || show.names))
    lacks(show.seams ? "seams" : "names", "a shirt.json or panels.json");
  if (show.seams)
    show_seams(pen, scene);
  if (show.slices)
    show_slices(pen, *scene.body, labels);
  if (show.frames)
    show_frames(pen, *scene.body, labels);
  if (show.bones)
    for (const body::Bone& bone : scene.body->bones) {
      pen.line(bone.head, bone.tail, 5, 0xffffff, false);
      pen.line(bone.head, bone.tail, 3, BONE, false);
      pen.disc(bone.head, 4, BONE, true);
      pen.disc(bone.tail, 3, BONE, true);
    }
  if (show.landmarks)
    for (const auto& [name, landmark] : scene.body->landmarks) {
      const bool seen = pen.sees(landmark.p);
      pen.disc(landmark.p, seen ? 3.2 : 3, LANDMARK, seen);
      if (seen)
        labels.push_back({pen.at(landmark.p), name, LANDMARK});
    }
  if (show.names)
    show_names(pen, scene, labels);
  draw_labels(pen, labels, image.width - legend_width);
}

} // namespace sloper::render
