#include <garment/drapemeter/shadow.hpp>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/garment/drapemeter/silhouette.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::garment {

namespace {

constexpr int GREYS = 256;
constexpr int CLOTH_GREY = 40, DISC_GREY = 140; // on white
/// Half an angle over which the outline is smoothed, degrees: noise of single pixels makes no fold.
constexpr int SMOOTHING = 3;
constexpr double FOLD_SWING = 0.002; // m
/// How far a disc's farthest pixel may lie beyond the radius of its area before it is no disc.
constexpr double ROUND = 1.15;
constexpr double CENTRED = 0.2; // of the cloth's radius: a disc's middle lies nearer to the cloth's
constexpr double LEAST_DISC_STEP = 20; // greys between disc and cloth
/// A specimen whose shadow is larger than itself by more than this was cut, or scaled, wrongly.
constexpr double MOST_COEFFICIENT = 1.03, LEAST_COEFFICIENT = -0.03;

struct Grid {
  int width, height;
  std::vector<char> on;
  char& at(int x, int y) { return on[static_cast<std::size_t>(y) * width + x]; }
  char at(int x, int y) const { return on[static_cast<std::size_t>(y) * width + x]; }
};

int grey_of(const std::uint8_t* p) {
  return (299 * p[0] + 587 * p[1] + 114 * p[2] + 500) / 1000;
}

/// Otsu's threshold: greys up to it are the darker class. -1 where there is but one grey.
int otsu(const std::array<double, GREYS>& count) {
  double all = 0, sum = 0;
  for (int g = 0; g < GREYS; ++g) {
    all += count[g];
    sum += g * count[g];
  }
  double below = 0, below_sum = 0, best = 0;
  int threshold = -1;
  for (int g = 0; g + 1 < GREYS; ++g) {
    below += count[g];
    below_sum += g * count[g];
    if (below <= 0 || below >= all)
      continue;
    const double a = below_sum / below, b = (sum - below_sum) / (all - below),
                 between = below * (all - below) * (a - b) * (a - b);
    if (between > best) {
      best = between;
      threshold = g;
    }
  }
  return threshold;
}

/// Marks the pixels connected to (x, y) over sides that have its value. @return how many
std::size_t mark_piece(const Grid& grid, int x, int y, std::vector<int>& label, int mark) {
  std::vector<std::array<int, 2>> open{{x, y}};
  const auto at = [&](int px, int py) { return static_cast<std::size_t>(py) * grid.width + px; };
  label[at(x, y)] = mark;
  const char value = grid.at(x, y);
  std::size_t count = 0;
  while (!open.empty()) {
    const auto [px, py] = open.back();
    open.pop_back();
    ++count;
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      const int qx = px + dx, qy = py + dy;
      if (qx < 0 || qy < 0 || qx >= grid.width || qy >= grid.height)
        continue;
      if (label[at(qx, qy)] || grid.at(qx, qy) != value)
        continue;
      label[at(qx, qy)] = mark;
      open.push_back({qx, qy});
    }
  }
  return count;
}

/// The connected piece that (x, y) is in.
Grid piece(const Grid& grid, int x, int y) {
  std::vector<int> label(grid.on.size(), 0);
  mark_piece(grid, x, y, label, 1);
  return {grid.width, grid.height, std::vector<char>(label.begin(), label.end())};
}

struct Blob {
  double area = 0; // pixels
  Vec2 middle = Vec2::Zero();
};
Blob blob_of(const Grid& grid) {
  Blob b;
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x)
      if (grid.at(x, y)) {
        ++b.area;
        b.middle += Vec2(x, y);
      }
  if (b.area > 0)
    b.middle /= b.area;
  return b;
}

Grid cloth_of(const io::Image& picture, const std::string& name) {
  std::array<double, GREYS> count{};
  const int w = picture.width, h = picture.height;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      if (picture.at(x, y)[3] > 127)
        ++count[grey_of(picture.at(x, y))];
  const int threshold = otsu(count);
  Grid dark{w, h, std::vector<char>(static_cast<std::size_t>(w) * h, 0)};
  std::vector<char> clear(dark.on.size(), 0);
  double border = 0, border_dark = 0, transparent = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const bool seen = picture.at(x, y)[3] > 127;
      dark.at(x, y) = seen && grey_of(picture.at(x, y)) <= threshold;
      transparent += !seen;
      clear[static_cast<std::size_t>(y) * w + x] = !seen;
      if (x > 0 && y > 0 && x + 1 < w && y + 1 < h)
        continue;
      ++border;
      border_dark += dark.at(x, y);
    }
  if (threshold < 0 && transparent == 0)
    throw input_error("drapemeter.bad-picture"_id, name, "",
                      "is all of one grey: there is no cloth to be seen",
                      "give a picture from above, cloth on a ground of another grey");
  const bool ground_is_dark = transparent == 0 && border_dark > 0.5 * border;
  for (std::size_t k = 0; k < dark.on.size(); ++k)
    dark.on[k] = transparent > 0 ? !clear[k] : dark.on[k] != ground_is_dark;
  // The largest piece; then all that the ground does not reach from the border.
  std::vector<int> label(dark.on.size(), 0);
  std::size_t most = 0;
  int pieces = 0, largest = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      if (!dark.at(x, y) || label[static_cast<std::size_t>(y) * w + x])
        continue;
      const std::size_t area = mark_piece(dark, x, y, label, ++pieces);
      if (area > most) {
        most = area;
        largest = pieces;
      }
    }
  if (most == 0)
    throw input_error("drapemeter.bad-picture"_id, name, "", "there is no cloth to be seen",
                      "give a picture from above");
  Grid best{w, h, std::vector<char>(dark.on.size(), 0)};
  for (std::size_t k = 0; k < label.size(); ++k)
    best.on[k] = label[k] == largest;
  for (int x = 0; x < w; ++x)
    if (best.at(x, 0) || best.at(x, h - 1))
      throw input_error("drapemeter.bad-picture"_id, name, "",
                        "the cloth reaches the picture's border", "show all of it");
  for (int y = 0; y < h; ++y)
    if (best.at(0, y) || best.at(w - 1, y))
      throw input_error("drapemeter.bad-picture"_id, name, "",
                        "the cloth reaches the picture's border", "show all of it");
  const Grid ground = piece(best, 0, 0);
  for (std::size_t k = 0; k < best.on.size(); ++k)
    best.on[k] = !ground.on[k];
  return best;
}

/// Metres a pixel, from the disc that lies on the cloth.
double scale_by_disc(const io::Image& picture, const Grid& cloth, const std::string& name,
                     const SilhouetteSetup& setup) {
  const std::string next = "give --mm-per-pixel, or lay a disc of another grey on top";
  std::array<double, GREYS> count{};
  for (int y = 0; y < cloth.height; ++y)
    for (int x = 0; x < cloth.width; ++x)
      if (cloth.at(x, y))
        ++count[grey_of(picture.at(x, y))];
  const int threshold = otsu(count);
  const Blob whole = blob_of(cloth);
  const int cx = static_cast<int>(whole.middle.x()), cy = static_cast<int>(whole.middle.y());
  Grid alike = cloth;
  double sum[2] = {}, number[2] = {};
  const bool middle_is_dark = grey_of(picture.at(cx, cy)) <= threshold;
  for (int y = 0; y < cloth.height; ++y)
    for (int x = 0; x < cloth.width; ++x) {
      if (!cloth.at(x, y))
        continue;
      const int grey = grey_of(picture.at(x, y));
      const bool same = (grey <= threshold) == middle_is_dark;
      alike.at(x, y) = same;
      sum[same] += grey;
      ++number[same];
    }
  if (threshold < 0 || number[0] < 1 || number[1] < 1 ||
      std::abs(sum[0] / number[0] - sum[1] / number[1]) < LEAST_DISC_STEP)
    throw input_error("drapemeter.bad-picture"_id, name, "",
                      "there is no disc to be seen on the cloth", next);
  const Grid disc = piece(alike, cx, cy);
  const Blob blob = blob_of(disc);
  const double radius = std::sqrt(blob.area / units::PI);
  double farthest = 0;
  for (int y = 0; y < disc.height; ++y)
    for (int x = 0; x < disc.width; ++x)
      if (disc.at(x, y))
        farthest = std::max(farthest, (Vec2(x, y) - blob.middle).norm());
  const double cloth_radius = std::sqrt(whole.area / units::PI);
  if (farthest > ROUND * radius + 1 || (blob.middle - whole.middle).norm() > CENTRED * cloth_radius)
    throw input_error("drapemeter.bad-picture"_id, name, "", "the cloth's middle is no round disc",
                      next);
  return 0.5 * setup.disc_m / radius;
}

/// Distance of the outline from the middle, pixels, smoothed.
std::vector<double> outline_of(const Grid& cloth, const Vec2& middle) {
  std::vector<double> radius;
  const double reach = std::hypot(cloth.width, cloth.height);
  for (int degree = 0; degree < 360; ++degree) {
    const double a = degree * units::PI / 180;
    const Vec2 direction(std::cos(a), -std::sin(a));
    double farthest = 0;
    for (double r = 0; r < reach; r += 0.5) {
      const Vec2 q = middle + r * direction;
      const auto x = std::lround(q.x()), y = std::lround(q.y());
      if (x < 0 || y < 0 || x >= cloth.width || y >= cloth.height)
        break;
      if (cloth.at(static_cast<int>(x), static_cast<int>(y)))
        farthest = r;
    }
    radius.push_back(farthest);
  }
  std::vector<double> smooth(360, 0);
  for (int k = 0; k < 360; ++k)
    for (int d = -SMOOTHING; d <= SMOOTHING; ++d)
      smooth[k] += radius[(k + d + 360) % 360] / (2 * SMOOTHING + 1);
  return smooth;
}

} // namespace

Silhouette measure_silhouette(const io::Image& picture, const std::string& name,
                              const SilhouetteSetup& setup) {
  if (picture.width < 16 || picture.height < 16)
    throw input_error("drapemeter.bad-picture"_id, name, "", "is too small to be measured",
                      "give 100 pixels and more a side");
  const Grid cloth = cloth_of(picture, name);
  const Blob whole = blob_of(cloth);
  Silhouette out;
  out.m_per_pixel =
      setup.m_per_pixel > 0 ? setup.m_per_pixel : scale_by_disc(picture, cloth, name, setup);
  const double disc = 0.25 * units::PI * setup.disc_m * setup.disc_m,
               specimen = 0.25 * units::PI * setup.specimen_m * setup.specimen_m;
  out.coefficient = (whole.area * out.m_per_pixel * out.m_per_pixel - disc) / (specimen - disc);
  if (out.coefficient > MOST_COEFFICIENT || out.coefficient < LEAST_COEFFICIENT)
    throw input_error("drapemeter.wrong-scale"_id, name, "",
                      "the cloth covers " + std::to_string(std::lround(100 * out.coefficient)) +
                          " % of the ring between disc and specimen",
                      "check the diameters and the scale");
  out.radius_m = outline_of(cloth, whole.middle);
  std::vector<Vec3> rim;
  for (int k = 0; k < 360; ++k) {
    out.radius_m[k] *= out.m_per_pixel;
    const double a = k * units::PI / 180;
    rim.emplace_back(out.radius_m[k] * std::cos(a), 0, out.radius_m[k] * std::sin(a));
  }
  out.folds = count_folds(rim, FOLD_SWING);
  return out;
}

io::Image draw_silhouette(const std::vector<Triangle>& triangles, const std::vector<Vec3>& position,
                          double disc_m, int side_px, double side_m) {
  io::Image image;
  image.width = image.height = side_px;
  image.rgba.assign(static_cast<std::size_t>(side_px) * side_px * 4, 255);
  const double cell = side_m / side_px;
  const auto paint = [&](int x, int y, int grey) {
    std::fill_n(image.at(x, y), 3, static_cast<std::uint8_t>(grey));
  };
  const auto middle = [&](int k) { return (k + 0.5) * cell - 0.5 * side_m; };
  const auto pixel = [&](double v) {
    return std::clamp(static_cast<int>((v + 0.5 * side_m) / cell), 0, side_px - 1);
  };
  for (const Triangle& t : triangles) {
    Vec2 p[3];
    for (int k = 0; k < 3; ++k)
      p[k] = Vec2(position[t[k]].x(), position[t[k]].z());
    const auto side = [](const Vec2& a, const Vec2& b, const Vec2& q) {
      return (b.x() - a.x()) * (q.y() - a.y()) - (b.y() - a.y()) * (q.x() - a.x());
    };
    const Vec2 low = p[0].cwiseMin(p[1]).cwiseMin(p[2]), high = p[0].cwiseMax(p[1]).cwiseMax(p[2]);
    for (int y = pixel(low.y()); y <= pixel(high.y()); ++y)
      for (int x = pixel(low.x()); x <= pixel(high.x()); ++x) {
        const Vec2 q(middle(x), middle(y));
        const double a = side(p[0], p[1], q), b = side(p[1], p[2], q), c = side(p[2], p[0], q);
        if ((a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0))
          paint(x, y, CLOTH_GREY);
      }
  }
  for (int y = 0; y < side_px; ++y)
    for (int x = 0; x < side_px; ++x)
      if (Vec2(middle(x), middle(y)).norm() < 0.5 * disc_m)
        paint(x, y, DISC_GREY);
  return image;
}

} // namespace sloper::garment
