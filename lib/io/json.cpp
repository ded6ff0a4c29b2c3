#include <sloper/base/version.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>

namespace sloper::io {

namespace {

/// Refuses duplicate keys, which nlohmann accepts silently (the last one wins).
class DuplicateKeyCheck {
public:
  explicit DuplicateKeyCheck(const std::string& name) : m_name(name) {}
  bool operator()(int /*depth*/, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start)
      m_keys.emplace_back();
    else if (event == Json::parse_event_t::object_end)
      m_keys.pop_back();
    else if (event == Json::parse_event_t::key &&
             !m_keys.back().insert(parsed.get<std::string>()).second)
      throw input_error("json.duplicate-key"_id, m_name, "",
                        "the key \"" + parsed.get<std::string>() + "\" appears twice in one object",
                        "remove one of them");
    return true;
  }

private:
  std::string m_name;
  std::vector<std::set<std::string>> m_keys;
};

bool is_flat_array(const Json& value) {
  for (const Json& v : value)
    if (v.is_structured())
      return false;
  return true;
}

void append_text(std::string& out, const Json& value, int indent, const std::string& pointer) {
  switch (value.type()) {
  case Json::value_t::number_float: {
    const double x = value.get<double>();
    if (!std::isfinite(x))
      throw Error(ErrorKind::INTERNAL, "general.internal"_id, "", pointer,
                  "a number to be written is not finite");
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, x == 0 ? 0.0 : x).ptr; // no "-0"
    out.append(buffer, end);
    break;
  }
  case Json::value_t::array: {
    const bool flat = is_flat_array(value);
    out += '[';
    std::size_t i = 0;
    for (const Json& v : value) {
      if (i)
        out += flat ? ", " : ",";
      if (!flat)
        out += '\n' + std::string(static_cast<std::size_t>(indent) + 2, ' ');
      append_text(out, v, indent + 2, pointer + "/" + std::to_string(i));
      ++i;
    }
    if (!flat && i)
      out += '\n' + std::string(static_cast<std::size_t>(indent), ' ');
    out += ']';
    break;
  }
  case Json::value_t::object: {
    out += '{';
    bool first = true;
    for (const auto& [key, v] : value.items()) {
      if (!first)
        out += ',';
      first = false;
      out += '\n' + std::string(static_cast<std::size_t>(indent) + 2, ' ') +
             Json(key).dump(-1, ' ', false, Json::error_handler_t::replace) + ": ";
      append_text(out, v, indent + 2, pointer + "/" + key);
    }
    if (!first)
      out += '\n' + std::string(static_cast<std::size_t>(indent), ' ');
    out += '}';
    break;
  }
  default: out += value.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
}

/// The word around a byte, counted from 1, and the column at which it begins.
std::pair<std::string, std::size_t> word_at(const std::string& text, std::size_t byte) {
  const auto in_word = [&](std::size_t at) {
    return std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '-' ||
           text[at] == '+';
  };
  std::size_t begin = std::min(byte > 0 ? byte - 1 : 0, text.size());
  std::size_t end = begin;
  while (begin > 0 && in_word(begin - 1))
    --begin;
  while (end < text.size() && in_word(end))
    ++end;
  const std::size_t line_end = begin > 0 ? text.rfind('\n', begin - 1) : std::string::npos;
  return {text.substr(begin, end - begin),
          line_end == std::string::npos ? begin + 1 : begin - line_end};
}

/// What other programs write for numbers that are not finite.
bool is_no_number(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (!word.empty() && (word[0] == '-' || word[0] == '+'))
    word.erase(0, 1);
  return word == "nan" || word == "inf" || word == "infinity";
}

} // namespace

Json parse_json(const std::string& text, const std::string& name) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw input_error("file.empty"_id, name, "", "the file is empty", "expected a JSON document");
  Json value;
  try {
    value = Json::parse(text, DuplicateKeyCheck(name));
  } catch (const Json::parse_error& e) {
    std::size_t line = 1;
    for (std::size_t i = 0; i + 1 < e.byte && i < text.size(); ++i)
      line += text[i] == '\n';
    // Meshes lie beside their documents, and scans come before them: the commonest slip.
    for (const char* ending : {".obj", ".ply", ".stl", ".3ds", ".xyz"})
      if (name.size() > 4 && name.compare(name.size() - 4, 4, ending) == 0)
        throw input_error(
            "json.is-mesh"_id, name, "line " + std::to_string(line),
            "is a mesh, not a JSON document",
            "give the .json that was written with it; for a scan, make one with scan-landmarks");
    if (const auto [word, column] = word_at(text, e.byte); is_no_number(word))
      throw input_error("json.not-finite"_id, name,
                        "line " + std::to_string(line) + ", column " + std::to_string(column),
                        "'" + word + "' is not a number", "give a finite number");
    throw input_error("json.syntax"_id, name, "line " + std::to_string(line), "not valid JSON",
                      "check that the file is complete and is a JSON document");
  } catch (const Json::out_of_range&) {
    throw input_error("json.not-finite"_id, name, "", "a number is too large for double precision");
  }
  return value;
}

Json read_json(const std::string& path) {
  return parse_json(read_file(path), path == "-" ? "standard input" : path);
}

/// What was expected, and where such a document comes from.
static std::string expected_document(const std::string& format) {
  const std::pair<const char*, const char*> makers[] = {{"body", "scan-landmarks"},
                                                        {"panels", "pattern-mesh"},
                                                        {"garment", "drape or retarget-garment"},
                                                        {"fit", "retarget-garment --fit"}};
  for (const auto& [name, maker] : makers)
    if (format == name)
      return "expected a \"" + format + "\" document, as " + maker + " writes it";
  return "expected a \"" + format + "\" document";
}

Json read_document(const std::string& path, const std::string& format, int newest) {
  Json document = read_json(path);
  check_envelope(document, path, format, newest);
  return document;
}

void check_envelope(const Json& document, const std::string& path, const std::string& format,
                    int newest) {
  const std::string name = path == "-" ? "standard input" : path;
  const Node node(document, name);
  if (!node.is_object() || !node.has("format"))
    throw input_error("json.wrong-format"_id, name, "/format", "is not a Sloper document",
                      expected_document(format));
  if (const std::string got = node.at("format").string(); got != format)
    throw input_error("json.wrong-format"_id, name, "/format", "is a \"" + got + "\" document",
                      expected_document(format));
  const int version = node.at("version").integer();
  if (version < 1)
    throw input_error("json.wrong-version"_id, name, "/version",
                      std::to_string(version) + " is not a version",
                      "expected 1 to " + std::to_string(newest));
  if (version > newest)
    throw input_error("json.newer-version"_id, name, "/version",
                      "version " + std::to_string(version) + " is newer than version " +
                          std::to_string(newest) + ", the newest this program reads",
                      "update Sloper");
}

Json new_document(const std::string& format, int version, const std::string& tool) {
  Json document;
  document["format"] = format;
  document["version"] = version;
  document["generator"] = generator_stamp(tool);
  document["length_unit"] = "m";
  return document;
}

std::string to_text(const Json& document) {
  std::string out;
  append_text(out, document, 0, "");
  out += '\n';
  return out;
}

void write_json(const std::string& path, const Json& document) {
  write_file(path, to_text(document));
}

bool Node::has(const std::string& key) const {
  return m_value->is_object() && m_value->contains(key);
}
std::size_t Node::size() const {
  return m_value->size();
}
bool Node::is_array() const {
  return m_value->is_array();
}
bool Node::is_object() const {
  return m_value->is_object();
}
bool Node::is_string() const {
  return m_value->is_string();
}
bool Node::is_number() const {
  return m_value->is_number();
}
bool Node::is_null() const {
  return m_value->is_null();
}

Node Node::at(const std::string& key) const {
  if (!m_value->is_object())
    fail("json.wrong-type"_id, "expected an object");
  const auto found = m_value->find(key);
  if (found == m_value->end())
    fail("json.missing-key"_id, "\"" + key + "\" is missing",
         "add it, or write the file again with the program that makes it");
  return {*found, m_file, m_pointer + "/" + key};
}

Node Node::at(std::size_t index) const {
  if (!m_value->is_array())
    fail("json.wrong-type"_id, "expected an array");
  if (index >= m_value->size())
    fail("json.wrong-count"_id, "has only " + std::to_string(m_value->size()) + " items");
  return {(*m_value)[index], m_file, m_pointer + "/" + std::to_string(index)};
}

double Node::number() const {
  if (!m_value->is_number())
    fail("json.wrong-type"_id, "expected a number");
  const double x = m_value->get<double>();
  if (!std::isfinite(x))
    fail("json.not-finite"_id, "the number is not finite");
  return x;
}

int Node::integer() const {
  const double x = number();
  if (!(x == std::floor(x) && std::abs(x) <= 2e9))
    fail("json.wrong-type"_id, "expected a whole number");
  return static_cast<int>(x);
}

bool Node::boolean() const {
  if (!m_value->is_boolean())
    fail("json.wrong-type"_id, "expected true or false");
  return m_value->get<bool>();
}

std::string Node::string() const {
  if (!m_value->is_string())
    fail("json.wrong-type"_id, "expected a text");
  return m_value->get<std::string>();
}

double Node::number(const std::string& key, double fallback) const {
  return has(key) ? at(key).number() : fallback;
}
int Node::integer(const std::string& key, int fallback) const {
  return has(key) ? at(key).integer() : fallback;
}
bool Node::boolean(const std::string& key, bool fallback) const {
  return has(key) ? at(key).boolean() : fallback;
}
std::string Node::string(const std::string& key, const std::string& fallback) const {
  return has(key) ? at(key).string() : fallback;
}

Vec2 Node::vec2() const {
  if (!m_value->is_array() || m_value->size() != 2)
    fail("json.wrong-type"_id, "expected two numbers");
  return {at(std::size_t{0}).number(), at(std::size_t{1}).number()};
}

Vec3 Node::vec3() const {
  if (!m_value->is_array() || m_value->size() != 3)
    fail("json.wrong-type"_id, "expected three numbers");
  return {at(std::size_t{0}).number(), at(std::size_t{1}).number(), at(std::size_t{2}).number()};
}

std::vector<std::string> Node::keys() const {
  if (!m_value->is_object())
    fail("json.wrong-type"_id, "expected an object");
  std::vector<std::string> keys;
  for (const auto& item : m_value->items())
    keys.push_back(item.key());
  return keys;
}

void Node::allow_only(std::initializer_list<const char*> allowed) const {
  const std::vector<std::string> words(allowed.begin(), allowed.end());
  for (const std::string& key : keys()) {
    if (std::find(words.begin(), words.end(), key) != words.end())
      continue;
    fail("json.unknown-key"_id, "unknown key \"" + key + "\"" + did_you_mean(key, words, "\""));
  }
}

void Node::fail(MessageId id, const std::string& fact, const std::string& next_step) const {
  throw input_error(id, m_file, m_pointer.empty() ? "/" : m_pointer, fact, next_step);
}

Json to_json(const Vec2& v) {
  return Json::array({v.x(), v.y()});
}
Json to_json(const Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

std::string mesh_path_beside(const std::string& path) {
  const std::string ending = ".json";
  if (path.size() > ending.size() &&
      path.compare(path.size() - ending.size(), ending.size(), ending) == 0)
    return path.substr(0, path.size() - ending.size()) + ".obj";
  return path + ".obj";
}

std::string file_name(const std::string& path) {
  const auto slash = path.rfind('/');
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

std::string ending_of(const std::string& path) {
  const std::string name = file_name(path);
  const std::size_t dot = name.rfind('.');
  std::string ending = dot == std::string::npos ? "" : name.substr(dot);
  for (char& c : ending)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

std::string path_beside(const std::string& document_path, const std::string& name) {
  if (!name.empty() && name[0] == '/')
    return name;
  const auto slash = document_path.rfind('/');
  return slash == std::string::npos ? name : document_path.substr(0, slash + 1) + name;
}

std::string file_beside(const Node& name) {
  std::string path = path_beside(name.file(), name.string());
  if (!std::filesystem::exists(path))
    name.fail("file.missing-beside"_id, "there is no " + path,
              "keep it beside the document under this name, or write both again");
  return path;
}

void put_mesh_hash(Json& document, std::string_view mesh_bytes) {
  document["mesh_sha256"] = sha256(mesh_bytes);
}

std::vector<Message> mesh_findings(const Node& document, const std::string& mesh_path) {
  const std::string written = document.string("mesh_sha256", "");
  if (written.empty() || written == sha256(read_file(mesh_path)))
    return {};
  return {{"file.mesh-changed"_id,
           mesh_path + " is not the mesh that " + file_name(document.file()) +
               " was written with: it was changed or exchanged, and the rest of the document is "
               "taken to hold for it; write both again"}};
}

} // namespace sloper::io
