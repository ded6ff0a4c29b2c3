#include <gtest/gtest.h>
#include <sloper/geometry/polygon.hpp>

namespace sloper::test {
namespace {

TEST(Polygon, ItsAreaDoesNotDependOnTheDirectionInWhichItRuns) {
  const std::vector<Vec2> points = {{9, 9}, {1, 1}, {4, 1}, {4, 3}, {2, 3}, {1, 2}};
  EXPECT_DOUBLE_EQ(polygon_area(points, {1, 2, 3, 4, 5}), 5.5);
  EXPECT_DOUBLE_EQ(polygon_area(points, {5, 4, 3, 2, 1}), 5.5);
  EXPECT_EQ(polygon_area(points, {1, 2}), 0);
  EXPECT_EQ(polygon_area(points, {}), 0);
}

} // namespace
} // namespace sloper::test
