#include <sloper/garment/inputs.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

namespace sloper::garment {

io::Json input_entry(const std::string& path) {
  return {{"file", io::file_name(path)}, {"sha256", io::sha256(io::read_file(path))}};
}

namespace {

/// Whether it lies on the body that it was made for, or nothing.
std::vector<Message> body_findings(const Garment& garment, const Start& start) {
  const std::string file = io::file_name(start.file), body = io::file_name(start.body);
  if (start.body.empty()) {
    if (garment.body_sha256.empty() && garment.panels.body_sha256.empty())
      return {};
    return {{"garment.body-absent"_id,
             file + (start.draped ? " hung on" : " was placed around") +
                 " a body, and none is given: it falls with nothing to hold it; give --body"}};
  }
  if (start.draped) {
    if (garment.body_sha256.empty() || garment.body_sha256 == start.skin_sha256)
      return {};
    return {{"garment.other-body"_id, file + " hung on another body than " + body +
                                          ", which it may lie inside of; retarget-garment --to " +
                                          body + " places it"}};
  }
  const std::string place = "; place them with pattern-mesh --body " + body;
  if (garment.panels.placement == pattern::Placement::FLAT)
    return {
        {"garment.panels-flat"_id, "the panels of " + file + " lie flat, around no body" + place}};
  const std::string& around = garment.panels.body_sha256;
  if (around.empty() || around == start.skin_sha256)
    return {};
  return {{"garment.other-body"_id,
           "the panels of " + file + " were placed around another body than " + body + place}};
}

} // namespace

std::vector<Message> start_findings(const Garment& garment, const Start& start) {
  std::vector<Message> findings = body_findings(garment, start);
  if (garment.panels.seams.empty() && garment.panels.panels.size() > 1)
    findings.push_back({"garment.no-seams"_id,
                        io::file_name(start.file) + " has no seams: nothing holds its " +
                            std::to_string(garment.panels.panels.size()) + " panels together"});
  return findings;
}

} // namespace sloper::garment
