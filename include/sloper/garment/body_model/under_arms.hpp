#pragma once
/// Arms are outside of cloth that hangs on the trunk and the legs. A skirt from a body
/// that holds its arms wide, put on one whose hands are at the hips, would be placed into
/// the hands or around them, and one that is sewn around hanging arms would catch them;
/// it belongs between hand and hip. Test: tests/garment/body_model/test_under_arms.cpp
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>

namespace sloper::garment {

/// Forearms and hands of a body, of the arms whose shoulder, elbow and wrist were found.
class Forearms {
public:
  /// `body` outlives it.
  explicit Forearms(const body::Body& body);
  /// Whether the box around these points, m, overlaps that of a forearm with its hand.
  bool are_near(const std::vector<Vec3>& points) const;
  /// Whether a sleeve covers half of its forearm or more, by its length: wherever along the arm it
  /// lies before it is sewn.
  /// @param part ARM_L or ARM_R   @param sleeve points, m; none covers nothing
  bool is_covered(body::Part part, const std::vector<Vec3>& sleeve) const;
  /// From now on the forearm begins 2 cm beyond the end of this sleeve, which is sewn
  /// around the arm above.
  /// @param sleeve  points, m
  void leave_in(body::Part part, const std::vector<Vec3>& sleeve);
  /// The skin without them, drawn in to the elbows, or to where sleeves leave them. @param skin as
  /// many as the body's has, m
  std::vector<Vec3> drawn_in(std::vector<Vec3> skin) const;
  /// Triangles of the skin, for drawn_in().
  const std::vector<Triangle>& triangles() const { return m_triangles; }

private:
  struct Arm {
    body::Part part;
    Vec3 elbow, down;          // from there to the wrist, m
    double upper_length;       // m, of the upper arm
    double begins = 0;         // m beyond the elbow
    std::vector<int> vertices; // of the skin, beyond that
    Box3 box;
  };
  /// m of the forearm that a sleeve covers; negative: it ends above the elbow.
  static double length_on(const Arm& arm, const std::vector<Vec3>& sleeve);
  const std::vector<Vec3>& m_skin;
  std::vector<Arm> m_arms;
  std::vector<Triangle> m_triangles;
};

/// For each particle, whether it hangs on an arm and moves with it.
std::vector<char> hanging_on_arms(const Bind& bind);

/// Moves particles that lie in a forearm or hand, or beyond it as seen from the trunk and
/// legs, back along that line to before it. Costs nothing where the garment's box is
/// clear of forearms and hands.
/// @param positions  #P by 3, m, in and out: the garment around `body`
/// @param on_arms  #P: whether it stays
/// @param gap  m kept to the arm, less where there is no room
/// @return particles moved
std::size_t bring_under_arms(std::vector<Vec3>& positions, const std::vector<char>& on_arms,
                             const body::Body& body, double gap);

} // namespace sloper::garment
