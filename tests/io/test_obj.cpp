#include <support/has.hpp>
#include <support/scratch_folder.hpp>

#include <sloper/base/error.hpp>
#include <sloper/io/obj.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace sloper;
using namespace sloper::test;

static std::string obj_complaint(const std::string& text) {
  try {
    io::parse_obj(text, "a.obj");
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::INPUT);
    EXPECT_EQ(e.file(), "a.obj");
    return e.what();
  }
  return {};
}

TEST(Obj, keeps_the_order_and_count_of_vertices_also_of_those_that_no_face_names) {
  const io::ObjMesh mesh = io::parse_obj("v 3 0 0\nv 1 0 0\nv 1 0 0\nv 0 2 0\nf 4 1 2\n", "a.obj");
  ASSERT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.positions[0], Vec3(3, 0, 0));
  EXPECT_EQ(mesh.positions[3], Vec3(0, 2, 0));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{3, 0, 1}}));
  EXPECT_TRUE(mesh.texture_triangles.empty());
}

TEST(Obj, keeps_positions_and_pattern_coordinates_apart) {
  const io::ObjMesh mesh = io::parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 0.25\nvt 0 1\nvt 1 1 "
                                         "0\nf 1/3 2/1/1 3/2\nf 1 2 3\nf 1//1 2//1 3//1\n",
                                         "a.obj");
  ASSERT_EQ(mesh.texture.size(), 3u);
  EXPECT_EQ(mesh.texture[0], Vec2(0.5, 0.25));
  EXPECT_EQ(mesh.texture_triangles, (std::vector<Triangle>{{2, 0, 1}, {-1, -1, -1}, {-1, -1, -1}}));
}

TEST(Obj, counts_negative_indices_back_from_the_line_they_stand_on) {
  const io::ObjMesh mesh =
      io::parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -1 -2 1\n", "a.obj");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 2, 0}}));
}

TEST(Obj, names_the_line_of_a_bad_index) {
  EXPECT_TRUE(has(obj_complaint("v 0 0 0\nv 1 0 0\nv 0 1 0\n# remark\nf 1 2 4\n"), "line 5"));
  for (const char* face : {"f 1 2 0", "f 1 2 -4", "f 1 2 99999999999999999999", "f 1 2 x",
                           "f 1 2 3.5", "f 1 2", "f", "f 1/1 2/1 3/1", "f 1/ 2 /3"})
    EXPECT_TRUE(
        has(obj_complaint(std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\n") + face + "\n"), "line 4"))
        << face;
}

TEST(Obj, refuses_coordinates_that_are_no_finite_numbers) {
  for (const char* line : {"v nan 0 0", "v 0 inf 0", "v 0 0 -inf", "v 1e400 0 0", "v 0 0", "v",
                           "v 1,5 0 0", "v 0x10 0 0", "v a b c", "vt nan 0"})
    EXPECT_TRUE(has(obj_complaint(std::string("# first\n") + line + "\n"), "line 2")) << line;
}

TEST(Obj, refuses_binary_bytes) {
  EXPECT_TRUE(has(obj_complaint(std::string("v 0 0 0\n\x7f"
                                            "ELF\0\1\2",
                                            15)),
                  "line 2"));
}

TEST(Obj, reads_windows_line_ends_tabs_byte_order_mark_and_a_last_line_without_end) {
  const io::ObjMesh mesh =
      io::parse_obj("\xEF\xBB\xBFv 0 0 0\r\nv\t1  0 +0\r\nv 0 1 0 \r\n\r\nf 1 2 3", "a.obj");
  EXPECT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(Obj, cuts_polygons_into_fans_and_keeps_groups_as_runs) {
  const io::ObjMesh mesh = io::parse_obj(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng a\ng b\nf 1 2 3 4\no c\nf 1 2 3\n", "a.obj");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
  ASSERT_EQ(mesh.groups.size(), 2u);
  EXPECT_EQ(mesh.groups[0].name, "b");
  EXPECT_EQ(mesh.groups[0].first_triangle, 0);
  EXPECT_EQ(mesh.groups[1].name, "c");
  EXPECT_EQ(mesh.groups[1].first_triangle, 2);
}

TEST(Obj, reads_colours_and_unknown_keywords_past) {
  EXPECT_EQ(io::parse_obj("mtllib a.mtl\nv 0 0 0 0.1 0.2 0.3\nvn 0 0 1\ns off\nusemtl m\n", "a.obj")
                .positions.size(),
            1u);
}

TEST(Obj, comes_back_bit_for_bit_and_writes_the_same_bytes) {
  io::ObjMesh mesh;
  mesh.positions = {{0.1, 1.0 / 3, 1e-17}, {-0.0, 2, 3e5}, {7, 8, 9}};
  mesh.texture = {{0.1, 0.2}, {0.3, 0.7}, {1, 1}, {0, 0}};
  mesh.triangles = {{0, 1, 2}, {2, 1, 0}};
  mesh.texture_triangles = {{3, 1, 0}, {0, 1, 2}};
  mesh.groups = {{"front", 0}, {"back", 1}};
  const std::string text = io::obj_text(mesh, "drape");
  const io::ObjMesh again = io::parse_obj(text, "a.obj");
  EXPECT_EQ(again.positions, mesh.positions);
  EXPECT_EQ(again.texture, mesh.texture);
  EXPECT_EQ(again.triangles, mesh.triangles);
  EXPECT_EQ(again.texture_triangles, mesh.texture_triangles);
  EXPECT_EQ(io::obj_text(again, "drape"), text);
}

TEST(Obj, is_never_written_with_a_number_that_is_not_finite) {
  const ScratchFolder folder;
  put(folder / "x.obj", "old");
  io::ObjMesh mesh;
  mesh.positions = {{0, std::nan(""), 0}};
  try {
    io::write_obj(folder / "x.obj", mesh, "drape");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::INTERNAL);
  }
  EXPECT_EQ(get(folder / "x.obj"), "old");
}

TEST(Obj, a_copy_that_ends_within_a_line_is_told_from_a_line_that_is_wrong) {
  const auto next_step = [](const std::string& text) -> std::string {
    try {
      io::parse_obj(text, "x.obj", true);
      return "no error";
    } catch (const Error& e) {
      return e.what();
    }
  };
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_NE(next_step(points + "f 1 2").find("ends within this line"), std::string::npos);
  EXPECT_NE(next_step(points + "v 1 0").find("ends within this line"), std::string::npos);
  EXPECT_EQ(next_step(points + "f 1 2\n").find("ends within this line"), std::string::npos);
  EXPECT_NE(next_step(points + "f 1 2\n").find("export the mesh again"), std::string::npos);
}
