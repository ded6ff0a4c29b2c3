#include <pattern/mesh/size_field.hpp>

#include <algorithm>
#include <cmath>

namespace sloper::pattern {

double SizeField::at(const Vec2& p) const {
  if (uniform())
    return m_usual;
  double least = std::pow((m_usual - m_fine) / GROWTH, 2); // nothing further away matters
  for (const auto& [a, b] : m_lines) {
    const Vec2 along = b - a;
    const double length = along.squaredNorm(),
                 t = length > 0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0.0;
    least = std::min(least, (p - a - t * along).squaredNorm());
  }
  return m_fine + GROWTH * std::sqrt(least);
}

std::vector<double> graded_fractions(double length, double usual, double fine, bool fine_start,
                                     bool fine_end) {
  constexpr int STEPS = 400;
  std::vector<double> count = {0}; // edges so far, if they could be cut anywhere
  for (int k = 0; k < STEPS; ++k) {
    const double s = length * (k + 0.5) / STEPS;
    double h = usual;
    if (fine_start)
      h = std::min(h, fine + SizeField::GROWTH * s);
    if (fine_end)
      h = std::min(h, fine + SizeField::GROWTH * (length - s));
    count.push_back(count.back() + length / STEPS / h);
  }
  const int n = std::max(1, static_cast<int>(std::lround(count.back())));
  std::vector<double> out;
  std::size_t at = 0;
  for (int k = 1; k < n; ++k) {
    const double wanted = count.back() * k / n;
    while (count[at + 1] < wanted)
      ++at;
    out.push_back((static_cast<double>(at) + (wanted - count[at]) / (count[at + 1] - count[at])) /
                  STEPS);
  }
  return out;
}

} // namespace sloper::pattern
