#pragma once
/// JSON documents: strict reading, deterministic writing, the envelope {"format", "version",
/// "generator", "length_unit"}. For headers, and for sources that only pass documents on; what
/// looks into a Json includes <io/json.hpp>, which is dear to compile.
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <sloper/base/error.hpp>
#include <sloper/geometry/types.hpp>
#include <string>
#include <vector>

namespace sloper::io {

using Json = nlohmann::ordered_json; ///< keys stay in the order in which they were written

/// Reads a JSON file, or standard input for "-". Refuses duplicate keys, NaN, trailing bytes.
/// @throws Error INPUT with file, line and fact.
Json read_json(const std::string& path);
/// The same from text.
/// @param name  for messages
Json parse_json(const std::string& text, const std::string& name);

/// Reads a document and checks its envelope. A newer version than `newest` is refused,
/// older ones are returned as they are.
/// @param format  such as "body"
/// @throws Error INPUT
Json read_document(const std::string& path, const std::string& format, int newest);
/// The same check for a document in memory.
/// @param path  for messages
void check_envelope(const Json& document, const std::string& path, const std::string& format,
                    int newest);

/// {"format", "version", "generator", "length_unit": "m"}, to be filled.
Json new_document(const std::string& format, int version, const std::string& tool);

/// Text of a document: two-space indent, arrays of plain numbers on one line, shortest round-trip
/// numbers, final newline.
/// @throws Error INTERNAL when a number is not finite.
std::string to_text(const Json& document);

/// Writes to a temporary file beside `path` and renames; "-" is standard output. @throws Error
/// OUTPUT
void write_json(const std::string& path, const Json& document);

/// A value inside a document that knows its file and place, so that every complaint names both.
class Node {
public:
  /// @param value  outlives this
  /// @param file  for messages
  /// @param pointer  JSON pointer of the value
  Node(const Json& value, std::string file, std::string pointer = {})
      : m_value(&value), m_file(std::move(file)), m_pointer(std::move(pointer)) {}
  /// A member of an object.
  /// @throws Error INPUT when absent
  Node at(const std::string& key) const;
  /// An item of an array.
  /// @throws Error INPUT when there are fewer
  Node at(std::size_t index) const;
  /// Whether it is an object with this key.
  bool has(const std::string& key) const;
  /// Number of members or items.
  std::size_t size() const;
  /// Type of the value.
  bool is_array() const;
  bool is_object() const;
  bool is_string() const;
  bool is_number() const;
  bool is_null() const;
  /// The value as a finite number.
  /// @throws Error INPUT for any other type, as all of these
  double number() const;
  /// A member of the object, or the fallback where the key is absent; the same for the
  /// other types.
  double number(const std::string& key, double fallback) const;
  /// A whole number of at most 2e9 in size.
  int integer() const;
  /// A member, or the fallback.
  int integer(const std::string& key, int fallback) const;
  /// true or false.
  bool boolean() const;
  /// A member, or the fallback.
  bool boolean(const std::string& key, bool fallback) const;
  /// A text.
  std::string string() const;
  /// A member, or the fallback.
  std::string string(const std::string& key, const std::string& fallback) const;
  /// An array of two numbers.
  Vec2 vec2() const;
  /// An array of three numbers.
  Vec3 vec3() const;
  /// Keys of an object in the order of the document.
  std::vector<std::string> keys() const;
  /// For documents that people write: any other key is an error with a suggestion.
  void allow_only(std::initializer_list<const char*> keys) const;
  /// Throws Error INPUT with the file and the pointer of this value.
  /// @param id  the message, as docs/messages.md lists it
  /// @param fact  what is wrong
  /// @param next_step  what to do, or empty
  [[noreturn]] void fail(MessageId id, const std::string& fact,
                         const std::string& next_step = {}) const;
  /// The value, its JSON pointer and its file.
  const Json& json() const { return *m_value; }
  const std::string& pointer() const { return m_pointer; }
  const std::string& file() const { return m_file; }

private:
  const Json* m_value;
  std::string m_file, m_pointer;
};

/// "findings", a text each, and beside it "finding_ids", where there are any.
void put_findings(Json& document, const std::vector<Message>& findings);
/// What put_findings() wrote; ids are empty in documents of before they were. @throws Error INPUT
std::vector<Message> read_findings(const Node& document);

/// [x, y].
Json to_json(const Vec2& v);
/// [x, y, z].
Json to_json(const Vec3& v);

/// Path of the OBJ that goes with a document: `.json` replaced by `.obj` (appended when there is no
/// `.json`).
std::string mesh_path_beside(const std::string& document_path);
/// File name without its folder.
std::string file_name(const std::string& path);
/// ".png" of out.PNG; empty where there is none.
std::string ending_of(const std::string& path);
/// `name` resolved beside the document at `document_path`.
std::string path_beside(const std::string& document_path, const std::string& name);
/// Path of the file that a document names, beside the document. @throws Error INPUT at the name
/// when it is not there
std::string file_beside(const Node& name);
/// Puts the hash of the mesh file's bytes into a document, as "mesh_sha256".
void put_mesh_hash(Json& document, std::string_view mesh_bytes);
/// A warning when the mesh beside a document is not the one that was written with it; empty where
/// the document has no "mesh_sha256": older programs wrote none.
/// @param mesh_path  file_beside() of the document's "mesh"
/// Cost: the file is read and hashed once more. @throws Error INPUT when it cannot be read
std::vector<Message> mesh_findings(const Node& document, const std::string& mesh_path);

} // namespace sloper::io
