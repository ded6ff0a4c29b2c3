/// Readers under seeded damage: a file is read or refused with a message that names it, never a
/// crash, never another exception.
#include <sloper/base/error.hpp>
#include <sloper/base/random.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/obj.hpp>
#include <sloper/io/scan_reader.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace sloper;

namespace {

/// One to four damages: a byte changed, a run cut out, doubled or swapped for a word that breaks
/// readers, the end cut off.
std::string damaged(std::string text, Random& random, const std::vector<std::string>& words) {
  auto below = [&](std::size_t n) {
    return n == 0 ? 0 : static_cast<std::size_t>(random.next() % n);
  };
  const std::size_t n_damages = 1 + below(4);
  for (std::size_t i = 0; i < n_damages && !text.empty(); ++i) {
    const std::size_t at = below(text.size()),
                      length = 1 + below(std::min<std::size_t>(40, text.size() - at));
    switch (below(6)) {
    case 0: text[at] = static_cast<char>(random.next()); break;
    case 1: text.erase(at, length); break;
    case 2: text.insert(below(text.size()), text.substr(at, length)); break;
    case 3: text.replace(at, std::min<std::size_t>(length, 6), words[below(words.size())]); break;
    case 4: text.resize(at); break;
    default: text[at] = static_cast<char>(text[at] ^ (1 << below(8))); break;
    }
  }
  return text;
}

/// Reads `n` damaged copies; anything but success or an input error fails the test. @return how
/// many were refused
int refused(const std::string& text, std::uint64_t seed, int n,
            const std::function<void(const std::string&)>& read) {
  const std::vector<std::string> words = {
      "nan",      "inf",         "1e999",      "-1",
      "0",        "99999999999", "4294967295", "-9223372036854775808",
      "{",        "}",           "[",          "]",
      "\"",       ",",           "\n",         std::string(1, '\0'),
      "\xff\xfe", "1e-999",      "f 1 2 3\n",  "null"};
  Random random(seed);
  int count = 0;
  for (int i = 0; i < n; ++i) {
    const std::string sample = damaged(text, random, words);
    try {
      read(sample);
    } catch (const Error& e) {
      ++count;
      EXPECT_EQ(e.kind(), ErrorKind::INPUT) << e.what();
      EXPECT_EQ(e.file(), "sample") << e.what();
      EXPECT_FALSE(e.fact().empty());
    } catch (const std::exception& e) {
      ADD_FAILURE() << "seed " << seed << ", sample " << i << ": " << e.what();
    }
  }
  return count;
}

std::string sample_obj() {
  std::string text = "# sample\n";
  for (int i = 0; i < 20; ++i)
    text += "v " + std::to_string(0.1 * i) + " " + std::to_string(i * i) + " -0.5\nvt 0." +
            std::to_string(i) + " 0.25\n";
  text += "g front\n";
  for (int i = 1; i < 18; ++i)
    text += "f " + std::to_string(i) + "/" + std::to_string(i + 1) + " " + std::to_string(i + 1) +
            "/1 " + std::to_string(i - 21) + "\n";
  return text;
}

std::string sample_json() {
  return R"({"format": "body", "version": 1, "landmarks": {"acromion_l": {"p": [0.18, 1.4, -0.01], "step": 1, "confidence": 0.9, "alternatives": [[0.1, 1.2, 0], []]}},
 "levels": {"waist": {"y": 1.1e0, "girth_m": 7e-1}}, "text": "\u00e9\n\"", "flags": [true, false, null], "big": 123456789012345678901234567890, "deep": [[[[[1]]]]]})";
}

std::string sample_ply() {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 12\nproperty float x\nproperty float "
                     "y\nproperty float z\nelement face 5\nproperty list uchar int "
                     "vertex_indices\nend_header\n";
  for (int i = 0; i < 12; ++i)
    text += std::to_string(i) + " " + std::to_string(i % 3) + " 0.5\n";
  for (int i = 0; i < 5; ++i)
    text +=
        "3 " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 2) + "\n";
  return text;
}

std::string sample_binary_ply() {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex 8\nproperty float "
                     "x\nproperty float y\nproperty float z\nelement face 4\nproperty "
                     "list uchar int vertex_indices\nend_header\n";
  auto append = [&](auto value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (int i = 0; i < 24; ++i)
    append(static_cast<float>(i) * 0.1f);
  for (int i = 0; i < 4; ++i) {
    append(static_cast<unsigned char>(3));
    for (int k = 0; k < 3; ++k)
      append(i + k);
  }
  return text;
}

std::string sample_binary_stl() {
  std::string text(80, ' ');
  auto append = [&](auto value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  append(std::uint32_t{6});
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 12; ++k)
      append(static_cast<float>(i * 12 + k) * 0.01f);
    append(std::uint16_t{0});
  }
  return text;
}

std::string sample_ascii_stl() {
  std::string text = "solid s\n";
  for (int i = 0; i < 5; ++i)
    text += "facet normal 0 0 1\n outer loop\n  vertex 0 0 " + std::to_string(i) +
            "\n  vertex 1 0 0\n  vertex 0 1 0\n endloop\nendfacet\n";
  return text + "endsolid s\n";
}

void check_mesh(const TriangleMesh& mesh) {
  for (const Vec3& p : mesh.positions)
    ASSERT_TRUE(p.allFinite());
  for (const Triangle& t : mesh.triangles)
    for (const int v : t)
      ASSERT_TRUE(v >= 0 && v < std::ssize(mesh.positions));
}

constexpr int N = 4000;

} // namespace

TEST(Mutations, obj_is_read_with_sound_indices_or_refused) {
  const int n = refused(sample_obj(), 1, N, [](const std::string& text) {
    const io::ObjMesh mesh = io::parse_obj(text, "sample");
    check_mesh({mesh.positions, mesh.triangles});
    for (const Triangle& t : mesh.texture_triangles)
      for (const int v : t)
        ASSERT_TRUE(v >= -1 && v < std::ssize(mesh.texture));
  });
  EXPECT_GT(n, N / 10);
  EXPECT_LT(n, N);
}

TEST(Mutations, json_is_read_and_writes_itself_back_or_is_refused) {
  const int n = refused(sample_json(), 2, N, [](const std::string& text) {
    const std::string written = io::to_text(io::parse_json(text, "sample"));
    ASSERT_EQ(io::to_text(io::parse_json(written, "again")), written);
  });
  EXPECT_GT(n, N / 10);
  EXPECT_LT(n, N);
}

TEST(Mutations, ascii_ply_is_read_with_sound_indices_or_refused) {
  EXPECT_GT(refused(sample_ply(), 3, N,
                    [](const std::string& text) { check_mesh(io::parse_ply(text, "sample")); }),
            N / 10);
}

TEST(Mutations, binary_ply_is_read_with_sound_indices_or_refused) {
  EXPECT_GT(refused(sample_binary_ply(), 4, N,
                    [](const std::string& text) { check_mesh(io::parse_ply(text, "sample")); }),
            N / 10);
}

TEST(Mutations, binary_stl_is_read_or_refused) {
  EXPECT_GT(refused(sample_binary_stl(), 5, N,
                    [](const std::string& text) { check_mesh(io::parse_stl(text, "sample")); }),
            N / 10);
}

TEST(Mutations, ascii_stl_is_read_or_refused) {
  EXPECT_GT(refused(sample_ascii_stl(), 6, N,
                    [](const std::string& text) { check_mesh(io::parse_stl(text, "sample")); }),
            N / 10);
}

TEST(Mutations, xyz_is_read_or_refused) {
  EXPECT_GT(refused("0 0 0\n1 2 3 255 0 0\n# remark\n-1.5e-3 2 0.25\n0 1 0\n", 7, N,
                    [](const std::string& text) { check_mesh(io::parse_xyz(text, "sample")); }),
            0);
}
