#include <sloper/garment/simulate/body_moves.hpp>

#include <sloper/base/error.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/obj.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace sloper::garment {

namespace {

constexpr double LEAD_IN_SPEED = 0.5, SHORTEST_LEAD_IN = 0.2; // m/s, s

std::size_t lead_in_frames(const std::vector<Vec3>& from, const std::vector<Vec3>& to,
                           double frame_s) {
  double farthest = 0;
  for (std::size_t v = 0; v < from.size(); ++v)
    farthest = std::max(farthest, (to[v] - from[v]).norm());
  return static_cast<std::size_t>(
      std::ceil(std::max(SHORTEST_LEAD_IN, farthest / LEAD_IN_SPEED) / frame_s));
}

/// Starts and ends gently: 3 t^2 - 2 t^3.
double eased(double t) {
  return t * t * (3 - 2 * t);
}

/// NAME.0007.obj with another number of as many digits.
std::string numbered(const std::string& first, std::size_t number) {
  const std::size_t dot = first.rfind('.');
  std::size_t digits = 0;
  while (digits < dot && std::isdigit(static_cast<unsigned char>(first[dot - 1 - digits])))
    ++digits;
  std::string text = std::to_string(number);
  if (text.size() < digits)
    text.insert(0, digits - text.size(), '0');
  return first.substr(0, dot - digits) + text + first.substr(dot);
}

std::size_t number_of(const std::string& first) {
  const std::size_t dot = first.rfind('.');
  std::size_t begin = dot == std::string::npos ? 0 : dot;
  while (begin > 0 && std::isdigit(static_cast<unsigned char>(first[begin - 1])))
    --begin;
  if (dot == std::string::npos || begin == dot || dot - begin > 9)
    throw input_error("motion.unknown-kind"_id, first, "",
                      "is neither a BVH motion nor a numbered skin",
                      "give walk.bvh, or the first file of a sequence such as body.0001.obj");
  return std::stoul(first.substr(begin, dot - begin));
}

} // namespace

BodyMoves moves_of(const body::Body& body, const body::Motion& motion) {
  if (motion.poses.empty())
    throw input_error("motion.no-pose"_id, "", "motion", "has no pose",
                      "give a motion with one frame at least");
  BodyMoves moves;
  if (motion.frame_s > 0)
    moves.frame_s = motion.frame_s;
  const auto weights = std::make_shared<body::SkinWeights>(body::skin_weights(body));
  const auto poses = std::make_shared<std::vector<body::Pose>>(motion.poses);
  moves.lead_in = lead_in_frames(body.skin.positions,
                                 body::posed_skin(body, *weights, poses->front()), moves.frame_s);
  moves.n_frames = moves.lead_in + poses->size();
  moves.skin = [&body, weights, poses, lead = moves.lead_in](std::size_t k) {
    if (k >= lead)
      return body::posed_skin(body, *weights, (*poses)[k - lead]);
    const double t = eased(static_cast<double>(k + 1) / static_cast<double>(lead));
    body::Pose pose = poses->front();
    for (auto& [joint, turn] : pose.turn)
      turn = Eigen::Quaterniond::Identity().slerp(t, turn);
    pose.shift *= t;
    return body::posed_skin(body, *weights, pose);
  };
  moves.end = std::make_shared<body::Body>(body::posed_body(body, *weights, poses->back()));
  return moves;
}

BodyMoves moves_of_files(const body::Body& body, const std::string& first_file, double frame_s) {
  const std::size_t first = number_of(first_file);
  std::size_t count = 0;
  while (std::filesystem::exists(numbered(first_file, first + count)))
    ++count;
  if (count == 0)
    throw input_error("file.not-found"_id, first_file, "", "the file does not exist",
                      "write the sequence with scan-landmarks --pose motion.bvh");
  BodyMoves moves;
  moves.frame_s = frame_s;
  const auto read = [&body, first_file, first](std::size_t k) {
    const std::string path = numbered(first_file, first + k);
    io::ObjMesh obj = io::read_obj(path);
    if (obj.positions.size() != body.skin.positions.size() || obj.triangles != body.skin.triangles)
      throw input_error("motion.other-body"_id, path, "",
                        "is not the skin of the body in another pose: its vertices or faces differ",
                        "pose the same body that the garment is draped on");
    return std::move(obj.positions);
  };
  const auto begin = std::make_shared<std::vector<Vec3>>(read(0));
  moves.lead_in = lead_in_frames(body.skin.positions, *begin, frame_s);
  moves.n_frames = moves.lead_in + count;
  moves.skin = [&body, read, begin, lead = moves.lead_in](std::size_t k) {
    if (k >= lead)
      return read(k - lead);
    const double t = eased(static_cast<double>(k + 1) / static_cast<double>(lead));
    std::vector<Vec3> skin = body.skin.positions;
    for (std::size_t v = 0; v < skin.size(); ++v)
      skin[v] += t * ((*begin)[v] - skin[v]);
    return skin;
  };
  return moves;
}

std::string motion_sha256(const std::string& file) {
  if (file.ends_with(".bvh"))
    return io::sha256(io::read_file(file));
  std::string sums;
  for (std::size_t number = number_of(file); std::filesystem::exists(numbered(file, number));
       ++number)
    sums += io::sha256(io::read_file(numbered(file, number)));
  return io::sha256(sums);
}

BodyMoves read_moves(const body::Body& body, const std::string& file, double frame_s) {
  return file.ends_with(".bvh") ? moves_of(body, body::read_bvh(file, body, frame_s))
                                : moves_of_files(body, file, frame_s);
}

} // namespace sloper::garment
