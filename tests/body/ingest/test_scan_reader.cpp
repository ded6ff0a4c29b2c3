#include <gtest/gtest.h>
#include <io/pcd.hpp>
#include <sloper/base/error.hpp>
#include <sloper/io/obj.hpp>
#include <sloper/io/scan_reader.hpp>
#include <support/scratch_folder.hpp>

#include <cstdio>
#include <cstring>
#include <fstream>

using namespace sloper;
using namespace sloper::io;

namespace {

const std::string PLY_HEAD =
    "element vertex 4\nproperty float x\nproperty uchar red\nproperty float y\nproperty float z\n"
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
  for (int k = 0; k < 4; ++k)
    put(k);
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
  const std::string text = "ply\nformat ascii 1.0\n" + PLY_HEAD +
                           "0 9 0 -1.5\n1 9 10 -1.5\n2 9 20 -1.5\n3 9 30 -1.5\n4 0 1 2 3\n";
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
  for (const std::size_t n :
       {bytes.size() - 3, bytes.size() - 20, std::size_t(60), std::size_t(2)}) {
    const std::string what = complaint([&] { parse_ply(bytes.substr(0, n), "a.ply"); });
    EXPECT_NE(what.find("a.ply"), std::string::npos);
  }
}

TEST(ScanReader, a_ply_with_nan_or_an_index_out_of_range_is_refused) {
  EXPECT_NE(complaint([] {
              parse_ply("ply\nformat ascii 1.0\n" + PLY_HEAD +
                            "0 9 nan -1.5\n1 9 10 0\n2 9 20 0\n3 9 30 0\n4 0 1 2 3\n",
                        "a.ply");
            }).find("finite"),
            std::string::npos);
  EXPECT_NE(complaint([] {
              parse_ply("ply\nformat ascii 1.0\n" + PLY_HEAD +
                            "0 9 0 -1.5\n1 9 10 0\n2 9 20 0\n3 9 30 0\n3 0 1 7\n",
                        "a.ply");
            }).find("vertex 7"),
            std::string::npos);
}

TEST(ScanReader, a_header_that_promises_too_much_is_refused_before_memory_is_taken) {
  complaint([] {
    parse_ply(
        "ply\nformat ascii 1.0\nelement vertex 99999999999999\nproperty float x\nend_header\n",
        "a.ply");
  });
  std::string stl(84, '\0');
  const std::uint32_t many = 0xffffffffu;
  std::memcpy(stl.data() + 80, &many, 4);
  complaint([&] { parse_stl(stl, "a.stl"); });
}

TEST(ScanReader, an_obj_is_read_whose_faces_name_texture_and_normals_that_it_lacks) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1/1 2/2/2 3/3/3\n";
  EXPECT_EQ(parse_obj(text, "a.obj", false).triangles.size(), 1u);
  complaint([&] { parse_obj(text, "a.obj"); }); // one of our own must be whole
  complaint([] { parse_obj("v 0 0 0\nf 1/1/1 2/2/2 3/3/3\n", "a.obj", false); });
}

TEST(ScanReader, stl_is_read_as_text_and_binary) {
  const std::string text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 "
                           "0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
  const TriangleMesh mesh = parse_stl(text, "a.stl");
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0));
  complaint([] {
    parse_stl("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0", "a.stl");
  });
}

TEST(ScanReader, xyz_takes_comments_a_heading_and_more_columns) {
  const TriangleMesh mesh = parse_xyz("x y z r g b\n# note\n1 2 3 255 0 0\n4,5,6\n\n", "a.xyz");
  ASSERT_EQ(mesh.positions.size(), 2u);
  EXPECT_EQ(mesh.positions[1], Vec3(4, 5, 6));
  EXPECT_NE(complaint([] { parse_xyz("1 2 3\n4 5\n", "a.xyz"); }).find("line 2"),
            std::string::npos);
  complaint([] { parse_xyz("1 2 inf\n", "a.xyz"); });
}

namespace {

std::string chunk(std::uint16_t kind, const std::string& inside) {
  const std::uint32_t length = static_cast<std::uint32_t>(inside.size()) + 6;
  std::string bytes(6, '\0');
  std::memcpy(bytes.data(), &kind, 2);
  std::memcpy(bytes.data() + 2, &length, 4);
  return bytes + inside;
}

template<class T> std::string raw(std::initializer_list<T> values) {
  return std::string(reinterpret_cast<const char*>(values.begin()), values.size() * sizeof(T));
}

/// One triangle at x..x+2, its corners in the order 2, 0, 1; behind it lie two vertices that no
/// face names.
std::string triangle_3ds(float x, std::uint16_t corner = 2) {
  const std::string vertices =
      raw<std::uint16_t>({5}) + raw<float>({x, 0, 0, x + 1, 0, 7, x + 2, 3, 0, 9, 9, 9, 8, 8, 8});
  return chunk(0x4000,
               std::string("part\0", 5) +
                   chunk(0x4100, chunk(0x4110, vertices) +
                                     chunk(0x4120, raw<std::uint16_t>({1, corner, 0, 1, 7}))));
}

} // namespace

TEST(ScanReader, a_3ds_keeps_the_vertices_of_all_its_meshes_in_order_count_and_place) {
  const std::string file = chunk(0x4D4D, chunk(0x0002, raw<std::uint32_t>({3})) +
                                             chunk(0x3D3D, triangle_3ds(100) + triangle_3ds(200)));
  const TriangleMesh mesh = parse_3ds(file, "a.3ds");
  ASSERT_EQ(mesh.positions.size(), 10u);
  EXPECT_EQ(mesh.positions[1], Vec3(101, 0, 7));
  EXPECT_EQ(mesh.positions[5], Vec3(200, 0, 0));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[1], (Triangle{7, 5, 6}));
}

/// A file that is gone with the test.
class Beside {
public:
  Beside(const std::string& name, const std::string& bytes) : path(testing::TempDir() + name) {
    std::ofstream(path, std::ios::binary) << bytes;
  }
  ~Beside() { std::remove(path.c_str()); }
  const std::string path;
};

TEST(ScanReader, other_formats_come_through_assimp_without_holes_at_seams) {
  const Beside off("quad.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n3 0 1 2\n3 0 2 3\n");
  const Scan scan = read_scan(off.path);
  EXPECT_EQ(scan.format, "off");
  ASSERT_EQ(scan.mesh.positions.size(), 4u);
  EXPECT_EQ(scan.mesh.triangles.size(), 2u);
  EXPECT_EQ(scan.mesh.positions[3], Vec3(0, 1, 0.5));
  // two triangles of a glTF that share places, not vertices; the node moves them 2 up
  const float corners[18] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0};
  const std::string bytes(reinterpret_cast<const char*>(corners), sizeof corners);
  const Beside buffer("split.bin", bytes);
  const Beside gltf(
      "split.gltf",
      R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "translation": [0, 2, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "buffers": [{"uri": "split.bin", "byteLength": 72}],
    "bufferViews": [{"buffer": 0, "byteLength": 72}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}]})");
  const TriangleMesh split = read_scan(gltf.path).mesh;
  EXPECT_EQ(split.positions.size(), 4u);
  EXPECT_EQ(split.triangles.size(), 2u);
  for (const Vec3& p : split.positions)
    EXPECT_GE(p.y(), 2);
}

TEST(ScanReader, what_assimp_cannot_read_is_refused_with_what_to_do) {
  for (const char* name : {"bad.glb", "bad.gltf", "bad.fbx", "bad.dae", "bad.off"}) {
    const Beside bad(name, "glTF{ no such thing <COLLADA");
    EXPECT_NE(complaint([&] { read_scan(bad.path); }).find("export it as OBJ or PLY"),
              std::string::npos)
        << name;
  }
}

TEST(ScanReader, a_broken_3ds_is_refused) {
  const std::string file = chunk(0x4D4D, chunk(0x3D3D, triangle_3ds(1)));
  EXPECT_NE(
      complaint([&] { parse_3ds(file.substr(0, file.size() - 9), "a.3ds"); }).find("truncated"),
      std::string::npos);
  EXPECT_NE(complaint([&] {
              parse_3ds(chunk(0x4D4D, chunk(0x3D3D, triangle_3ds(1, 5))), "a.3ds");
            }).find("vertex 5"),
            std::string::npos);
  EXPECT_NE(complaint([&] {
              parse_3ds(chunk(0x4D4D, chunk(0x3D3D, triangle_3ds(std::nanf("")))), "a.3ds");
            }).find("finite"),
            std::string::npos);
  EXPECT_NE(complaint([] { parse_3ds("v 0 0 0\nv 1 0 0\n", "a.3ds"); }).find("3DS"),
            std::string::npos);
  std::string nested;
  for (int k = 0; k < 2000; ++k)
    nested = chunk(0x4D4D, nested);
  complaint([&] { parse_3ds(nested, "a.3ds"); });
}

namespace {

std::string pcd_head(int points, const std::string& data) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 "
         "4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
         std::to_string(points) + "\nDATA " + data + "\n";
}

/// The same as LZF holds it that found nothing to shorten but a run of eight zero bytes.
std::string lzf_with_a_run(const std::string& plain, std::size_t run_at) {
  auto literal = [](const std::string& bytes) {
    std::string out;
    for (std::size_t at = 0; at < bytes.size(); at += 32) {
      const std::string part = bytes.substr(at, 32);
      out += static_cast<char>(part.size() - 1) + part;
    }
    return out;
  };
  // a zero byte, then seven more from one byte back
  return literal(plain.substr(0, run_at + 1)) + std::string("\xa0\x00", 2) +
         literal(plain.substr(run_at + 8));
}

} // namespace

TEST(ScanReader, pcd_is_read_as_text_binary_and_compressed) {
  const float nothing = std::nanf("");
  const TriangleMesh text =
      parse_pcd(pcd_head(3, "ascii") + "1 2 3 7\nnan nan nan 0\n-4 5.5 6e-1 8\n", "a.pcd");
  ASSERT_EQ(text.positions.size(), 2u); // an organised cloud has places where nothing was seen
  EXPECT_EQ(text.positions[1], Vec3(-4, 5.5, 0.6));
  const std::string points =
      raw<float>({1, 2, 3, 7}) + raw<float>({nothing, 0, 0, 0}) + raw<float>({-4, 5.5f, 0.5f, 8});
  const TriangleMesh binary = parse_pcd(pcd_head(3, "binary") + points, "a.pcd");
  ASSERT_EQ(binary.positions.size(), 2u);
  EXPECT_EQ(binary.positions[1], Vec3(-4, 5.5, 0.5));
  // all x, then all y, all z and all colours, which are eight zero bytes
  const std::string by_field = raw<float>({1, -4, 2, 5.5f, 3, 0.5f}) + raw<float>({0, 0});
  const std::string packed = lzf_with_a_run(by_field, 24);
  const std::string sizes = raw<std::uint32_t>(
      {static_cast<std::uint32_t>(packed.size()), static_cast<std::uint32_t>(by_field.size())});
  const std::string file = pcd_head(2, "binary_compressed") + sizes + packed;
  const TriangleMesh compressed = parse_pcd(file, "a.pcd");
  ASSERT_EQ(compressed.positions.size(), 2u);
  EXPECT_EQ(compressed.positions[1], Vec3(-4, 5.5, 0.5));
}

TEST(ScanReader, a_broken_pcd_is_refused_with_place_and_reason) {
  const std::string points = raw<float>({1, 2, 3, 7, -4, 5.5f, 0.5f, 8});
  auto message_of = [](const std::string& bytes) {
    return complaint([&] { parse_pcd(bytes, "a.pcd"); });
  };
  EXPECT_NE(message_of(pcd_head(3, "binary") + points).find("truncated"), std::string::npos);
  EXPECT_NE(message_of(pcd_head(2, "ascii") + "1 2 3 7\n").find("ends early"), std::string::npos);
  EXPECT_NE(message_of(pcd_head(1, "ascii") + "1 2 x 7\n").find("line 12"), std::string::npos);
  EXPECT_NE(message_of(pcd_head(1, "zipped")).find("binary_compressed is read"), std::string::npos);
  EXPECT_NE(message_of("VERSION 0.7\nFIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA ascii\n1 2\n")
                .find("no x, y and z"),
            std::string::npos);
  const std::string lies = pcd_head(2, "binary_compressed");
  message_of(lies + raw<std::uint32_t>({4, 32}) + std::string("\xff\xff\xff\xff", 4));
  message_of(lies + raw<std::uint32_t>({1, 4000000000u}) + "x");
  message_of(lies + raw<std::uint32_t>({100, 32}) + "x");
  message_of(pcd_head(99999999, "binary"));
}

TEST(ScanReader, a_skinned_gltf_is_read_in_the_pose_of_its_joints) {
  const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::uint8_t joints[12] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  const float weights[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  // the inverse bind matrix undoes the scale above the joint, and the joint stands 2 up
  const float inverse[16] = {100, 0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0, 0, 0, 0, 1};
  std::string bytes(reinterpret_cast<const char*>(corners), sizeof corners);
  bytes.append(reinterpret_cast<const char*>(joints), sizeof joints);
  bytes.append(reinterpret_cast<const char*>(weights), sizeof weights);
  bytes.append(reinterpret_cast<const char*>(inverse), sizeof inverse);
  const Beside buffer("skinned.bin", bytes);
  const Beside gltf(
      "skinned.gltf",
      R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"scale": [0.01, 0.01, 0.01], "children": [1, 2]}, {"mesh": 0, "skin": 0},
    {"name": "hips", "translation": [0, 200, 0]}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}]}],
    "skins": [{"joints": [2], "inverseBindMatrices": 3}], "buffers": [{"uri": "skinned.bin", "byteLength": 160}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 12}, {"buffer": 0, "byteOffset": 48, "byteLength": 48},
    {"buffer": 0, "byteOffset": 96, "byteLength": 64}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
    "max": [1, 1, 0]}, {"bufferView": 1, "componentType": 5121, "count": 3, "type": "VEC4"}, {"bufferView": 2, "componentType": 5126, "count": 3,
    "type": "VEC4"}, {"bufferView": 3, "componentType": 5126, "count": 1, "type": "MAT4"}]})");
  const TriangleMesh mesh = read_scan(gltf.path).mesh;
  ASSERT_EQ(mesh.positions.size(), 3u);
  EXPECT_LT((mesh.positions[1] - Vec3(1, 2, 0)).norm(), 1e-5);
  EXPECT_LT((mesh.positions[2] - Vec3(0, 3, 0)).norm(), 1e-5);
  // as it was bound the joint stands at its foot, and only the scale above the mesh is left
  const TriangleMesh bound = read_scan(gltf.path, SkinPose::BIND).mesh;
  ASSERT_EQ(bound.positions.size(), 3u);
  EXPECT_LT((bound.positions[1] - Vec3(0.01, 0, 0)).norm(), 1e-5);
  EXPECT_LT((bound.positions[2] - Vec3(0, 0.01, 0)).norm(), 1e-5);
}

TEST(ScanReader, zeros_after_the_text_of_an_obj_are_padding) {
  const Beside padded("padded.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + std::string(3, '\0'));
  EXPECT_EQ(read_scan(padded.path).mesh.triangles.size(), 1u);
  const Beside within("within.obj", "v 0 0 0\nv 1 0 0\n" + std::string(1, '\0') + "v 0 1 0\n");
  EXPECT_NE(complaint([&] { read_scan(within.path); }).find("is not text"), std::string::npos);
}

TEST(ScanReader, a_missing_file_is_bad_input) {
  complaint([] { read_scan("no/such/scan.obj"); });
}

TEST(ScanReader, a_picture_or_a_packed_file_is_named_for_what_it_is) {
  const sloper::test::ScratchFolder folder;
  const auto fact = [&](const std::string& bytes) {
    sloper::test::put(folder / "scan.obj", bytes + std::string(64, '\0'));
    return complaint([&] { read_scan(folder / "scan.obj"); });
  };
  EXPECT_NE(fact("\x89PNG\r\n").find("is a PNG picture"), std::string::npos);
  EXPECT_NE(fact("PK\x03\x04").find("unpack it"), std::string::npos);
}
