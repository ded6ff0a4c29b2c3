/// measure-hem SHIRT.json...: one line per draped garment, tab separated: girth, shadow, turning
/// and waviness of its lowest edge, strain.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <map>
#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/sewing.hpp>

using namespace sloper;

namespace {

/// The boundary loop whose mean height is least, as particles in order.
std::vector<int> hem_of(const garment::Garment& g) {
  std::map<std::pair<int, int>, int> uses;
  const auto triangles = g.particle_triangles();
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k)
      ++uses[{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}];
  std::map<int, int> next; // along the boundary, as its triangle runs
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k)
      if (uses[{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}] == 1)
        next[t[k]] = t[(k + 1) % 3];
  std::vector<int> best;
  double lowest = 1e300;
  while (!next.empty()) {
    std::vector<int> loop;
    double height = 0;
    for (auto at = next.begin(); at != next.end(); at = next.find(loop.back())) {
      loop.push_back(at->second);
      height += g.position[at->second].y();
      next.erase(at);
    }
    height /= static_cast<double>(loop.size());
    if (loop.size() > 2 && height < lowest) {
      lowest = height;
      best = loop;
    }
  }
  return best;
}

/// Root mean square of the hem's harmonics beyond the ellipse, seen from above, m; `folds`: the
/// strongest of them.
double waviness(const std::vector<std::complex<double>>& z, int& folds) {
  constexpr int FIRST = 3, LAST = 30;
  const auto n = static_cast<double>(z.size());
  double sum = 0, strongest = 0;
  folds = 0;
  for (int k = FIRST; k <= LAST; ++k) {
    double power = 0;
    for (int sign : {-1, 1}) {
      std::complex<double> c = 0;
      // a wave of k folds on a round hem is z = e^(it) (r + a cos(kt)): harmonics 1 + k and 1 - k
      for (std::size_t i = 0; i < z.size(); ++i)
        c += z[i] *
             std::polar(1.0, -2 * sloper::units::PI * (1 + sign * k) * static_cast<double>(i) / n) /
             n;
      power += std::norm(c);
    }
    sum += power;
    if (power > strongest) {
      strongest = power;
      folds = k;
    }
  }
  return std::sqrt(sum);
}

/// How far the hem turns altogether, seen from above, in full turns: 1 for a hem without hollows,
/// more with every fold. Looked at over 128 chords, about a centimetre each.
double turning(const std::vector<std::complex<double>>& z) {
  const std::size_t step = z.size() / 128;
  double sum = 0;
  for (std::size_t i = 0; i < z.size(); i += step) {
    const auto a = z[(i + step) % z.size()] - z[i],
               b = z[(i + 2 * step) % z.size()] - z[(i + step) % z.size()];
    sum += std::abs(std::arg(b / a));
  }
  return sum / (2 * sloper::units::PI);
}

void measure(const std::string& path) {
  const garment::Garment g = garment::read_garment(path);
  const std::vector<int> hem = hem_of(g);
  if (hem.size() < 3)
    throw input_error("sample.no-hem"_id, path, "", "the garment has no lower edge");
  std::vector<double> length{0};
  double shadow = 0;
  for (std::size_t i = 0; i < hem.size(); ++i) {
    const Vec3 &p = g.position[hem[i]], &q = g.position[hem[(i + 1) % hem.size()]];
    length.push_back(length.back() + (q - p).norm());
    shadow += 0.5 * (p.z() * q.x() - q.z() * p.x());
  }
  constexpr int N = 512;
  std::vector<std::complex<double>> z; // evenly along the hem
  for (int k = 0; k < N; ++k) {
    const double at = length.back() * k / N;
    const auto i = static_cast<std::size_t>(std::upper_bound(length.begin(), length.end(), at) -
                                            length.begin()) -
                   1;
    const double t = (at - length[i]) / (length[i + 1] - length[i]);
    const Vec3 p = (1 - t) * g.position[hem[i]] + t * g.position[hem[(i + 1) % hem.size()]];
    z.emplace_back(p.z(), p.x());
  }
  if (shadow < 0)
    std::reverse(z.begin(), z.end());
  int folds = 0;
  const double wave = waviness(z, folds);
  std::vector<double> strain;
  for (const auto& s : garment::cloth_mesh_of(g).springs)
    strain.push_back((g.position[s.j] - g.position[s.i]).norm() / s.rest_length - 1);
  std::nth_element(strain.begin(),
                   strain.begin() + static_cast<long>(0.99 * static_cast<double>(strain.size())),
                   strain.end());
  std::string name = path.substr(path.rfind('/') + 1);
  name = name.substr(0, name.rfind('.'));
  std::printf("%s\t%.1f\t%.0f\t%.3f\t%.2f\t%d\t%.5f\t%s\n", name.c_str(), 100 * length.back(),
              1e4 * std::abs(shadow), turning(z), 1e3 * wave, folds,
              strain[static_cast<std::size_t>(0.99 * static_cast<double>(strain.size()))],
              g.converged ? "at rest" : "not at rest");
}

} // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 2)
      throw Error(ErrorKind::USAGE, "option.missing"_id, "", "", "no garment is given",
                  "measure-hem shirt.json...");
    std::printf("garment\tgirth_cm\tshadow_cm2\tturning\twaviness_mm\tfolds\tstrain_p99\tstate\n");
    for (int i = 1; i < argc; ++i)
      measure(argv[i]);
    return 0;
  } catch (const Error& e) {
    std::fprintf(stderr, "measure-hem: %s\n", e.what());
    return static_cast<int>(e.kind());
  }
}
