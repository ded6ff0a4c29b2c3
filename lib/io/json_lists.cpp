#include <sloper/io/json.hpp>
#include <sloper/io/json_lists.hpp>

namespace sloper::io {

Json flat_points(const std::vector<Vec3>& points) {
  Json out = Json::array();
  for (const Vec3& p : points)
    for (int k = 0; k < 3; ++k)
      out.push_back(p[k]);
  return out;
}

std::vector<Vec3> read_flat_points(const Node& node) {
  if (node.size() % 3 != 0)
    node.fail("json.wrong-count"_id, "the number of coordinates is not a multiple of three");
  std::vector<Vec3> points(node.size() / 3);
  for (std::size_t i = 0; i < node.size(); ++i)
    points[i / 3][static_cast<int>(i % 3)] = node.at(i).number();
  return points;
}

std::vector<double> read_numbers(const Node& node) {
  std::vector<double> list(node.size());
  for (std::size_t i = 0; i < list.size(); ++i)
    list[i] = node.at(i).number();
  return list;
}

std::vector<int> read_integers(const Node& node) {
  std::vector<int> list(node.size());
  for (std::size_t i = 0; i < list.size(); ++i)
    list[i] = node.at(i).integer();
  return list;
}

std::vector<std::string> read_strings(const Node& node) {
  std::vector<std::string> list(node.size());
  for (std::size_t i = 0; i < list.size(); ++i)
    list[i] = node.at(i).string();
  return list;
}

void put_findings(Json& document, const std::vector<Message>& findings) {
  Json texts = Json::array(), ids = Json::array();
  for (const Message& finding : findings) {
    texts.push_back(finding.text);
    ids.push_back(finding.id);
  }
  document["findings"] = texts;
  if (!findings.empty())
    document["finding_ids"] = ids;
}

std::vector<Message> read_findings(const Node& document) {
  std::vector<Message> findings;
  if (!document.has("findings"))
    return findings;
  const Node texts = document.at("findings");
  const bool has_ids = document.has("finding_ids");
  for (std::size_t k = 0; k < texts.size(); ++k) {
    const std::string id = has_ids ? document.at("finding_ids").at(k).string() : "";
    findings.push_back(Message::read(id, texts.at(k).string()));
  }
  return findings;
}

} // namespace sloper::io
