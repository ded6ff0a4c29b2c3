#pragma once
/// Keeps prepared skins by content, for the rest of the run and, with a folder, for other
/// runs. Results are the same bytes with it and without. Test:
/// tests/collision/test_skin_cache.cpp
#include <map>
#include <sloper/base/progress.hpp>
#include <sloper/collision/body_collider.hpp>

namespace sloper::collision {

/// A cache of prepared skins. Not for several threads at once.
class SkinCache {
public:
  /// @param folder  made when first written to; empty: nothing is kept beyond this object. Several
  /// processes may share it, also from several
  ///                machines, and it may be emptied at any time: files appear whole, and one that
  ///                is damaged, cut short or of another version is written anew
  /// @param reporter  must outlive this; hears once as a warning that the folder cannot be written,
  /// all else as info
  explicit SkinCache(std::string folder = {}, Reporter& reporter = silent_reporter())
      : m_folder(std::move(folder)), m_reporter(&reporter) {}

  /// As BodyCollider(skin). Not for several threads at once. Cost of a skin met before: O(#F), and
  /// reading 4 bytes a triangle.
  BodyCollider collider(const TriangleMesh& skin);

  /// How often colliders were made, from where.
  struct Counts {
    int remembered = 0; ///< met before in this object
    int read = 0;       ///< from a file of the folder
    int prepared = 0;   ///< from the mesh
    int written = 0;    ///< files
  };
  /// Counts so far.
  const Counts& counts() const { return m_counts; }

private:
  std::string file_of(const std::string& key) const { return m_folder + "/" + key + ".skin"; }
  std::optional<PreparedSkin> read(const std::string& key, const TriangleMesh& skin);
  void write(const std::string& key, const PreparedSkin& prepared);

  std::string m_folder;
  Reporter* m_reporter;
  bool m_writable = true;
  std::map<std::string, PreparedSkin> m_met; ///< by key
  Counts m_counts;
};

/// The collider of a skin, from the cache where there is one.
/// @param cache  or nullptr
BodyCollider make_collider(const TriangleMesh& skin, SkinCache* cache);

} // namespace sloper::collision
