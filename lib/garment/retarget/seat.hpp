#pragma once
/// Where on the body a garment that hangs from the waist is worn.
/// Test: tests/garment/retarget/test_seat.cpp
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>

#include <vector>

namespace sloper::garment {

/// Where the top edge of a skirt or of trousers is worn.
struct Seat {
  double below_m = 0; ///< under where it was placed, 0 to 0.1
  double short_share =
      0;                 ///< by how much the top edge does not close there, of the girth; 0: closes
  std::vector<int> edge; ///< particles of the top edge, in order; none for another class
};

/// The level at which a skirt or trousers are worn on a body: where they were placed if the top
/// edge closes there; else the first level below at which it closes unstretched, or else the
/// narrowest one. A wearer pulls it down to there; friction would hold it stretched above. The
/// rest of the garment hangs from that edge.
/// @param placed  bound to the body it comes from, its positions on `to`
/// @param source  #P by 3, m: where the particles were on the body it comes from. An edge that was
/// stretched there closes here as long as it was there.
Seat seat_of_waist(const Garment& placed, const std::vector<Vec3>& source, const body::Body& to);

} // namespace sloper::garment
