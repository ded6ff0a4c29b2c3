#pragma once
/// A triangulation of a polygon under change: points inserted, edges flipped, interior points
/// moved. Used by triangulate().
#include <pattern/mesh/size_field.hpp>
#include <sloper/geometry/types.hpp>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace sloper::pattern {

/// The triangulation of one panel while it is refined.
class FlatDelaunay {
public:
  /// Constrained Delaunay triangulation of the loops. @throws Error INPUT when they cross
  FlatDelaunay(const std::vector<std::vector<Vec2>>& loops, const std::string& panel);
  int n_boundary() const { return m_n_boundary; }
  /// The vertex that stands for p from then on; -1 when p is not inside. A pinned point stays where
  /// it is; where it meets a vertex, or an edge of a line, that vertex or one on that edge is
  /// taken.
  int insert(const Vec2& p, bool pinned = false);
  /// Points of a line, pinned, and the edges between them, kept: boundary points are used where
  /// they are met. A stretch that cannot be had as an edge is halved, at last left out.
  void add_line(const std::vector<Vec2>& points);
  /// Splits interior edges whose ends are both on the boundary; ears of corners under 50 degrees
  /// stay unless must_split.
  void split_chords(const std::vector<char>& must_split);
  void smooth(); ///< one round: interior points to the area-weighted mean of their circumcentres,
                 ///< then flips
  void fix_density(const SizeField& size); ///< points too close to others are taken out, edges too
                                           ///< long are halved
  bool improve_worst(double good_angle);   ///< one round of local search where an angle is below;
                                           ///< false when there is nothing (more) to gain
  void take(std::vector<Vec2>& points, std::vector<Triangle>& triangles);

private:
  struct Face {
    int v[3];    ///< corners, counter-clockwise
    int next[3]; ///< neighbour across the edge opposite v[k], -1 on the boundary
    bool alive = true;
  };
  int locate(const Vec2& p) const;
  int index_in(int face, int vertex) const;
  void link(int face, int k, int other, int other_k);
  void split_face(int face, int vertex);
  void split_edge(int face, int k, int vertex);
  bool flip(int face, int k);
  bool wants_flip(int face, int k) const;
  bool connected(int a, int b) const;
  bool is_kept(int a, int b) const {
    return !m_kept.empty() && m_kept.count({std::min(a, b), std::max(a, b)}) != 0;
  }
  void keep(int a, int b, int depth);
  void legalize(std::vector<std::pair<int, int>>& stack);
  void legalize_all();
  bool on_boundary(int vertex) const { return vertex < m_n_boundary; }
  bool is_chord(int a, int b) const { return a < m_n_boundary && b < m_n_boundary; }
  void star(int vertex, std::vector<int>& faces) const;
  double star_quality(const std::vector<int>& faces, int vertex, const Vec2& at) const;
  bool remove(int vertex);
  int add_point(const Vec2& p);
  bool keeps_ear(int face, int k, const std::vector<char>& must_split) const;

  std::vector<Vec2> m_points;
  std::vector<char> m_dead; ///< points taken out
  std::vector<char> m_pinned;
  std::vector<Face> m_faces;
  std::set<std::pair<int, int>> m_kept; ///< edges of lines, never flipped; lower end first
  std::vector<int> m_face_of;           ///< some face of each point
  int m_n_boundary = 0;
  mutable int m_last = 0;
};

} // namespace sloper::pattern
