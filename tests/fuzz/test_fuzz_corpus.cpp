/// What the fuzzers found, and their seeds, read by every build: no crash comes back.
#include "targets.hpp"

#include <gtest/gtest.h>
#include <sloper/base/random.hpp>

#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>

namespace {

using Reader = std::function<void(std::string_view)>;

/// Every file of a folder, each as it is, cut short at many places, and with bytes changed.
void read_all(const char* folder, const Reader& reader) {
  std::set<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(SLOPER_SOURCE_DIR) / "tests" / "fuzz" / "corpus" / folder))
    files.insert(entry.path());
  ASSERT_FALSE(files.empty()) << folder;
  sloper::Random random(17);
  for (const auto& file : files) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    const std::string bytes = text.str();
    reader(bytes);
    for (int k = 1; k < 40; ++k)
      reader(std::string_view(bytes).substr(0, bytes.size() * static_cast<std::size_t>(k) / 40));
    for (int k = 0; k < 200 && !bytes.empty(); ++k) {
      std::string changed = bytes;
      for (int n = 0; n < 3; ++n)
        changed[random.next() % changed.size()] = static_cast<char>(random.next());
      reader(changed);
    }
  }
}

} // namespace

TEST(FuzzCorpus, scans_are_read_or_refused) {
  read_all("scan", sloper::fuzz::read_scan_bytes);
}
TEST(FuzzCorpus, garment_meshes_are_read_or_refused) {
  read_all("mesh_file", sloper::fuzz::read_mesh_file_bytes);
}
TEST(FuzzCorpus, json_is_read_or_refused) {
  read_all("json", sloper::fuzz::read_json_bytes);
}
TEST(FuzzCorpus, documents_are_read_or_refused) {
  const std::string path = ::testing::TempDir() + "sloper-fuzz-document.json";
  read_all("document", [&](std::string_view bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    sloper::fuzz::read_document_file(path);
  });
  std::filesystem::remove(path);
}
TEST(FuzzCorpus, prepared_skins_are_read_or_made_anew) {
  read_all("prepared_skin", sloper::fuzz::read_prepared_skin_bytes);
}
TEST(FuzzCorpus, motions_are_read_or_refused) {
  read_all("bvh", sloper::fuzz::read_bvh_bytes);
}
