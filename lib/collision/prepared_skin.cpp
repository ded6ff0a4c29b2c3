#include <sloper/collision/prepared_skin.hpp>

#include <sloper/io/files.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>

namespace sloper::collision {

namespace {

constexpr std::string_view MARK = "sloper prepared skin\n";
constexpr std::size_t KEY_LENGTH = 64, HASH_LENGTH = 64;

template<class T> std::string_view bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string header() {
  const std::uint32_t numbers[] = {0x01020304, sizeof(int), PREPARED_SKIN_VERSION};
  return std::string(MARK) + std::string(reinterpret_cast<const char*>(numbers), sizeof numbers);
}

bool ascends_below(const std::vector<int>& list, std::size_t n) {
  return std::adjacent_find(list.begin(), list.end(), std::greater_equal<int>()) == list.end() &&
         (list.empty() || (list.front() >= 0 && static_cast<std::size_t>(list.back()) < n));
}

bool permutes(const std::vector<int>& order, std::size_t n) {
  if (order.size() != n)
    return false;
  std::vector<char> seen(n, 0);
  for (const int i : order) {
    if (i < 0 || static_cast<std::size_t>(i) >= n || seen[i])
      return false;
    seen[i] = 1;
  }
  return true;
}

template<class Skin, class Visit> void visit_lists(Skin& s, const Visit& visit) {
  for (auto* list : {&s.turned, &s.buried, &s.untrusted_faces, &s.untrusted_edges,
                     &s.untrusted_vertices, &s.order, &s.skin_order})
    visit(*list);
}

template<class Findings, class Visit> void visit_findings(Findings& f, const Visit& visit) {
  for (auto* count : {&f.flipped_triangles, &f.boundary_edges, &f.non_manifold_edges,
                      &f.self_intersections, &f.untrusted_triangles, &f.buried_triangles})
    visit(*count);
}

} // namespace

bool PreparedSkin::fits(std::size_t n_vertices, std::size_t n_triangles) const {
  return ascends_below(turned, n_triangles) && ascends_below(buried, n_triangles) &&
         ascends_below(untrusted_faces, n_triangles) &&
         ascends_below(untrusted_edges, 3 * n_triangles) &&
         ascends_below(untrusted_vertices, n_vertices) && permutes(order, n_triangles) &&
         permutes(skin_order, buried.empty() ? 0 : n_triangles - buried.size()) &&
         (buried.empty() || buried.size() < n_triangles);
}

std::string skin_key(const TriangleMesh& skin) {
  return io::sha256(header() + io::sha256(bytes_of(skin.positions)) +
                    io::sha256(bytes_of(skin.triangles)));
}

std::string to_bytes(const PreparedSkin& prepared, const std::string& key) {
  std::string bytes = header() + key;
  const auto add = [&](std::uint64_t number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  };
  visit_findings(prepared.findings, [&](int count) { add(static_cast<std::uint64_t>(count)); });
  visit_lists(prepared, [&](const std::vector<int>& list) {
    add(list.size());
    bytes += bytes_of(list);
  });
  return bytes + io::sha256(bytes);
}

std::optional<PreparedSkin> prepared_from_bytes(std::string_view bytes, const std::string& key,
                                                std::size_t n_vertices, std::size_t n_triangles) {
  const std::string begin = header() + key;
  if (key.size() != KEY_LENGTH || bytes.size() < begin.size() + HASH_LENGTH ||
      !bytes.starts_with(begin))
    return {};
  std::string_view rest = bytes.substr(0, bytes.size() - HASH_LENGTH);
  if (io::sha256(rest) != bytes.substr(rest.size()))
    return {};
  rest.remove_prefix(begin.size());
  bool whole = true;
  const auto take = [&](void* to, std::size_t n) {
    whole = whole && n <= rest.size();
    if (!whole || n == 0)
      return;
    std::memcpy(to, rest.data(), n);
    rest.remove_prefix(n);
  };
  PreparedSkin prepared;
  visit_findings(prepared.findings, [&](int& count) {
    std::uint64_t number = 0;
    take(&number, sizeof number);
    whole = whole && number <= std::numeric_limits<int>::max();
    count = whole ? static_cast<int>(number) : 0;
  });
  visit_lists(prepared, [&](std::vector<int>& list) {
    std::uint64_t size = 0;
    take(&size, sizeof size);
    whole = whole && size <= rest.size() / sizeof(int);
    if (!whole)
      return;
    list.resize(size);
    take(list.data(), size * sizeof(int));
  });
  if (!whole || !rest.empty() || !prepared.fits(n_vertices, n_triangles))
    return {};
  return prepared;
}

} // namespace sloper::collision
