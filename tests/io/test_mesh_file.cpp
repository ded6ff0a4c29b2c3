#include <sloper/base/error.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/mesh_file.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>

namespace sloper::io {

namespace {

constexpr const char* OBJ = "# a flag\r\n"
                            "mtllib flag.mtl\n"
                            "o flag\n"
                            "v 0 0 0 0.1 0.2 0.3\n"
                            "v 1.0 0 0\n"
                            "v 1 1 0\n"
                            "v 0 1 0\n"
                            "v 2 0 0 \\\n"
                            "\n"
                            "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                            "vn 0 0 1\n"
                            "usemtl red\n"
                            "g left\n"
                            "s 1\n"
                            "f 1/1/1 2/2/1 3/3/1 4/4/1\n"
                            "g right\n"
                            "f -4//-1 -1//-1 -3//-1 # a triangle";

std::vector<Vec3> shifted(const std::vector<Vec3>& points, const Vec3& by) {
  std::vector<Vec3> out;
  for (const Vec3& p : points)
    out.push_back(p + by);
  return out;
}

std::vector<Mat3> unturned(std::size_t n) {
  return std::vector<Mat3>(n, Mat3::Identity());
}

std::string refused(const std::string& bytes, const std::string& format) {
  try {
    parse_mesh_file(bytes, format, "file");
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

void put(std::string& out, float x) {
  out.append(reinterpret_cast<const char*>(&x), 4);
}

/// A GLB of one square that its node moves by (0, 1, 0) and scales by 2.
std::string square_glb(const std::string& node = "") {
  std::string binary;
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)})
    for (int k = 0; k < 3; ++k)
      put(binary, static_cast<float>(p[k]));
  for (int i = 0; i < 4; ++i) {
    put(binary, 0);
    put(binary, 0);
    put(binary, 1);
  }
  for (const std::uint16_t i : {0, 1, 2, 0, 2, 3})
    binary.append(reinterpret_cast<const char*>(&i), 2);
  std::string json =
      R"({"asset":{"version":"2.0"},"extras":{"note":"kept"},"scene":0,"scenes":[{"nodes":[0]}],)"
      R"("nodes":[{)" +
      node +
      R"("mesh":0,"translation":[0,1,0],"scale":[2,2,2]}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1},"indices":2}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},)"
      R"({"bufferView":1,"componentType":5126,"count":4,"type":"VEC3"},)"
      R"({"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":48},)"
      R"({"buffer":0,"byteOffset":96,"byteLength":12}],"buffers":[{"byteLength":108}]})";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string out = "glTF";
  const auto word = [&](std::size_t x) {
    const auto w = static_cast<std::uint32_t>(x);
    out.append(reinterpret_cast<const char*>(&w), 4);
  };
  word(2);
  word(12 + 8 + json.size() + 8 + binary.size());
  word(json.size());
  out += "JSON" + json;
  word(binary.size());
  out += std::string("BIN\0", 4) + binary;
  return out;
}

} // namespace

TEST(MeshFile, an_obj_keeps_its_polygons_texture_and_materials) {
  const MeshFile file = parse_mesh_file(OBJ, "obj", "flag.obj");
  EXPECT_EQ(file.positions.size(), 5u);
  ASSERT_EQ(file.faces.size(), 2u);
  EXPECT_EQ(file.faces[0], (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(file.faces[1], (std::vector<int>{1, 4, 2}));
  EXPECT_EQ(file.face_texture[0], (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(file.face_texture[1], (std::vector<int>{-1, -1, -1}));
  EXPECT_EQ(file.companions, std::vector<std::string>{"flag.mtl"});
}

TEST(MeshFile, a_moved_obj_differs_in_its_coordinates_alone) {
  const MeshFile file = parse_mesh_file(OBJ, "obj", "flag.obj");
  std::string expected = OBJ;
  const auto replace = [&](const std::string& from, const std::string& to) {
    expected.replace(expected.find(from), from.size(), to);
  };
  replace("v 0 0 0 0.1", "v 0 0 5 0.1");
  replace("v 1.0 0 0", "v 1 0 5");
  replace("v 1 1 0", "v 1 1 5");
  replace("v 0 1 0", "v 0 1 5");
  replace("v 2 0 0", "v 2 0 5");
  const std::string moved =
      moved_mesh_file(file, shifted(file.positions, Vec3(0, 0, 5)), unturned(5));
  // The one normal is of five vertices: each has one of its own, in the one's place.
  const std::size_t first = moved.find("vn "), end = moved.find("usemtl");
  const MeshFile again = parse_mesh_file(moved, "obj", "flag.obj");
  EXPECT_EQ(again.faces, file.faces);
  EXPECT_EQ(again.face_texture, file.face_texture);
  EXPECT_EQ(moved.substr(0, first), expected.substr(0, expected.find("vn ")));
  EXPECT_EQ(moved.substr(end, 20), expected.substr(expected.find("usemtl"), 20));
}

TEST(MeshFile, normals_turn_with_the_surface) {
  const MeshFile file = parse_mesh_file(OBJ, "obj", "flag.obj");
  std::vector<Mat3> turned = unturned(5);
  turned[4] = Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY()).toRotationMatrix();
  const std::string moved = moved_mesh_file(file, file.positions, turned);
  EXPECT_NE(moved.find("vn 1 0 "), std::string::npos) << moved;
  EXPECT_NE(moved.find("f 1/1/1 2/2/2 3/3/3 4/4/4"), std::string::npos) << moved;
}

TEST(MeshFile, an_obj_is_written_as_it_was_where_nothing_moved) {
  const std::string plain = "v 0 0 0\nv 1 0 0\nv 0.25 1 -3.5\nf 1 2 3\n";
  const MeshFile file = parse_mesh_file(plain, "obj", "t.obj");
  EXPECT_EQ(moved_mesh_file(file, file.positions, unturned(3)), plain);
}

TEST(MeshFile, a_binary_ply_of_either_order_keeps_what_it_does_not_know) {
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                        "_endian 1.0\ncomment kept\nelement vertex 4\nproperty float x\n"
                        "property float y\nproperty float z\nproperty uchar red\n"
                        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const auto put_swapped = [&](const void* data, std::size_t n) {
      std::string raw(static_cast<const char*>(data), n);
      if (big)
        raw = std::string(raw.rbegin(), raw.rend());
      bytes += raw;
    };
    for (int i = 0; i < 4; ++i) {
      for (const float x : {static_cast<float>(i % 2), static_cast<float>(i / 2), 0.0F})
        put_swapped(&x, 4);
      bytes += static_cast<char>(10 + i);
    }
    bytes += '\4';
    for (const std::int32_t v : {0, 1, 3, 2})
      put_swapped(&v, 4);
    const MeshFile file = parse_mesh_file(bytes, "ply", "q.ply");
    EXPECT_EQ(file.faces, (std::vector<std::vector<int>>{{0, 1, 3, 2}}));
    EXPECT_EQ(moved_mesh_file(file, file.positions, unturned(4)), bytes);
    const std::string moved =
        moved_mesh_file(file, shifted(file.positions, Vec3(1, 2, 3)), unturned(4));
    EXPECT_EQ(parse_mesh_file(moved, "ply", "q.ply").positions[3], Vec3(2, 3, 3));
    EXPECT_EQ(moved.size(), bytes.size());
  }
}

TEST(MeshFile, a_text_ply_with_texture_coordinates) {
  const std::string text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\n"
                           "property double y\nproperty double z\nproperty float s\n"
                           "property float t\nelement face 1\n"
                           "property list uchar int vertex_index\nend_header\n"
                           "0 0 0 0.5 0.25\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n";
  const MeshFile file = parse_mesh_file(text, "ply", "t.ply");
  EXPECT_EQ(file.texture[0], Vec2(0.5, 0.25));
  EXPECT_EQ(moved_mesh_file(file, file.positions, unturned(3)), text);
}

TEST(MeshFile, a_glb_is_read_where_its_nodes_put_it_and_goes_back) {
  const MeshFile file = parse_mesh_file(square_glb(), "glb", "q.glb");
  ASSERT_EQ(file.positions.size(), 4u);
  EXPECT_EQ(file.positions[2], Vec3(2, 3, 0));
  EXPECT_EQ(file.faces.size(), 2u);
  const Mat3 quarter = Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()).toRotationMatrix();
  const std::string moved =
      moved_mesh_file(file, shifted(file.positions, Vec3(0, 0, 4)), std::vector<Mat3>(4, quarter));
  const MeshFile again = parse_mesh_file(moved, "glb", "q.glb");
  EXPECT_EQ(again.positions[2], Vec3(2, 3, 4));
  EXPECT_EQ(again.faces, file.faces);
  EXPECT_NE(moved.find("\"note\":\"kept\""), std::string::npos);
  EXPECT_NE(moved.find("\"max\":[1.0,1.0,2.0]"), std::string::npos); // in the node's coordinates
  float normal[3];
  std::memcpy(normal, moved.data() + moved.size() - 12 - 48, 12);
  EXPECT_NEAR(normal[1], -1, 1e-6);
}

TEST(MeshFile, what_cannot_be_meant_is_refused_with_its_place) {
  EXPECT_NE(refused("v 0 0 0\nv 1 0 0\nf 1 2 3\n", "obj").find("line 3"), std::string::npos);
  EXPECT_NE(refused("v 0 0\n", "obj").find("a number is missing"), std::string::npos);
  EXPECT_NE(refused("v 0 0 nan\nf 1 1 1\n", "obj").find("not finite"), std::string::npos);
  EXPECT_NE(refused("v 0 0 0\n", "obj").find("has no faces"), std::string::npos);
  EXPECT_NE(
      refused("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nend_header\n", "ply")
          .find("no x, y and z"),
      std::string::npos);
  std::string glb = square_glb();
  EXPECT_NE(refused(glb.substr(0, glb.size() - 4), "glb").find("truncated"), std::string::npos);
  const auto broken = [&](const std::string& from, const std::string& to) {
    std::string bytes = glb;
    bytes.replace(bytes.find(from), from.size(), to);
    return refused(bytes, "glb");
  };
  EXPECT_NE(broken("\"count\":6", "\"count\":9").find("beyond the binary chunk"),
            std::string::npos);
  EXPECT_NE(refused(square_glb(R"("skin":0,)"), "glb").find("skeleton"), std::string::npos);
  EXPECT_NE(broken("\"version\":\"2.0\"", "\"version\":\"2.0"), std::string());
}

/// The same file with one text of the JSON replaced by one as long.
std::string with_text(std::string glb, const std::string& from, const std::string& to) {
  const std::size_t at = glb.find(from);
  EXPECT_NE(at, std::string::npos);
  EXPECT_EQ(from.size(), to.size());
  return glb.replace(at, from.size(), to);
}

TEST(MeshFile, indices_of_a_glb_are_unsigned_whole_numbers) {
  const std::string index = R"("componentType":5123)";
  const auto with_type = [&](const char* type) {
    return refused(with_text(square_glb(), index, type), "glb");
  };
  EXPECT_NE(with_type(R"("componentType":5122)").find("unsigned whole numbers"), std::string::npos);
  EXPECT_NE(with_type(R"("componentType":5126)"), ""); // as many floats do not fit
  EXPECT_NE(with_type(R"("componentType":5199)").find("no component type"), std::string::npos);
}

TEST(MeshFile, meshes_of_a_glb_that_share_vertices_stand_in_one_place) {
  const std::string nodes = R"("scale":[2,2,2]}],"meshes":[{)";
  const std::string twice = R"("scale":[2,2,2]},{"mesh":1}],"meshes":[{"primitives":[)"
                            R"({"attributes":{"POSITION":0},"indices":2}]},{)";
  std::string glb = square_glb();
  glb = with_text(glb, R"("nodes":[0])", R"("nodes":[ ])");
  EXPECT_NE(refused(glb, "glb"), "");
  const std::string json = glb.substr(20, glb.find("BIN") - 24);
  std::string changed = json;
  changed.replace(changed.find(nodes), nodes.size(), twice);
  changed.replace(changed.find("\"nodes\":[ ]"), 11, "\"nodes\":[0,1]");
  changed.resize((changed.size() + 3) / 4 * 4, ' ');
  const auto size = static_cast<std::uint32_t>(changed.size());
  std::string out = glb.substr(0, 12);
  out.append(reinterpret_cast<const char*>(&size), 4);
  out += "JSON" + changed + glb.substr(20 + json.size());
  EXPECT_NE(refused(out, "glb").find("shares its vertices"), std::string::npos)
      << refused(out, "glb");
}

TEST(MeshFile, normals_of_a_ply_that_are_whole_numbers_stay_as_they_are) {
  const std::string text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                           "property float y\nproperty float z\nproperty char nx\n"
                           "property char ny\nproperty char nz\nelement face 1\n"
                           "property list uchar int vertex_index\nend_header\n"
                           "0 0 0 0 0 127\n1 0 0 0 0 127\n1 1 0 0 0 127\n3 0 1 2\n";
  const MeshFile file = parse_mesh_file(text, "ply", "flag.ply");
  const Mat3 turn = Eigen::AngleAxisd(1, Vec3::UnitX()).toRotationMatrix();
  EXPECT_EQ(moved_mesh_file(file, file.positions, std::vector<Mat3>(3, turn)), text);
}

TEST(MeshFile, a_ply_whose_vertices_stand_in_two_lists_has_texture_for_all_or_none) {
  const MeshFile file = parse_mesh_file(
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nproperty float s\nproperty float t\nelement vertex 1\n"
      "property float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_index\nend_header\n"
      "0 0 0 0 0\n1 0 0 1 0\n1 1 0\n3 0 1 2\n",
      "ply", "flag.ply");
  EXPECT_TRUE(file.texture.empty());
  EXPECT_TRUE(file.face_texture.empty());
}

} // namespace sloper::io
