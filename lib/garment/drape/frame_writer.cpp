#include <garment/drape/frame_writer.hpp>
#include <sloper/base/error.hpp>
#include <sloper/io/files.hpp>
#include <sloper/io/obj.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>

namespace sloper::garment {

FrameWriter::FrameWriter(std::string where, std::string stamp, std::ostream& stream,
                         std::size_t after)
    : m_where(std::move(where)), m_stamp(std::move(stamp)), m_stream(stream) {
  if (m_where.empty() || m_where == "-")
    return;
  std::error_code failed;
  std::filesystem::create_directories(m_where, failed);
  for (const auto& entry : std::filesystem::directory_iterator(
           m_where, failed)) { // a run that was killed may have left one half written
    const std::string name = entry.path().filename().string();
    if (name.rfind("frame", 0) == 0 && name.find(".tmp.") != name.npos)
      std::filesystem::remove(entry.path(), failed);
  }
  const std::string index = m_where + "/frames.jsonl";
  if (after > 0 && std::filesystem::exists(index)) {
    const std::string all = io::read_file(index);
    std::size_t end = 0;
    for (; after > 0 && all.find('\n', end) != all.npos; --after)
      end = all.find('\n', end) + 1;
    io::write_file(index, all.substr(0, end)); // whole or not at all: this run can be killed too
    m_index.open(index, std::ios::app);
  } else {
    m_index.open(index);
  }
  if (failed || !m_index)
    throw Error(ErrorKind::OUTPUT, "file.cannot-write"_id, m_where, "",
                "no frames can be written there", "name a folder");
}

void FrameWriter::operator()(const FollowFrame& f, const Garment& garment) {
  io::Json line = {{"frame", f.number}, {"edits", f.edits}};
  if (f.latency_ms >= 0) {
    line["latency_ms"] = std::round(1000 * f.latency_ms) / 1000;
    line["cpu_ms"] = f.cpu_ms;
  }
  line["remeshed"] = f.remeshed;
  line["speed_m_s"] = f.speed_m_s;
  line["at_rest"] = f.at_rest;
  write(f.number, std::move(line), garment);
}

void FrameWriter::operator()(const MotionFrame& f, const Garment& garment) {
  write(f.number,
        {{"frame", f.number},
         {"pose", f.pose},
         {"time_s", f.time_s},
         {"faces_through_body", f.faces_through},
         {"vertices_inside_body", f.vertices_inside},
         {"self_intersections", f.self_intersections},
         {"parts", f.parts},
         {"forced", f.forced},
         {"speed_m_s", f.speed_m_s}},
        garment);
}

void FrameWriter::write(int number, io::Json line, const Garment& garment) {
  if (m_where.empty())
    return;
  if (m_where == "-") {
    line["x"] = io::Json::array();
    for (const Vec3& p : garment.position)
      for (int k = 0; k < 3; ++k)
        line["x"].push_back(std::round(1e6 * p[k]) / 1e6); // to a thousandth of a millimetre
    m_stream << line.dump() << std::endl;
    return;
  }
  char name[32];
  std::snprintf(name, sizeof name, "frame-%06d.obj", number);
  io::ObjMesh obj;
  obj.positions = garment.position;
  obj.texture = garment.panels.pattern;
  obj.triangles = garment.particle_triangles();
  obj.texture_triangles = garment.panels.triangles;
  for (const pattern::PanelInfo& panel : garment.panels.panels)
    obj.groups.push_back({panel.name, panel.first_triangle});
  io::write_obj(m_where + "/" + name, obj, m_stamp);
  line["mesh"] = name;
  m_index << line.dump() << std::endl;
}

} // namespace sloper::garment
