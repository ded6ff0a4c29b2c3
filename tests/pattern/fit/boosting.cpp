#include "boosting.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace sloper::pattern::fit {
namespace {

/// One tree being grown: nodes as in a heap.
class Growing {
public:
  Growing(const std::vector<const Sample*>& samples, std::size_t clues, const Boosting& how,
          std::mt19937_64& random)
      : m_samples(samples), m_clues(clues), m_how(how) {
    const auto share = [&] { return static_cast<double>(random() >> 11) / 9007199254740992.0; };
    for (std::size_t c = 0; c < clues; ++c)
      m_used.push_back(share() < 0.6);
    for (std::size_t k = 0; k < samples.size(); ++k)
      if (share() < 0.7)
        m_rows.push_back(k);
  }

  std::vector<SeamTrees::Node> grow(const std::vector<float>& slope,
                                    const std::vector<float>& curve) {
    m_heap.assign((std::size_t{2} << m_how.depth) - 1, {});
    m_node.assign(m_samples.size(), 0);
    std::vector<char> active(m_heap.size(), 0);
    active[0] = 1;
    for (int depth = 0; depth <= m_how.depth; ++depth) {
      const std::size_t first = (std::size_t{1} << depth) - 1, count = first + 1;
      std::vector<double> g(count * m_clues * CLASSES, 0), h(g.size(), 0), sum(count, 0),
          weight(count, 0);
      for (std::size_t k : m_rows) {
        if (m_node[k] < first || m_node[k] == DONE)
          continue;
        const std::size_t x = m_node[k] - first;
        sum[x] += slope[k];
        weight[x] += curve[k];
        for (std::size_t c = 0; c < m_clues && depth < m_how.depth; ++c) {
          if (!m_used[c])
            continue;
          const std::size_t at = (x * m_clues + c) * CLASSES + m_samples[k]->evidence[c];
          g[at] += slope[k];
          h[at] += curve[k];
        }
      }
      for (std::size_t x = 0; x < count; ++x) {
        SeamTrees::Node& node = m_heap[first + x];
        if (!active[first + x])
          continue;
        node.value = static_cast<float>(m_how.rate * sum[x] / (weight[x] + m_how.ridge));
        if (depth < m_how.depth &&
            split(node, &g[x * m_clues * CLASSES], &h[x * m_clues * CLASSES], sum[x], weight[x]))
          active[2 * (first + x) + 1] = active[2 * (first + x) + 2] = 1;
      }
      if (depth == m_how.depth)
        break;
      for (std::size_t k : m_rows)
        if (m_node[k] != DONE)
          m_node[k] = m_heap[m_node[k]].clue < 0 ? DONE : branch(m_node[k], *m_samples[k]);
    }
    std::vector<SeamTrees::Node> tree;
    flatten(0, tree);
    return tree;
  }

private:
  static constexpr std::size_t DONE = static_cast<std::size_t>(-1);

  std::size_t branch(std::size_t k, const Sample& sample) const {
    const auto& node = m_heap[k];
    return 2 * k + 1 + (sample.evidence[node.clue] > node.at);
  }

  bool split(SeamTrees::Node& node, const double* g, const double* h, double sum,
             double weight) const {
    double best = 1e-3;
    const double base = sum * sum / (weight + m_how.ridge);
    for (std::size_t c = 0; c < m_clues; ++c) {
      double below = 0, own = 0;
      for (std::size_t q = 0; q + 1 < CLASSES && m_used[c]; ++q) {
        below += g[c * CLASSES + q];
        own += h[c * CLASSES + q];
        const double rest = weight - own;
        if (own < m_how.least_weight || rest < m_how.least_weight)
          continue;
        const double gain = below * below / (own + m_how.ridge) +
                            (sum - below) * (sum - below) / (rest + m_how.ridge) - base;
        if (gain > best) {
          best = gain;
          node.clue = static_cast<int>(c);
          node.at = static_cast<int>(q);
        }
      }
    }
    return node.clue >= 0;
  }

  std::size_t flatten(std::size_t k, std::vector<SeamTrees::Node>& tree) const {
    const std::size_t own = tree.size();
    tree.push_back(m_heap[k]);
    if (tree[own].clue < 0) {
      tree[own].value = std::round(tree[own].value * 1000) / 1000;
      return own;
    }
    flatten(2 * k + 1, tree);
    const std::size_t second = flatten(2 * k + 2, tree);
    tree[own].second = second;
    return own;
  }

  const std::vector<const Sample*>& m_samples;
  std::size_t m_clues;
  const Boosting& m_how;
  std::vector<char> m_used;
  std::vector<std::size_t> m_rows, m_node;
  std::vector<SeamTrees::Node> m_heap;
};

} // namespace

SeamTrees boost(const std::vector<const Sample*>& samples, std::size_t clues, const Boosting& how) {
  SeamTrees out;
  double sewn = 0, all = 0;
  for (const Sample* s : samples) {
    sewn += s->sewn ? s->weight : 0;
    all += s->weight;
  }
  out.constant = std::round(std::log(sewn / std::max(all - sewn, 1e-9)) * 1000) / 1000;
  std::mt19937_64 random(12345);
  std::vector<double> odds(samples.size(), out.constant);
  std::vector<float> slope(samples.size()), curve(samples.size());
  for (int t = 0; t < how.trees; ++t) {
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const double p = 1 / (1 + std::exp(-odds[k])), w = samples[k]->weight;
      slope[k] = static_cast<float>(w * (samples[k]->sewn - p));
      curve[k] = static_cast<float>(w * std::max(p * (1 - p), 1e-9));
    }
    SeamTrees one;
    one.trees.push_back(Growing(samples, clues, how, random).grow(slope, curve));
    for (std::size_t k = 0; k < samples.size(); ++k)
      odds[k] += one(samples[k]->evidence);
    out.trees.push_back(std::move(one.trees[0]));
  }
  return out;
}

static void node_text(const std::vector<SeamTrees::Node>& tree, std::size_t k, std::string& text) {
  const SeamTrees::Node& node = tree[k];
  if (!text.empty())
    text += ',';
  if (node.clue < 0) {
    text += "-1," + std::to_string(std::lround(node.value * 1000));
    return;
  }
  text += std::to_string(node.clue) + ',' + std::to_string(node.at);
  node_text(tree, k + 1, text);
  node_text(tree, node.second, text);
}

std::string trees_text(const SeamTrees& trees) {
  std::string out = "{\"constant\": " + std::to_string(trees.constant) + ", \"trees\": [\n";
  for (std::size_t k = 0; k < trees.trees.size(); ++k) {
    std::string text;
    node_text(trees.trees[k], 0, text);
    out += "[" + text + (k + 1 < trees.trees.size() ? "],\n" : "]\n");
  }
  return out + "]}";
}

} // namespace sloper::pattern::fit
