#include <pattern/roles/shape_roles.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace sloper::pattern {

extern const char* const ROLE_MODEL; // role_model.json, made a source by CMake

namespace {

constexpr double AT_THE_SIDE = 0.25; // of a panel's width, from its middle
constexpr double CLEAR_VOTE = 0.2;   // of all that is cast
constexpr double SAME_FACE = 100;    // log-odds
constexpr double ONE_PANEL =
    0.05; // weight of what one panel's shape says of its face: decides ties
constexpr double ON_THE_SIDE = 0.4; // of a panel's width, from its middle: a side seam

using Parts = std::vector<std::array<double, SHAPE_PARTS>>;

/// Panels whose faces are known relative to each other.
class Faces {
public:
  explicit Faces(std::size_t n) : m_parent(n), m_turned(n, false) {
    for (std::size_t k = 0; k < n; ++k)
      m_parent[k] = k;
  }
  std::pair<std::size_t, bool> root(std::size_t k) const {
    bool turned = false;
    while (m_parent[k] != k) {
      turned = turned != m_turned[k];
      k = m_parent[k];
    }
    return {k, turned};
  }
  void join(std::size_t a, std::size_t b, bool opposite) {
    const auto [p, ta] = root(a);
    const auto [q, tb] = root(b);
    if (p != q) {
      m_parent[q] = p;
      m_turned[q] = (ta != tb) != opposite;
    }
  }

private:
  std::vector<std::size_t> m_parent;
  std::vector<bool> m_turned;
};

Parts look(const ShapeWitness& witness, const std::vector<SeamTrees>& trees, const Parts* before,
           bool legs) {
  Parts out(witness.count());
  for (std::size_t k = 0; k < witness.count(); ++k) {
    const Evidence evidence = before ? witness.panel(k, *before) : witness.panel(k);
    double most = -1e300, sum = 0;
    for (std::size_t c = 0; c < SHAPE_PARTS; ++c) {
      out[k][c] = trees[c](evidence);
      if (c == LEG_PART && !legs)
        out[k][c] = -1e300;
      most = std::max(most, out[k][c]);
    }
    for (double& x : out[k]) {
      x = std::exp(x - most);
      sum += x;
    }
    for (double& x : out[k])
      x /= sum;
  }
  return out;
}

/// Whether two whole pieces are sewn to each other at both of their sides: they face each other.
bool go_around(const ShapeWitness& witness, std::size_t a, std::size_t b) {
  if (!witness.symmetric(a) || !witness.symmetric(b))
    return false;
  bool sides[2] = {false, false};
  for (const auto& l : witness.links()) {
    const bool these = (l.a == a && l.b == b) || (l.a == b && l.b == a);
    if (!these || std::min(std::abs(l.x_a - 0.5), std::abs(l.x_b - 0.5)) < ON_THE_SIDE)
      continue;
    sides[l.x_a > 0.5] = true;
  }
  return sides[0] && sides[1];
}

/// Of two torso panels that are sewn once: whether each is sewn to one more torso panel at two
/// places or more, as at side and shoulder, and these two to each other. Around a torso in four
/// pieces the two are then halves of one face, whether or not they are mirror images.
bool halves_of_four(const ShapeWitness& witness, const std::vector<std::size_t>& part,
                    std::size_t a, std::size_t b) {
  const auto seams = [&](std::size_t p, std::size_t q) {
    return std::count_if(witness.links().begin(), witness.links().end(), [&](const auto& l) {
      return (l.a == p && l.b == q) || (l.a == q && l.b == p);
    });
  };
  if (part[a] != TORSO_PART || part[b] != TORSO_PART || seams(a, b) != 1)
    return false;
  const auto facing = [&](std::size_t p, std::size_t but) {
    for (std::size_t q = 0; q < witness.count(); ++q)
      if (q != p && q != but && part[q] == TORSO_PART && seams(p, q) > 1)
        return q;
    return p;
  };
  const std::size_t c = facing(a, b), d = facing(b, a);
  return c != a && d != b && c != d && seams(c, d) == 1;
}

/// SAME_FACE where a seam surely joins panels of one face, -SAME_FACE where surely of both, else 0.
double sure_face(const ShapeWitness& witness, const std::vector<std::size_t>& part,
                 const ShapeWitness::Link& l) {
  if (halves_of_four(witness, part, l.a, l.b))
    return SAME_FACE;
  // What is sewn to its own image, and is no symmetric piece, is the other half of one face; where
  // all four pieces are alike, only what has one seam with it.
  const bool halves = l.middle && !witness.symmetric(l.a);
  for (std::size_t c = 0; c < witness.count() && halves; ++c)
    if (c != l.a && c != l.b && halves_of_four(witness, part, l.a, c))
      return -SAME_FACE;
  if (halves)
    return SAME_FACE;
  const bool trunk = part[l.a] != ARM_PART && part[l.a] != NECK_PART && part[l.a] == part[l.b];
  return trunk && go_around(witness, l.a, l.b) ? -SAME_FACE : 0;
}

} // namespace

const RoleModel& role_model() {
  static const RoleModel model = [] {
    const io::Json json = io::Json::parse(ROLE_MODEL);
    RoleModel out;
    for (std::size_t look : {0, 1})
      for (const io::Json& trees : json.at("parts").at(look))
        out.parts[look].push_back(read_trees(trees));
    out.back = read_trees(json.at("back"));
    out.same_face = read_trees(json.at("same_face"));
    for (std::size_t k = 0; k < FACE_VOTES; ++k)
      out.front[k] = json.at("front").at(FACE_VOTE_NAMES[k]).get<double>();
    return out;
  }();
  return model;
}

std::vector<std::pair<std::size_t, bool>> tell_faces(const ShapeWitness& witness,
                                                     const RoleModel& model,
                                                     const std::vector<std::size_t>& part) {
  // What all seams of two panels say together. A sleeve, a hood or a collar goes around and joins a
  // front to a back: its seams come after those of the trunk.
  std::map<std::pair<std::size_t, std::size_t>, double> same;
  for (const auto& l : witness.links()) {
    const double sure = sure_face(witness, part, l);
    const double score = sure != 0 ? sure : model.same_face(witness.link(l, part));
    same[std::minmax(l.a, l.b)] += score;
  }
  std::vector<std::tuple<int, double, std::size_t, std::size_t>> order;
  for (const auto& [pair, score] : same) {
    const auto is = [&, p = pair](std::size_t kind) {
      return part[p.first] == kind || part[p.second] == kind;
    };
    const int around = is(NECK_PART) ? 2 : is(ARM_PART);
    order.push_back({around, -std::abs(score), pair.first, pair.second});
  }
  std::sort(order.begin(), order.end());
  Faces faces(witness.count());
  for (const auto& [around, cost, a, b] : order)
    faces.join(a, b, same[{a, b}] < 0);
  std::vector<std::pair<std::size_t, bool>> out;
  for (std::size_t k = 0; k < witness.count(); ++k)
    out.push_back(faces.root(k));
  return out;
}

void tell_sides(const ShapeWitness& witness, const RoleModel& model, const Parts& parts,
                std::vector<ShapeRole>& roles) {
  const std::size_t n = witness.count();
  std::vector<std::size_t> own;
  for (const ShapeRole& role : roles)
    own.push_back(role.part);
  const std::vector<std::pair<std::size_t, bool>> faces = tell_faces(witness, model, own);
  std::vector<double> front(n, 0); // log-odds, summed at the roots
  for (std::size_t k = 0; k < n; ++k)
    front[faces[k].first] +=
        (faces[k].second ? 1 : -1) * ONE_PANEL * model.back(witness.panel(k, parts));
  for (std::size_t root = 0; root < n; ++root) {
    std::vector<int> face(n, 0);
    for (std::size_t k = 0; k < n; ++k)
      if (faces[k].first == root)
        face[k] = faces[k].second ? -1 : 1;
    const FaceVotes votes = witness.faces().compare(own, face);
    for (std::size_t v = 0; v < FACE_VOTES && faces[root].first == root; ++v)
      front[root] += model.front[v] * votes[v];
  }
  for (std::size_t k = 0; k < n; ++k) {
    const auto [root, turned] = faces[k];
    roles[k].back = (front[root] < 0) != turned;
    roles[k].face_odds = std::abs(front[root]);
  }
  // Seen from outside, a front's right half is the wearer's left; a back's is the right.
  const auto hand = [&](std::size_t k, double x) {
    return (x > 0.5 ? 1 : -1) * (roles[k].back ? -1 : 1);
  };
  // In the middle a half is sewn to the other one of its face, at the side to one of the other.
  std::vector<double> votes(n, 0), cast(n, 0);
  for (const auto& l : witness.links()) {
    if (own[l.a] == 1 || own[l.a] != own[l.b])
      continue;
    const double weight_aside = roles[l.a].back == roles[l.b].back ? 3 : -1;
    const double weight = l.middle ? 10 : weight_aside;
    if (!l.middle && std::min(std::abs(l.x_a - 0.5), std::abs(l.x_b - 0.5)) < AT_THE_SIDE)
      continue;
    votes[l.a] -= weight * l.length * hand(l.a, l.x_a);
    votes[l.b] -= weight * l.length * hand(l.b, l.x_b);
    for (std::size_t k : {l.a, l.b})
      cast[k] += std::abs(weight) * l.length;
  }
  for (std::size_t k = 0; k < n; ++k)
    if (std::abs(votes[k]) > CLEAR_VOTE * cast[k] && !witness.symmetric(k))
      roles[k].hand = votes[k] > 0 ? 1 : -1;
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& l : witness.links())
      for (const bool turn : {false, true}) {
        const std::size_t a = turn ? l.b : l.a, b = turn ? l.a : l.b;
        if (l.middle || roles[b].hand != 0)
          continue;
        if (roles[a].hand != 0 && (own[b] == own[a] || own[b] == 1) && (own[b] != 3)) {
          roles[b].hand = roles[a].hand;
          changed = true;
        } else if (roles[a].hand == 0 && own[b] == 1 && own[a] != 1 && witness.symmetric(a)) {
          roles[b].hand = hand(a, turn ? l.x_b : l.x_a);
          changed = true;
        }
      }
  }
}

std::vector<ShapeRole> shape_roles(const Pattern& pattern, const RoleModel& model, bool legs) {
  const ShapeWitness witness(pattern);
  Parts parts = look(witness, model.parts[0], nullptr, legs);
  parts = look(witness, model.parts[1], &parts, legs);
  std::vector<ShapeRole> roles(witness.count());
  for (std::size_t k = 0; k < roles.size(); ++k) {
    const auto best = std::max_element(parts[k].begin(), parts[k].end());
    roles[k].part = static_cast<std::size_t>(best - parts[k].begin());
    roles[k].sure = *best;
  }
  tell_sides(witness, model, parts, roles);
  return roles;
}

} // namespace sloper::pattern
