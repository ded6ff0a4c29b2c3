#include "targets.hpp"

#include <sloper/base/error.hpp>
#include <sloper/body/body_json.hpp>
#include <sloper/body/landmarks/rules.hpp>
#include <sloper/body/pose_file.hpp>
#include <sloper/io/files.hpp>

#include <cstdlib>

namespace sloper::fuzz {

namespace {

body::Body person() {
  body::Body b;
  b.scan.stature_m = 1.7;
  auto bone = [&](const char* name, const char* parent, const Vec3& head, const Vec3& tail) {
    b.bones.push_back({name, parent, head, tail});
  };
  bone("spine", "", Vec3(0, 0.9, 0), Vec3(0, 1.4, 0));
  bone("head", "spine", Vec3(0, 1.4, 0), Vec3(0, 1.7, 0));
  for (const bool left : {true, false}) {
    const std::string s = left ? "_l" : "_r";
    const double x = left ? 1 : -1;
    bone(("upper_arm" + s).c_str(), "spine", Vec3(0.18 * x, 1.4, 0), Vec3(0.4 * x, 1.2, 0));
    bone(("forearm" + s).c_str(), ("upper_arm" + s).c_str(), Vec3(0.4 * x, 1.2, 0),
         Vec3(0.6 * x, 1, 0));
    bone(("thigh" + s).c_str(), "", Vec3(0.1 * x, 0.9, 0), Vec3(0.12 * x, 0.5, 0));
    bone(("shin" + s).c_str(), ("thigh" + s).c_str(), Vec3(0.12 * x, 0.5, 0),
         Vec3(0.14 * x, 0.08, 0));
  }
  return b;
}

} // namespace

void read_document_file(const std::string& path) {
  static const body::Body body = person();
  auto attempt = [](auto read) {
    try {
      read();
    } catch (const Error& e) {
      if (e.kind() != ErrorKind::INPUT)
        std::abort();
    }
  };
  attempt([&] { body::read_body(path); });
  attempt([&] { body::joint_motions(body, body::read_pose(path, body)); });
  if (io::read_file(path).find("landmark-rules") != std::string::npos)
    attempt([&] { body::Rules::read(path); }); // reads the built-in ones too: slow
}

void read_bvh_bytes(std::string_view bytes) {
  static const body::Body body = person();
  try {
    const body::Motion motion = body::parse_bvh(bytes, "fuzz.bvh", body, 0.05);
    for (const body::Pose& pose : motion.poses)
      body::joint_motions(body, pose);
  } catch (const Error& e) {
    if (e.kind() != ErrorKind::INPUT)
      std::abort();
  }
}

} // namespace sloper::fuzz
