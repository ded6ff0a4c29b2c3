#include <sloper/collision/skin_cache.hpp>

#include <sloper/base/error.hpp>
#include <sloper/io/files.hpp>

#include <filesystem>

namespace sloper::collision {

BodyCollider SkinCache::collider(const TriangleMesh& skin) {
  const std::string key = skin_key(skin);
  if (const auto met = m_met.find(key); met != m_met.end()) {
    ++m_counts.remembered;
    return BodyCollider(skin, met->second);
  }
  if (auto known = read(key, skin)) {
    ++m_counts.read;
    return BodyCollider(skin, m_met.emplace(key, std::move(*known)).first->second);
  }
  BodyCollider fresh(skin);
  ++m_counts.prepared;
  const PreparedSkin& prepared = m_met.emplace(key, fresh.prepared()).first->second;
  if (!m_folder.empty() && m_writable)
    write(key, prepared);
  return fresh;
}

std::optional<PreparedSkin> SkinCache::read(const std::string& key, const TriangleMesh& skin) {
  const std::string file = file_of(key);
  if (m_folder.empty())
    return {};
  std::optional<PreparedSkin> known;
  try {
    const std::optional<std::string> bytes = io::read_file_if_there(file);
    if (!bytes)
      return {};
    known = prepared_from_bytes(*bytes, key, skin.positions.size(), skin.triangles.size());
  } catch (const Error&) { // not ours to read: as if it had never been
  }
  m_reporter->info(known ? "body known from " + file
                         : file + " is damaged or cannot be read; the body is prepared again");
  return known;
}

void SkinCache::write(const std::string& key, const PreparedSkin& prepared) {
  const std::string file = file_of(key);
  std::error_code
      ignored; // what keeps the folder from being made keeps the file from being written
  std::filesystem::create_directories(m_folder, ignored);
  try {
    io::write_file(file, to_bytes(prepared, key));
    ++m_counts.written;
    m_reporter->info("body kept in " + file);
  } catch (const Error& e) {
    m_writable = false;
    m_reporter->warning(
        {"cache.cannot-write"_id, std::string("could not write the body cache: ") + e.what()});
  }
}

BodyCollider make_collider(const TriangleMesh& skin, SkinCache* cache) {
  return cache ? cache->collider(skin) : BodyCollider(skin);
}

} // namespace sloper::collision
