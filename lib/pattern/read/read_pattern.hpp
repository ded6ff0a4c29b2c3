#pragma once
/// A pattern file of any known format, told apart by its content.
#include <io/json_fwd.hpp>
#include <pattern/pattern.hpp>
#include <pattern/read/grade_rules.hpp>

namespace sloper::pattern {

/// Which of the sizes in a DXF is meant. Neither field: the sample size.
struct DxfChoice {
  std::string size;
  const GradeRules* rules = nullptr; ///< of the file's grade rule table
};

/// Reads our pattern JSON, a GarmentCode specification, a sewing-spec JSON or an AAMA / ASTM DXF.
/// @param path    file, or "-" for standard input
/// @param sewing  sidecar with the seams of a DXF, or empty
/// @param size    of a graded DXF; empty for the sample size
/// @param rules   path of the .rul file of a DXF, or empty
/// @throws Error INPUT naming file, panel, edge and centimetres
Pattern read_pattern(const std::string& path, const std::string& sewing,
                     const std::string& size = "", const std::string& rules = "");

/// {"pattern": {"panels", "stitches"}} in centimetres (units_in_meter), Euler angles intrinsic XYZ
/// in degrees as pygarment writes them.
Pattern read_garmentcode(const io::Json& json, const std::string& file);

/// Our own format; see pattern.schema.json.
Pattern read_pattern_json(const io::Json& json, const std::string& file);

/// The neutral sewing JSON, "format": "sewing-spec", millimetres.
Pattern read_sewing_spec(const io::Json& json, const std::string& file);

/// AAMA / ASTM D6673 DXF text: one panel per block, sewing from layer-15 texts when there are any.
/// Panels come in the order of their names, whatever the order of the blocks.
Pattern read_dxf(const std::string& text, const std::string& file, const DxfChoice& choice = {});

/// Seams of a "sewing-seams" sidecar, added to a pattern whose panels and edges have names.
void read_sewing_seams(Pattern& pattern, const io::Json& json, const std::string& file);

/// Why a panel cannot be worked with, at all: `place` is an edge or a line of it, or empty.
struct PanelFault {
  std::string place, fact, next;
};

/// Numbers that no later step could bear: coordinates that are not finite, control points and sizes
/// of more than metres, lines that leave the panel. Holds for what readers make and for what edits
/// make of it. Nothing where all is well.
std::optional<PanelFault> fault_of(const Panel& panel);

/// What every reader ends with: finite, closed, non-empty outlines of a plausible size; a panel
/// drawn clockwise is one seen from inside and is mirrored. @throws Error INPUT
void finish_pattern(Pattern& pattern, const std::string& file);

} // namespace sloper::pattern
