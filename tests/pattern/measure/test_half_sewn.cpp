/// Sleeves, sides and bands that are sewn by half, and openings that are meant.
#include <support/straight_patterns.hpp>

#include <gtest/gtest.h>
#include <sloper/pattern/measure/finished_measures.hpp>
#include <sloper/pattern/measure/half_sewn.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>

namespace sloper::pattern::test {
namespace {

constexpr double EDGE = 0.03; // m

/// A shirt with sleeves of two pieces and slits at the sides. Front and back are drawn alike: a is
/// to the right of the drawing, b to the left.
class Shirt {
public:
  /// @param tip_cm  by which the back pieces of the sleeves go on beyond the seam over the arm
  explicit Shirt(double tip_cm = 0) {
    const std::vector<DrawnEdge> body = {
        {"hem", 25, -60},        {"slit_a", 25, -45},   {"side_a", 25, 0}, {"pit_a", 18, 1},
        {"hole_a", 18, 22},      {"shoulder_a", 7, 25}, {"neck_a", 0, 10}, {"neck_b", -7, 25},
        {"shoulder_b", -18, 22}, {"hole_b", -18, 1},    {"pit_b", -25, 0}, {"side_b", -25, -45},
        {"slit_b", -25, -60}};
    m_drawn.panel("front", body);
    m_drawn.panel("back", body);
    const std::vector<DrawnEdge> sleeve = {
        {"wrist", 16, -20}, {"middle", 16, 21}, {"cap", 7, 2}, {"pit", 0, 0}, {"under", 0, -20}};
    m_drawn.panel("front_sleeve_a", sleeve);
    std::vector<DrawnEdge> behind = sleeve;
    if (tip_cm > 0)
      behind.insert(behind.begin() + 2, {"tip", 16, 21 + tip_cm});
    m_drawn.panel("back_sleeve_b", seen_in_mirror(behind));
    m_drawn.panel("front_sleeve_b", seen_in_mirror(sleeve));
    m_drawn.panel("back_sleeve_a", behind);
    for (const std::string side : {"a", "b"}) {
      const std::string other = side == "a" ? "b" : "a", own_sleeve = "front_sleeve_" + side,
                        back_sleeve = "back_sleeve_" + other;
      m_drawn.seam("front", "side_" + side, "back", "side_" + other);
      m_drawn.seam("front", "shoulder_" + side, "back", "shoulder_" + other);
      m_drawn.seam("front", "hole_" + side, own_sleeve, "cap");
      m_drawn.seam("front", "pit_" + side, own_sleeve, "pit");
      m_drawn.seam("back", "hole_" + other, back_sleeve, "cap");
      m_drawn.seam("back", "pit_" + other, back_sleeve, "pit");
      m_drawn.seam(own_sleeve, "middle", back_sleeve, "middle");
      m_drawn.seam(own_sleeve, "under", back_sleeve, "under");
    }
  }
  /// A band around the neck, open at the front.
  Shirt& band(const std::string& name) {
    m_drawn.panel(name, {{"low_a", 16, 0},
                         {"low_back_b", 32, 0},
                         {"low_back_a", 48, 0},
                         {"low_b", 64, 0},
                         {"end_b", 64, 5},
                         {"top", 0, 5},
                         {"end_a", 0, 0}});
    m_drawn.seam(name, "low_a", "front", "neck_a");
    m_drawn.seam(name, "low_back_b", "back", "neck_b");
    m_drawn.seam(name, "low_back_a", "back", "neck_a");
    m_drawn.seam(name, "low_b", "front", "neck_b");
    return *this;
  }
  /// @param left_out  edges, as "back: hole_a", whose seams are left out
  std::string findings(const std::vector<std::string>& left_out) const {
    Pattern pattern = m_drawn.pattern();
    std::erase_if(pattern.seams, [&](const Seam& s) {
      return std::any_of(left_out.begin(), left_out.end(), [&](const std::string& edge) {
        return place_of(pattern, s.a[0]) == edge || place_of(pattern, s.b[0]) == edge;
      });
    });
    std::string all;
    for (const PatternFinding& f : half_sewn(pattern, mesh_pattern(pattern, EDGE, "t")))
      all += f.severity + ": " + f.rule + ": " + f.place + ": " + f.fact + "\n";
    return all;
  }

private:
  DrawnPattern m_drawn;
};

TEST(HalfSewn, NecksSlitsAndWristsOfAWholeShirtAreMeant) {
  EXPECT_EQ(Shirt().findings({}), "");
}

TEST(HalfSewn, BothSleevesThatAreSewnToTheFrontAloneAreToldWithCentimetres) {
  const std::string said =
      Shirt().findings({"back: hole_a", "back: hole_b", "back: pit_a", "back: pit_b",
                        "front_sleeve_a: middle", "front_sleeve_b: middle"});
  EXPECT_NE(said.find("error: half-sewn: back: pit_b: is open over 7.07 cm and back_sleeve_b: "
                      "pit over 7.28 cm"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("back: pit_a"), std::string::npos) << said;
}

TEST(HalfSewn, BothSidesAndBothUnderarmsAreTold) {
  EXPECT_NE(Shirt().findings({"front: side_a", "front: side_b"}).find("side_a"), std::string::npos);
  EXPECT_NE(Shirt()
                .findings({"front_sleeve_a: under", "front_sleeve_b: under"})
                .find("front_sleeve_a: under"),
            std::string::npos);
}

TEST(HalfSewn, ARimOfTheTrunkAndOneSleeveIsToldForEachArm) {
  const std::string said =
      Shirt().findings({"front: hole_a", "front: pit_a", "front: hole_b", "front: pit_b"});
  for (const char* sleeve : {"front_sleeve_a: cap", "front_sleeve_b: cap"})
    EXPECT_NE(said.find(std::string("half-sewn: ") + sleeve +
                        ": is open on a rim of 56.37 cm that goes through the trunk and one "
                        "sleeve"),
              std::string::npos)
        << said;
}

TEST(HalfSewn, AnEndOfACapThatIsSewnToNothingIsToldBesideTheWrist) {
  const std::string said = Shirt(12).findings({});
  for (const char* sleeve : {"back_sleeve_a: tip", "back_sleeve_b: tip"})
    EXPECT_NE(said.find(std::string("half-sewn: ") + sleeve +
                        ": is open on a rim of 12.00 cm beside that of the wrist, 32.00 cm"),
              std::string::npos)
        << said;
}

TEST(HalfSewn, ACollarHasEndsAndABandIsAskedForThem) {
  EXPECT_EQ(Shirt().band("collar").findings({}), "");
  EXPECT_NE(Shirt().band("binding").findings({}).find("binding: end_"), std::string::npos);
}

TEST(HalfSewn, ItIsAmongWhatIsMeasuredWithoutABody) {
  EXPECT_TRUE(finished_measures(own(tube_text()), "t").half_sewn.empty());
}

} // namespace
} // namespace sloper::pattern::test
