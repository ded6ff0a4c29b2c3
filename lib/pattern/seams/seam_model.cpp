#include <pattern/seams/seam_model.hpp>
#include <sloper/io/json.hpp>

namespace sloper::pattern {

extern const char* const SEAM_MODEL; // seam_model.json, made a source by CMake

namespace {

/// A tree in preorder: a leaf is -1 and its value in thousandths; else clue, class, both branches.
std::size_t read_node(const io::Json& list, std::size_t& at, std::vector<SeamTrees::Node>& tree) {
  const std::size_t own = tree.size();
  tree.emplace_back();
  tree[own].clue = list.at(at++).get<int>();
  const int number = list.at(at++).get<int>();
  if (tree[own].clue < 0) {
    tree[own].value = static_cast<float>(number) / 1000;
    return own;
  }
  tree[own].at = number;
  read_node(list, at, tree);
  tree[own].second = read_node(list, at, tree);
  return own;
}

SeamModel read_model() {
  const io::Json json = io::Json::parse(SEAM_MODEL);
  SeamModel model;
  for (const io::Json& look : json.at("looks"))
    model.looks.push_back(read_trees(look));
  model.settle = read_trees(json.at("settle"));
  model.judge = read_trees(json.at("judge"));
  if (json.contains("whole"))
    model.whole = json.at("whole").get<std::vector<double>>();
  return model;
}

} // namespace

SeamTrees read_trees(const io::Json& json) {
  SeamTrees out;
  out.constant = json.at("constant").get<double>();
  for (const io::Json& list : json.at("trees")) {
    std::size_t at = 0;
    read_node(list, at, out.trees.emplace_back());
  }
  return out;
}

double SeamTrees::operator()(const Evidence& evidence) const {
  double sum = constant;
  for (const std::vector<Node>& tree : trees) {
    std::size_t k = 0;
    while (tree[k].clue >= 0)
      k = evidence[tree[k].clue] > tree[k].at ? tree[k].second : k + 1;
    sum += tree[k].value;
  }
  return sum;
}

const SeamModel& seam_model() {
  static const SeamModel model = read_model();
  return model;
}

} // namespace sloper::pattern
