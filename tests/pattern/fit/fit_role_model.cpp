/// Fits role_model.json to specifications whose names tell where panels go.
///
///   fit_role_model MODEL.json SPECIFICATION...
///
/// Those whose path has "keep" in it are not learned from but reported on. Of each there is a
/// second version with halves of panels joined to one piece, as CAD files have them.
#include "boosting.hpp"
#include "join_panels.hpp"

#include <pattern/roles/shape_roles.hpp>
#include <sloper/pattern/read/read_pattern.hpp>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>

using namespace sloper;
using namespace sloper::pattern;
using namespace sloper::pattern::fit;

namespace {

constexpr std::size_t FOLDS = 4;
using Parts = std::vector<std::array<double, SHAPE_PARTS>>;

struct Truth {
  std::size_t part;
  int face = 0, hand = 0; ///< 1 back, -1 front; 1 left, -1 right; 0 not told
};

bool has(const std::string& name, const char* word) {
  return name.find(word) != std::string::npos;
}
bool ends(const std::string& name, const std::string& tail) {
  return name.size() >= tail.size() &&
         name.compare(name.size() - tail.size(), tail.size(), tail) == 0;
}

Truth truth_of(const std::string& n) {
  Truth t{3};
  t.hand = t.face = 0;
  if (has(n, "left") || has(n, "_l_") || ends(n, "_l"))
    t.hand = 1;
  else if (has(n, "right") || has(n, "_r_") || ends(n, "_r"))
    t.hand = -1;
  if (has(n, "front") || has(n, "ftorso") || ends(n, "_f") || has(n, "_f_"))
    t.face = -1;
  else if (has(n, "back") || has(n, "btorso") || ends(n, "_b") || has(n, "_b_"))
    t.face = 1;
  if (has(n, "collar") || has(n, "hood"))
    t.part = 2;
  else if (has(n, "sleeve") || n.rfind("sl_", 0) == 0)
    t.part = 1;
  else if (has(n, "torso"))
    t.part = 0;
  else if (n.rfind("pant", 0) == 0)
    t.part = 4;
  else
    t.hand = 0;
  return t;
}

struct Garment {
  std::string path;
  std::size_t fold = 0;
  bool kept = false;
  std::vector<std::string> names;
  std::vector<Truth> truth;
  Pattern pattern;
  std::unique_ptr<ShapeWitness> witness;
  Parts parts;
};

/// Weights by which a front has more of what a vote compares: logistic regression without constant,
/// for exchanging the faces turns all votes round. Newton's method with a ridge.
FaceVotes weigh(const std::vector<FaceVotes>& fronts) {
  constexpr double RIDGE = 1;
  constexpr int STEPS = 50;
  Eigen::VectorXd w = Eigen::VectorXd::Zero(FACE_VOTES);
  for (int step = 0; step < STEPS; ++step) {
    Eigen::VectorXd gradient = -RIDGE * w;
    Eigen::MatrixXd hessian = RIDGE * Eigen::MatrixXd::Identity(FACE_VOTES, FACE_VOTES);
    for (const FaceVotes& votes : fronts) {
      const Eigen::Map<const Eigen::VectorXd> x(votes.data(), FACE_VOTES);
      const double right = 1 / (1 + std::exp(-w.dot(x)));
      gradient += (1 - right) * x;
      hessian += right * (1 - right) * x * x.transpose();
    }
    w += hessian.ldlt().solve(gradient);
  }
  FaceVotes out;
  for (std::size_t k = 0; k < FACE_VOTES; ++k)
    out[k] = std::round(100 * w[static_cast<Eigen::Index>(k)]) / 100;
  return out;
}

double sum_of(const FaceVotes& weights, const FaceVotes& votes) {
  double sum = 0;
  for (std::size_t k = 0; k < FACE_VOTES; ++k)
    sum += weights[k] * votes[k];
  return sum;
}

/// Garments whose front and back are exchanged by weights that were learned from the others, of all
/// whose faces differ.
void cross_validate(const std::vector<FaceVotes>& fronts, const std::vector<std::size_t>& folds) {
  std::size_t wrong = 0;
  for (std::size_t fold = 0; fold < FOLDS; ++fold) {
    std::vector<FaceVotes> others;
    for (std::size_t k = 0; k < fronts.size(); ++k)
      if (folds[k] != fold)
        others.push_back(fronts[k]);
    const FaceVotes weights = weigh(others);
    for (std::size_t k = 0; k < fronts.size(); ++k)
      wrong += folds[k] == fold && sum_of(weights, fronts[k]) <= 0;
  }
  std::printf("front and back by votes alone, %zu folds: %zu of %zu garments turned\n", FOLDS,
              wrong, fronts.size());
}

/// @param joined_from  the specification, where halves of it were joined
std::unique_ptr<Garment> prepare(const std::string& path, std::size_t number, Pattern pattern,
                                 const Pattern* joined_from) {
  auto g = std::make_unique<Garment>();
  g->path = path;
  g->fold = number % FOLDS;
  g->kept = path.find("keep") != std::string::npos;
  g->pattern = std::move(pattern);
  for (Panel& panel : g->pattern.panels) {
    g->names.push_back(panel.name);
    g->truth.push_back(truth_of(panel.name));
    panel.hint = {};
    panel.label.clear();
    const auto same = [&](const Panel& p) {
      return p.name == panel.name && p.n_edges() == panel.n_edges();
    };
    if (!joined_from || std::any_of(joined_from->panels.begin(), joined_from->panels.end(), same))
      continue;
    Truth& truth = g->truth.back(); // both halves
    (truth.part == ARM_PART ? truth.face : truth.hand) = 0;
  }
  g->witness = std::make_unique<ShapeWitness>(g->pattern);
  return g;
}

SeamTrees learn(const std::vector<Sample>& samples, const Boosting& how) {
  std::vector<const Sample*> list;
  for (const Sample& s : samples)
    list.push_back(&s);
  return boost(list, CLUES, how);
}

} // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: fit_role_model MODEL.json SPECIFICATION...\n";
    return 2;
  }
  std::vector<std::unique_ptr<Garment>> all;
  for (int k = 2; k < argc; ++k) {
    Pattern pattern = read_pattern(argv[k], PatternChoice{});
    if (pattern.seams.empty())
      continue;
    Pattern other = joined(pattern, [] { return false; });
    const std::size_t number = static_cast<std::size_t>(k);
    if (other.panels.size() < pattern.panels.size())
      all.push_back(prepare(argv[k], number, std::move(other), &pattern));
    all.push_back(prepare(argv[k], number, std::move(pattern), nullptr));
  }
  RoleModel model;
  Boosting how;
  how.trees = 60;
  how.depth = 3;
  for (std::size_t look : {0, 1}) {
    std::vector<std::vector<SeamTrees>> trees(FOLDS + 1);
    for (std::size_t fold = 0; fold <= FOLDS; ++fold)
      for (std::size_t c = 0; c < SHAPE_PARTS; ++c) {
        std::vector<Sample> samples;
        for (std::size_t g = 0; g < all.size(); ++g)
          for (std::size_t k = 0; k < all[g]->names.size() && !all[g]->kept && all[g]->fold != fold;
               ++k)
            samples.push_back(
                {{},
                 look ? all[g]->witness->panel(k, all[g]->parts) : all[g]->witness->panel(k),
                 all[g]->truth[k].part == c,
                 1});
        trees[fold].push_back(learn(samples, how));
      }
    for (std::size_t g = 0; g < all.size(); ++g) {
      const auto& own = trees[all[g]->kept ? FOLDS : all[g]->fold];
      Parts now(all[g]->names.size());
      for (std::size_t k = 0; k < now.size(); ++k) {
        const Evidence e =
            look ? all[g]->witness->panel(k, all[g]->parts) : all[g]->witness->panel(k);
        double sum = 0;
        for (std::size_t c = 0; c < SHAPE_PARTS; ++c)
          sum += now[k][c] = std::exp(own[c](e));
        for (double& x : now[k])
          x /= sum;
      }
      all[g]->parts = std::move(now);
    }
    model.parts[look] = trees[FOLDS];
  }
  std::vector<FaceVotes> fronts;
  std::vector<std::size_t> folds;
  std::vector<Sample> backs, faces;
  for (const auto& g : all) {
    if (g->kept)
      continue;
    std::vector<std::size_t> parts;
    for (const Truth& t : g->truth)
      parts.push_back(t.part);
    std::vector<int> face;
    for (const Truth& t : g->truth)
      face.push_back(-t.face);
    const FaceVotes votes = g->witness->faces().compare(parts, face);
    if (std::any_of(votes.begin(), votes.end(), [](double v) { return v != 0; })) {
      fronts.push_back(votes);
      folds.push_back(g->fold);
    }
    for (std::size_t k = 0; k < g->names.size(); ++k)
      if (g->truth[k].face != 0)
        backs.push_back({{}, g->witness->panel(k, g->parts), g->truth[k].face > 0, 1});
    for (const auto& l : g->witness->links())
      if (g->truth[l.a].face * g->truth[l.b].face != 0)
        faces.push_back(
            {{}, g->witness->link(l, parts), g->truth[l.a].face == g->truth[l.b].face, 1});
  }
  model.back = learn(backs, how);
  model.same_face = learn(faces, how);
  model.front = weigh(fronts);
  cross_validate(fronts, folds);
  std::size_t panels = 0, parts = 0, right = 0, whole = 0, garments = 0;
  for (const auto& g : all) {
    if (!g->kept)
      continue;
    const std::vector<ShapeRole> roles = shape_roles(g->pattern, model);
    std::string wrong;
    for (std::size_t k = 0; k < roles.size(); ++k) {
      const Truth& t = g->truth[k];
      const bool part = roles[k].part == t.part,
                 side = (t.face == 0 || (t.face > 0) == roles[k].back) &&
                        (t.hand == 0 || t.hand == roles[k].hand || t.part == 2);
      ++panels;
      parts += part;
      right += part && (side || t.part == 2);
      if (!part || !(side || t.part == 2)) {
        wrong += " " + g->names[k] + "=" + SHAPE_PART_NAMES[roles[k].part] +
                 (roles[k].back ? " back" : " front");
        if (roles[k].hand > 0)
          wrong += " left";
        if (roles[k].hand < 0)
          wrong += " right";
      }
    }
    ++garments;
    whole += wrong.empty();
    if (!wrong.empty())
      std::printf("%s:%s\n", g->path.c_str(), wrong.c_str());
  }
  std::printf("%zu panels: part right %.3f, side too %.3f; %zu of %zu garments wholly\n", panels,
              static_cast<double>(parts) / static_cast<double>(panels),
              static_cast<double>(right) / static_cast<double>(panels), whole, garments);
  std::ofstream out(argv[1]);
  out << "{\"parts\": [";
  for (std::size_t look : {0, 1}) {
    out << (look ? ",\n[" : "[");
    for (std::size_t c = 0; c < SHAPE_PARTS; ++c)
      out << (c ? ",\n" : "") << trees_text(model.parts[look][c]);
    out << "]";
  }
  out << "],\n\"back\": " << trees_text(model.back)
      << ",\n\"same_face\": " << trees_text(model.same_face) << ",\n\"front\": {";
  for (std::size_t k = 0; k < FACE_VOTES; ++k)
    out << (k ? ", " : "") << '"' << FACE_VOTE_NAMES[k] << "\": " << model.front[k];
  out << "}}\n";
  return out ? 0 : 5;
}
