#include <base/error.hpp>
#include <gtest/gtest.h>
#include <io/scan_reader.hpp>

#include <cstring>

using namespace sloper;
using namespace sloper::io;

namespace {

const std::string PLY_HEAD = "element vertex 4\nproperty float x\nproperty uchar red\nproperty float y\nproperty float z\n"
                             "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

std::string binary_ply() {
  std::string bytes = "ply\nformat binary_little_endian 1.0\n" + PLY_HEAD;
  auto put = [&](auto x) { bytes.append(reinterpret_cast<const char*>(&x), sizeof x); };
  for (int v = 0; v < 4; ++v) {
    put(static_cast<float>(v));
    put(static_cast<unsigned char>(9));
    put(static_cast<float>(10 * v));
    put(-1.5f);
  }
  put(static_cast<unsigned char>(4));
  for (int k = 0; k < 4; ++k) put(k);
  return bytes;
}

std::string complaint(const std::function<void()>& read) {
  try {
    read();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::INPUT);
    return e.what();
  }
  ADD_FAILURE() << "was read";
  return "";
}

} // namespace

TEST(ScanReader, ply_keeps_the_order_of_vertices_in_text_and_binary) {
  const std::string text = "ply\nformat ascii 1.0\n" + PLY_HEAD + "0 9 0 -1.5\n1 9 10 -1.5\n2 9 20 -1.5\n3 9 30 -1.5\n4 0 1 2 3\n";
  for (const std::string& bytes : {text, binary_ply()}) {
    const TriangleMesh mesh = parse_ply(bytes, "a.ply");
    ASSERT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.positions[2], Vec3(2, 20, -1.5));
    ASSERT_EQ(mesh.triangles.size(), 2u); // a quad is two triangles
    EXPECT_EQ(mesh.triangles[1], (Triangle{0, 2, 3}));
  }
}

TEST(ScanReader, a_truncated_ply_is_refused_with_place_and_reason) {
  const std::string bytes = binary_ply();
  for (const std::size_t n : {bytes.size() - 3, bytes.size() - 20, std::size_t(60), std::size_t(2)}) {
    const std::string what = complaint([&] { parse_ply(bytes.substr(0, n), "a.ply"); });
    EXPECT_NE(what.find("a.ply"), std::string::npos);
  }
}

TEST(ScanReader, a_ply_with_nan_or_an_index_out_of_range_is_refused) {
  EXPECT_NE(
      complaint([] { parse_ply("ply\nformat ascii 1.0\n" + PLY_HEAD + "0 9 nan -1.5\n1 9 10 0\n2 9 20 0\n3 9 30 0\n4 0 1 2 3\n", "a.ply"); }).find("finite"),
      std::string::npos);
  EXPECT_NE(
      complaint([] { parse_ply("ply\nformat ascii 1.0\n" + PLY_HEAD + "0 9 0 -1.5\n1 9 10 0\n2 9 20 0\n3 9 30 0\n3 0 1 7\n", "a.ply"); }).find("vertex 7"),
      std::string::npos);
}

TEST(ScanReader, a_header_that_promises_too_much_is_refused_before_memory_is_taken) {
  complaint([] { parse_ply("ply\nformat ascii 1.0\nelement vertex 99999999999999\nproperty float x\nend_header\n", "a.ply"); });
  std::string stl(84, '\0');
  const std::uint32_t many = 0xffffffffu;
  std::memcpy(stl.data() + 80, &many, 4);
  complaint([&] { parse_stl(stl, "a.stl"); });
}

TEST(ScanReader, stl_is_read_as_text_and_binary) {
  const std::string text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
  const TriangleMesh mesh = parse_stl(text, "a.stl");
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0));
  complaint([] { parse_stl("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0", "a.stl"); });
}

TEST(ScanReader, xyz_takes_comments_a_heading_and_more_columns) {
  const TriangleMesh mesh = parse_xyz("x y z r g b\n# note\n1 2 3 255 0 0\n4,5,6\n\n", "a.xyz");
  ASSERT_EQ(mesh.positions.size(), 2u);
  EXPECT_EQ(mesh.positions[1], Vec3(4, 5, 6));
  EXPECT_NE(complaint([] { parse_xyz("1 2 3\n4 5\n", "a.xyz"); }).find("line 2"), std::string::npos);
  complaint([] { parse_xyz("1 2 inf\n", "a.xyz"); });
}

TEST(ScanReader, a_missing_file_is_bad_input) {
  complaint([] { read_scan("no/such/scan.obj"); });
}
