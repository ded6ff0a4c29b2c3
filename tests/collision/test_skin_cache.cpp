#include <support/has.hpp>
#include <support/scratch_folder.hpp>
#include <support/shapes.hpp>

#include <gtest/gtest.h>
#include <sloper/collision/skin_cache.hpp>

#include <sys/wait.h>
#include <unistd.h>

namespace sloper::collision {
namespace {

using test::get;
using test::has;
using test::put;
using test::ScratchFolder;

struct Heard : Reporter {
  std::string infos, warnings;
  int n_warnings = 0;
  void info(const std::string& text) override { infos += text + "\n"; }
  void warning(const Message& message) override {
    warnings += message.text + "\n";
    ++n_warnings;
  }
};

TriangleMesh skin() {
  TriangleMesh mesh = shapes::sphere(3);
  shapes::append(mesh, shapes::sphere(3, 0.6, {0.9, 0.013, 0.007}));
  return mesh;
}

std::string file_in(const ScratchFolder& folder, const TriangleMesh& mesh) {
  return folder / ("kept/" + skin_key(mesh) + ".skin");
}

/// A new cache on that folder makes the collider that there is without one.
SkinCache::Counts run(const std::string& folder, const TriangleMesh& mesh,
                      Reporter& reporter = silent_reporter()) {
  SkinCache cache(folder, reporter);
  EXPECT_EQ(cache.collider(mesh).prepared(), BodyCollider(mesh).prepared());
  return cache.counts();
}

TEST(SkinCache, RemembersWithoutAFolder) {
  SkinCache cache;
  cache.collider(skin());
  cache.collider(skin());
  cache.collider(shapes::sphere(2));
  EXPECT_EQ(cache.counts().prepared, 2);
  EXPECT_EQ(cache.counts().remembered, 1);
  EXPECT_EQ(make_collider(skin(), nullptr).prepared(), make_collider(skin(), &cache).prepared());
}

TEST(SkinCache, ReadsWhatARunBeforeKept) {
  const ScratchFolder folder;
  EXPECT_EQ(run(folder / "kept", skin()).written, 1);
  EXPECT_EQ(run(folder / "kept", skin()).read, 1);
  TriangleMesh other = skin();
  other.positions[3].x() += 1e-12;
  EXPECT_EQ(run(folder / "kept", other).prepared, 1) << "of another body";
  EXPECT_EQ(get(file_in(folder, skin())).size(), get(file_in(folder, other)).size());
}

TEST(SkinCache, WritesAnewWhatIsDamaged) {
  const ScratchFolder folder;
  run(folder / "kept", skin());
  const std::string file = file_in(folder, skin()), whole = get(file);
  std::string turned = whole, of_another, older = whole;
  turned[whole.size() / 2] = static_cast<char>(turned[whole.size() / 2] ^ 1);
  older[29] = static_cast<char>(older[29] + 1); // the version, behind the mark and two numbers
  const TriangleMesh other = shapes::sphere(3);
  run(folder / "kept", other);
  of_another = get(file_in(folder, other));
  for (const std::string& bytes : {turned, older, of_another, whole.substr(0, whole.size() - 1),
                                   whole.substr(0, 40), std::string(), std::string(500, 'x')}) {
    put(file, bytes);
    Heard heard;
    const auto counts = run(folder / "kept", skin(), heard);
    EXPECT_EQ(counts.prepared, 1);
    EXPECT_EQ(counts.written, 1);
    EXPECT_EQ(heard.n_warnings, 0);
    EXPECT_TRUE(has(heard.infos, "prepared again"));
    EXPECT_EQ(get(file), whole);
  }
}

TEST(SkinCache, AFolderThatCannotBeWrittenIsAWarningOnce) {
  const ScratchFolder folder;
  put(folder / "file", "");
  Heard heard;
  SkinCache cache(folder / "file", heard);
  cache.collider(skin());
  cache.collider(shapes::sphere(2));
  EXPECT_EQ(cache.counts().prepared, 2);
  EXPECT_EQ(heard.n_warnings, 1) << heard.warnings;
  EXPECT_TRUE(has(heard.warnings, folder / "file")) << heard.warnings;
}

/// Processes that prepare the same bodies at the same moment: each gets its collider, and what is
/// left is whole.
TEST(SkinCache, ProcessesShareAFolder) {
  const ScratchFolder folder;
  std::vector<pid_t> children;
  for (int i = 0; i < 6; ++i) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      Heard heard;
      for (int round = 0; round < 10; ++round) {
        run(folder / "kept", skin(), heard);
        if (round % 3 == i % 3)
          unlink(file_in(folder, skin()).c_str());
      }
      _exit(testing::Test::HasFailure() || heard.n_warnings > 0 || has(heard.infos, "damaged") ? 1
                                                                                               : 0);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  run(folder / "kept", skin());
  EXPECT_EQ(run(folder / "kept", skin()).read, 1);
}

} // namespace
} // namespace sloper::collision
