#pragma once
/// A garment document and its OBJ, read and written (version 1); every key is in
/// garment.json(5).
///
/// The OBJ holds `v` = particles (m, body frame), `vt` = panel vertices in pattern
/// metres, faces `f v/vt` in panel order and `g PANEL`; only the faces say which panel
/// vertices are one particle. The document holds everything else: `panels` (name, grain,
/// material, layer, part, outline), `vertex_ids` (s and t, the panel being the one that
/// owns the vertex), `seams`, `materials` (units in the key names), `rest_scale` (only
/// triangles with a factor other than 1: [triangle, k0, k1, k2]), `scene` (pins, elastic
/// bands, wind ... as in scene.json), `bind`, `offset_m`, `converged`, `sewn`, and `body`
/// (sha256 and girths of the body it hangs on). PanelMesh::placed is not kept: after
/// reading it is the particle's position. Unknown keys are ignored: programs write these
/// files.
/// Test: tests/garment/test_garment_json.cpp
#include <sloper/garment/garment.hpp>
#include <sloper/io/json.hpp>
#include <sloper/io/obj.hpp>
namespace sloper::garment {
/// Version of the format that is written; older ones are read, newer ones refused.
inline constexpr int GARMENT_VERSION = 1;

/// Reads shirt.json and the OBJ that it names.
/// @throws Error INPUT with file and place: not a garment, a newer version, counts that disagree,
/// indices out of range,
///         a panel vertex in no triangle or on two particles, weights that do not sum to one,
///         anything not finite.
Garment read_garment(const std::string& path);

/// Writes the OBJ beside the document (`.json` -> `.obj`), then the document. Reading and writing
/// again gives the same bytes.
/// @throws Error OUTPUT when a file cannot be written, INTERNAL when the garment is not whole or
/// not finite
void write_garment(const std::string& path, const Garment& garment, const std::string& tool);

/// Both files of write_garment(), for a document that holds a garment within.
struct GarmentText {
  io::Json document; ///< with its envelope
  std::string mesh;  ///< OBJ
};
/// Makes both files in memory.
/// @param mesh_name  of the OBJ, for the key `mesh`
/// @throws Error INTERNAL as write_garment()
GarmentText garment_text(const Garment& garment, const std::string& mesh_name,
                         const std::string& tool);
/// The garment of both files.
/// @param document  of garment_text()
/// @param mesh  of its OBJ
/// @param mesh_name  for messages
/// @throws Error INPUT as read_garment()
Garment garment_from(const io::Node& document, const io::ObjMesh& mesh,
                     const std::string& mesh_name);
} // namespace sloper::garment
