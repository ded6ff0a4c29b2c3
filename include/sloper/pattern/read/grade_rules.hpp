#pragma once
/// AAMA / ASTM D6673 grade rule tables (.rul): how far each graded point of a piece moves from the
/// sample size to another size.
#include <sloper/geometry/types.hpp>

#include <map>
#include <string>
#include <vector>

namespace sloper::pattern {

/// A grade rule table.
struct GradeRules {
  std::string table;              ///< name, or empty
  std::vector<std::string> sizes; ///< in the file's order
  int sample = 0;                 ///< index of the size that the DXF draws
  /// By rule number: m from the sample size, one for each size.
  std::map<int, std::vector<Vec2>> moves;

  int find_size(const std::string& name) const; ///< -1 when there is none
};

/// Reads the text of a .rul file: UNITS, SIZE LIST, SAMPLE SIZE, and for each RULE: DELTA n one x,y
/// pair per size, counted from the sample size, which itself does not move.
/// @throws Error INPUT naming the line
GradeRules parse_grade_rules(const std::string& text, const std::string& file);

/// Moves a ring by the rules of some of its vertices; vertices between two graded ones
/// follow in proportion to the distance along the ring. A ring with one graded vertex
/// moves as a whole.
/// @param ring  m, closed implicitly, in and out
/// @param rule  of each vertex; 0 where it has none
/// @param size  index into GradeRules::sizes
void grade_ring(std::vector<Vec2>& ring, const std::vector<int>& rule, const GradeRules& rules,
                int size);

} // namespace sloper::pattern
