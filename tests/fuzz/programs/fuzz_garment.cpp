/// Any bytes as what goes from tool to tool, and what judges it: garments, panels, checkpoints, fit
/// policies, fabrics from CSV, cameras, pictures. A document and its OBJ stand in one input, with a
/// line "@@@" between; the document calls its mesh "900".
#include "memory_file.hpp"

#include <garment/kes.hpp>
#include <sloper/base/error.hpp>
#include <sloper/garment/fit/fit_policy.hpp>
#include <sloper/garment/garment_json.hpp>
#include <sloper/garment/simulate/checkpoint.hpp>
#include <sloper/io/png.hpp>
#include <sloper/pattern/panel_mesh_json.hpp>
#include <sloper/render/camera.hpp>

#include <cstdint>
#include <cstdlib>
#include <string_view>

using namespace sloper;

namespace {

constexpr int MESH_FILE = 900;

template<class Read> bool is_read(const Read& read) {
  try {
    read();
    return true;
  } catch (const Error& e) {
    if (e.kind() != ErrorKind::INPUT)
      std::abort();
    return false;
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t cut = bytes.find("\n@@@\n");
  const std::string_view document = bytes.substr(0, cut),
                         mesh = cut == bytes.npos ? std::string_view() : bytes.substr(cut + 5);
  const fuzz::MemoryFile file(document.data(), document.size()),
      obj(mesh.data(), mesh.size(), MESH_FILE);
  garment::Garment shirt;
  if (is_read([&] {
        shirt = garment::read_garment(file.path());
      })) { // what is read can be written and read again
    const garment::GarmentText text = garment::garment_text(shirt, "again.obj", "fuzz");
    garment::garment_from(io::Node(text.document, "again.json"),
                          io::parse_obj(text.mesh, "again.obj"), "again.obj");
  }
  is_read([&] { pattern::read_panel_mesh(file.path()); });
  is_read([&] { garment::read_checkpoint(file.path()); });
  is_read([&] { garment::read_fit_policy(file.path()); });
  is_read([&] { garment::read_kes(file.path()); });
  is_read([&] { render::read_camera(file.path()); });
  is_read([&] { io::read_png(file.path()); });
  return 0;
}
