#pragma once
/// Files that a run was made from, and whether they belong together.
#include <sloper/base/message.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/io/json_fwd.hpp>

namespace sloper::garment {

/// For a report's `inputs`: {"file", "sha256"}. @throws Error INPUT when it cannot be read
io::Json input_entry(const std::string& path);

/// A garment or placed panels about to be draped on a body, with their files' names.
struct Start {
  std::string file;        ///< panels.json or shirt.json
  std::string body;        ///< body.json; empty: none
  std::string skin_sha256; ///< of the body's skin, body::skin_sha256()
  bool draped = false;     ///< it comes from a garment document
};

/// Warnings before cloth and body meet: panels that were placed around another body, or
/// around none and lie flat; a garment that was draped on another body; a body that was
/// there before and is not given now. Empty where nothing is known (documents of older
/// programs).
/// @param garment  as read: Garment::body_sha256 is of the body that it hung on
std::vector<Message> start_findings(const Garment& garment, const Start& start);

} // namespace sloper::garment
