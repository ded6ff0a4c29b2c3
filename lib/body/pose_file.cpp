#include <sloper/base/error.hpp>
#include <sloper/base/units.hpp>
#include <sloper/body/pose_file.hpp>
#include <sloper/geometry/rotation.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace sloper::body {

namespace {

/// A word of the file, cut where it is endless.
std::string quoted(std::string_view word) {
  std::string out(1, '"');
  out += word.substr(0, 30);
  return out += '"';
}

using Eigen::Quaterniond;

constexpr int MAX_JOINTS = 2000, MAX_FRAMES = 2'000'000;

Quaterniond about(int axis, double radians) {
  return Quaterniond(Eigen::AngleAxisd(radians, Vec3::Unit(axis)));
}

struct BvhJoint {
  std::string name;
  int parent = -1;
  Vec3 offset = Vec3::Zero();
  std::vector<int> channels; ///< 0..2 position x, y, z; 3..5 rotation about x, y, z
  int first_channel = 0;
};

struct Bvh {
  std::vector<BvhJoint> joints; ///< parents first
  int n_channels = 0;
  double frame_s = 0;
  std::vector<double> values; ///< frame by frame
  int frames = 0;
};

/// Words of a BVH text with their line numbers.
class Words {
public:
  Words(std::string_view text, const std::string& name) : m_text(text), m_name(name) {}
  std::string_view next() {
    while (m_at < m_text.size() && (m_text[m_at] == ' ' || m_text[m_at] == '\t' ||
                                    m_text[m_at] == '\r' || m_text[m_at] == '\n'))
      m_line += m_text[m_at++] == '\n';
    const std::size_t begin = m_at;
    while (m_at < m_text.size() && !(m_text[m_at] == ' ' || m_text[m_at] == '\t' ||
                                     m_text[m_at] == '\r' || m_text[m_at] == '\n'))
      ++m_at;
    return m_text.substr(begin, m_at - begin);
  }
  std::string_view must() {
    const std::string_view word = next();
    if (word.empty())
      fail("the file ends early", "the copy is probably truncated");
    return word;
  }
  void expect(const char* wanted) {
    if (const std::string_view word = must(); word != wanted)
      fail(quoted(word) + " where " + quoted(wanted) + " should stand");
  }
  double number() {
    std::string_view word = must();
    if (word[0] == '+')
      word.remove_prefix(1);
    double x = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), x);
    if (word.empty() || result.ec != std::errc() || result.ptr != word.data() + word.size() ||
        !std::isfinite(x))
      fail(quoted(word) + " is not a finite number");
    return x;
  }
  int count(int most, const char* what) {
    const double x = number();
    if (x < 0 || x > most || x != std::floor(x))
      fail(std::string("is not a count of ") + what);
    return static_cast<int>(x);
  }
  [[noreturn]] void fail(const std::string& fact, const std::string& next_step = {}) const {
    throw input_error("motion.malformed"_id, m_name, "line " + std::to_string(m_line), fact,
                      next_step);
  }

private:
  std::string_view m_text;
  std::string m_name;
  std::size_t m_at = 0;
  int m_line = 1;
};

Bvh parse(std::string_view text, const std::string& name) {
  Words words(text, name);
  Bvh bvh;
  words.expect("HIERARCHY");
  words.expect("ROOT");
  std::vector<int> open; // joints whose brace is open; -1 for an end site
  auto begin = [&](int parent) {
    if (bvh.joints.size() >= MAX_JOINTS)
      words.fail("has more joints than any body");
    BvhJoint joint;
    joint.name = std::string(words.must());
    joint.parent = parent;
    joint.first_channel = bvh.n_channels;
    bvh.joints.push_back(joint);
    open.push_back(static_cast<int>(bvh.joints.size()) - 1);
    words.expect("{");
  };
  begin(-1);
  while (!open.empty()) {
    const std::string_view word = words.must();
    if (word == "}")
      open.pop_back();
    else if (word == "OFFSET") {
      Vec3 offset;
      for (int axis = 0; axis < 3; ++axis)
        offset[axis] = words.number();
      if (open.back() >= 0)
        bvh.joints[open.back()].offset = offset;
      else if (open.size() > 1) { // an end site: kept as a joint without channels, so that the last
                                  // bone has a direction
        BvhJoint end;
        end.parent = open[open.size() - 2];
        end.offset = offset;
        end.first_channel = bvh.n_channels;
        bvh.joints.push_back(end);
      }
    } else if (word == "CHANNELS") {
      if (open.back() < 0)
        words.fail("an end site has no channels");
      const int n = words.count(6, "channels");
      for (int k = 0; k < n; ++k) {
        static const char* names[] = {"Xposition", "Yposition", "Zposition",
                                      "Xrotation", "Yrotation", "Zrotation"};
        const std::string_view channel = words.must();
        const auto* it = std::find(std::begin(names), std::end(names), channel);
        if (it == std::end(names))
          words.fail(quoted(channel) + " is not a BVH channel");
        bvh.joints[open.back()].channels.push_back(static_cast<int>(it - std::begin(names)));
      }
      bvh.joints[open.back()].first_channel = bvh.n_channels;
      bvh.n_channels += n;
    } else if (word == "JOINT") {
      if (open.back() < 0)
        words.fail("an end site has no joints");
      begin(open.back());
    } else if (word == "End") {
      words.expect("Site");
      words.expect("{");
      if (open.back() < 0)
        words.fail("an end site within an end site");
      open.push_back(-1);
    } else
      words.fail(quoted(word) + " is not expected in a hierarchy");
  }
  words.expect("MOTION");
  words.expect("Frames:");
  bvh.frames = words.count(MAX_FRAMES, "frames");
  words.expect("Frame");
  words.expect("Time:");
  bvh.frame_s = words.number();
  if (bvh.frame_s <= 0)
    words.fail("the time between frames is not positive");
  if (bvh.frames == 0 || bvh.n_channels == 0)
    words.fail("holds no motion");
  for (int f = 0; f < bvh.frames; ++f)
    for (int c = 0; c < bvh.n_channels; ++c)
      bvh.values.push_back(words.number());
  return bvh;
}

/// Our joint and the names that BVH files have for it, lower case, the left ones.
struct Names {
  const char* ours;
  std::initializer_list<const char*> theirs;
};
const Names SIDED[] = {
    {"clavicle", {"leftcollar", "lcollar", "leftclavicle"}},
    {"upper_arm", {"leftarm", "leftuparm", "leftupperarm", "lshldr", "lshoulder", "leftshoulder"}},
    {"forearm", {"leftforearm", "leftlowarm", "leftlowerarm", "lforearm", "leftelbow", "lelbow"}},
    {"hand", {"lefthand", "lhand", "leftwrist", "lwrist"}},
    {"thigh", {"leftupleg", "leftupperleg", "leftthigh", "lthigh", "lhip", "lefthip"}},
    {"shin", {"leftleg", "leftlowleg", "leftlowerleg", "leftshin", "lshin", "leftknee", "lknee"}},
    {"foot", {"leftfoot", "lfoot", "leftankle", "lankle"}}};

std::string plain_name(std::string name) {
  if (const auto colon = name.rfind(':'); colon != std::string::npos)
    name.erase(0, colon + 1);
  std::string out;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)))
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

int find_joint(const Bvh& bvh, std::initializer_list<const char*> names, bool left) {
  for (const char* wanted : names) {
    std::string name = wanted;
    if (!left)
      name.replace(0, name.starts_with("left") ? 4 : 1, name.starts_with("left") ? "right" : "r");
    for (std::size_t j = 0; j < bvh.joints.size(); ++j)
      if (!bvh.joints[j].name.empty() && plain_name(bvh.joints[j].name) == name)
        return static_cast<int>(j);
  }
  return -1;
}

/// Direction of a joint's bone at rest: to its first child that is not at the same place.
Vec3 rest_direction(const Bvh& bvh, int joint) {
  for (std::size_t j = static_cast<std::size_t>(joint) + 1; j < bvh.joints.size(); ++j)
    if (bvh.joints[j].parent == joint && bvh.joints[j].offset.norm() > 1e-9)
      return bvh.joints[j].offset.normalized();
  return Vec3::Zero();
}

Vec3 rest_place(const Bvh& bvh, int joint) {
  Vec3 p = Vec3::Zero();
  for (int j = joint; j > 0; j = bvh.joints[j].parent)
    p += bvh.joints[j].offset;
  return p;
}

struct Followed {
  std::string joint;
  int bvh = -1;
  Quaterniond align =
      Quaterniond::Identity(); ///< brings our bone into the direction of the BVH's at rest
};

} // namespace

Pose read_pose(const std::string& path, const Body& body) {
  const io::Json document = io::read_document(path, "pose", 1);
  const io::Node root(document, path);
  root.allow_only({"format", "version", "generator", "length_unit", "arms_deg", "arm_l_deg",
                   "arm_r_deg", "turn_deg", "shift_m"});
  const std::vector<std::string> names = joint_names(body);
  Pose pose;
  for (const bool left : {true, false}) {
    const std::string own = left ? "arm_l_deg" : "arm_r_deg",
                      key = root.has(own) ? own : "arms_deg";
    if (!root.has(key))
      continue;
    const double degrees = root.at(key).number();
    if (degrees < 0 || degrees > 180)
      root.at(key).fail("json.out-of-range"_id,
                        "is not an angle from hanging (0) to upright (180)");
    pose.turn[left ? "upper_arm_l" : "upper_arm_r"] = arm_turn(body, left, units::radians(degrees));
  }
  if (root.has("turn_deg"))
    for (const std::string& name : root.at("turn_deg").keys()) {
      if (std::find(names.begin(), names.end(), name) == names.end())
        root.at("turn_deg")
            .at(name)
            .fail("pose.no-joint"_id,
                  "the body has no joint \"" + name + "\"" + did_you_mean(name, names, "\""));
      const Vec3 angles = root.at("turn_deg").at(name).vec3();
      Quaterniond q = Quaterniond::Identity();
      for (int axis = 0; axis < 3; ++axis)
        q = about(axis, units::radians(angles[axis])) * q;
      const auto before = pose.turn.find(name);
      pose.turn[name] = before == pose.turn.end() ? q : q * before->second;
    }
  if (root.has("shift_m"))
    pose.shift = root.at("shift_m").vec3();
  return pose;
}

Motion parse_bvh(std::string_view text, const std::string& name, const Body& body, double step_s) {
  const Bvh bvh = parse(text, name);
  auto bone = [&](const std::string& wanted) -> const Bone* {
    for (const Bone& b : body.bones)
      if (b.name == wanted)
        return &b;
    return nullptr;
  };
  // a figure whose left leg hangs at -x looks backwards
  Quaterniond facing = Quaterniond::Identity();
  const int thigh = find_joint(bvh, SIDED[4].theirs, true);
  if (thigh >= 0 && rest_place(bvh, thigh).x() < 0)
    facing = about(1, units::PI);
  std::vector<Followed> followed;
  auto follow = [&](const std::string& ours, int theirs, bool align) {
    const Bone* b = bone(ours);
    if (theirs < 0 || (!b && ours != "root"))
      return;
    Followed f{ours, theirs, Quaterniond::Identity()};
    const Vec3 rest = rest_direction(bvh, theirs);
    if (align && b && rest.norm() > 0.5)
      f.align = rotation_between(b->tail - b->head, facing * rest);
    followed.push_back(f);
  };
  follow("root", 0, false);
  // the last joint of the trunk before neck and arms carries the chest; the spines below it only
  // add to it
  int chest = -1;
  for (const char* wanted : {"spine3", "upperchest", "chest4", "chest3", "chest2", "spine2",
                             "spine1", "chest", "spine", "abdomen"})
    if (chest < 0)
      chest = find_joint(bvh, {wanted}, true);
  follow("spine", chest, false);
  follow("head", find_joint(bvh, {"head", "neck"}, true), false);
  for (const bool left : {true, false})
    for (const Names& names :
         SIDED) // a bone of the arm or leg takes the direction that the BVH's has
      if (const std::string ours = std::string(names.ours) + (left ? "_l" : "_r");
          std::string(names.ours) != "clavicle")
        follow(ours, find_joint(bvh, names.theirs, left), std::string(names.ours) != "foot");
  if (followed.size() < 6)
    throw input_error(
        "motion.unknown-joints"_id, name, "HIERARCHY",
        "few of its joints have a name that is known",
        "expected names such as Hips, Spine, LeftArm, LeftForeArm, LeftUpLeg, LeftLeg");
  // the hips travel in proportion to the legs
  double scale = 0;
  const int shin = find_joint(bvh, SIDED[5].theirs, true),
            foot = find_joint(bvh, SIDED[6].theirs, true);
  if (shin >= 0 && foot >= 0 && bone("thigh_l") && bone("shin_l")) {
    const double theirs = bvh.joints[shin].offset.norm() + bvh.joints[foot].offset.norm();
    const double ours = (bone("thigh_l")->tail - bone("thigh_l")->head).norm() +
                        (bone("shin_l")->tail - bone("shin_l")->head).norm();
    if (theirs > 1e-9)
      scale = ours / theirs;
  }
  Motion motion;
  const int stride =
      step_s > 0 ? static_cast<int>(std::clamp(std::round(step_s / bvh.frame_s), 1.0, 1e9)) : 1;
  motion.frame_s = stride * bvh.frame_s;
  const Vec3 hips = bone("spine") ? bone("spine")->head : Vec3::Zero();
  std::optional<Vec3> start;
  std::vector<Quaterniond> world(bvh.joints.size());
  for (int frame = 0; frame < bvh.frames; frame += stride) {
    const double* values = &bvh.values[static_cast<std::size_t>(frame) * bvh.n_channels];
    Vec3 place = Vec3::Zero();
    for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
      const BvhJoint& joint = bvh.joints[j];
      Quaterniond q = Quaterniond::Identity();
      for (std::size_t k = 0; k < joint.channels.size(); ++k) {
        const double x = values[joint.first_channel + static_cast<int>(k)];
        if (joint.channels[k] < 3) {
          if (j == 0)
            place[joint.channels[k]] = x;
        } else
          q = q * about(joint.channels[k] - 3, units::radians(x));
      }
      world[j] = joint.parent < 0 ? q : world[joint.parent] * q;
    }
    place = facing * place;
    if (!start)
      start = Vec3(place.x(), 0, place.z());
    Pose pose;
    std::map<std::string, Quaterniond> of_ours;
    for (const Followed& f : followed)
      of_ours[f.joint] = facing * world[f.bvh] * facing.conjugate() * f.align;
    std::map<std::string, Quaterniond> absolute = {{"root", of_ours["root"]}};
    for (const Bone& b : body.bones) { // relative to the parent's turn
      if (b.name.starts_with("pelvis")) {
        absolute[b.name] = absolute["root"];
        continue;
      }
      const auto parent = absolute.find(b.parent.empty() ? "root" : b.parent);
      const Quaterniond above = parent == absolute.end() ? absolute["root"] : parent->second;
      const auto own = of_ours.find(b.name);
      absolute[b.name] = own == of_ours.end() ? above : own->second;
      if (own != of_ours.end())
        pose.turn[b.name] = above.conjugate() * own->second;
    }
    pose.turn["root"] = absolute["root"];
    if (scale > 0) {
      pose.shift = scale * (place - *start);
      pose.shift.y() = place.y() == 0 ? 0 : scale * place.y() - hips.y();
    }
    motion.poses.push_back(pose);
  }
  return motion;
}

Motion read_bvh(const std::string& path, const Body& body, double step_s) {
  return parse_bvh(io::read_file(path), path, body, step_s);
}

} // namespace sloper::body
