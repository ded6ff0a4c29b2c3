#pragma once
/// How long mesh edges are to be where: fine along some lines, growing away from them up to the
/// usual length.
#include <sloper/geometry/types.hpp>

#include <vector>

namespace sloper::pattern {

/// Wanted edge length, m, by place on a panel.
class SizeField {
public:
  static constexpr double GROWTH = 0.3; ///< m of edge length per m of distance

  /// The same length everywhere.
  explicit SizeField(double usual) : m_usual(usual), m_fine(usual) {}
  /// @param fine  m, on the lines; at most `usual`
  SizeField(double usual, double fine, std::vector<std::array<Vec2, 2>> lines)
      : m_usual(usual), m_fine(fine), m_lines(std::move(lines)) {}
  double usual() const { return m_usual; }
  double fine() const { return m_fine; }
  bool uniform() const { return m_lines.empty() || m_fine >= m_usual; }
  double at(const Vec2& p) const; ///< m. Cost: the number of lines
  bool operator==(const SizeField&) const = default;

private:
  double m_usual, m_fine;
  std::vector<std::array<Vec2, 2>> m_lines;
};

/// Fractions at which a stretch is cut whose edges may grow from `fine` at one end or both; empty
/// where one edge is enough.
std::vector<double> graded_fractions(double length, double usual, double fine, bool fine_start,
                                     bool fine_end);

} // namespace sloper::pattern
