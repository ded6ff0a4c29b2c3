#pragma once
/// A pattern file of any known format, told apart by its content.
#include <sloper/io/json_fwd.hpp>
#include <sloper/pattern/pattern.hpp>
#include <sloper/pattern/read/grade_rules.hpp>

#include <set>

namespace sloper::pattern {

/// Which of the sizes in a DXF is meant. Neither field: the sample size.
struct DxfChoice {
  std::string size;
  const GradeRules* rules = nullptr;    ///< of the file's grade rule table
  double unit = 0;                      ///< m per unit of the file; 0: as it states
  double allowance = 0;                 ///< m, taken off cut lines of pieces without a sew line
  std::vector<std::string> pieces = {}; ///< taken though they are linings and the like
  std::set<std::string> sewn = {};      ///< panels that a sidecar sews; empty without one
};

/// What a user says of a file besides its name.
struct PatternChoice {
  std::string sewing;             ///< sidecar with the seams of a DXF
  std::string size;               ///< of a graded DXF; empty for the sample size
  std::string rules;              ///< path of the .rul file of a DXF
  double unit = 0, allowance = 0; ///< of a DXF; see DxfChoice
  std::vector<std::string> pieces,
      without; ///< names of pieces to take, all where it is empty, and of those to leave
};

/// Reads a pattern of any format, and of it what `choice` names. @throws Error INPUT naming file,
/// panel, edge and centimetres
Pattern read_pattern(const std::string& path, const PatternChoice& choice);

/// Reads our pattern JSON, a GarmentCode specification, a sewing-spec JSON or an AAMA / ASTM DXF.
/// @param path    file, or "-" for standard input
/// @param sewing  sidecar with the seams of a DXF, or empty
/// @param size    of a graded DXF; empty for the sample size
/// @param rules   path of the .rul file of a DXF, or empty
/// @throws Error INPUT naming file, panel, edge and centimetres
Pattern read_pattern(const std::string& path, const std::string& sewing,
                     const std::string& size = "", const std::string& rules = "");

/// {"pattern": {"panels", "stitches"}} in centimetres (units_in_meter), Euler angles in degrees, in
/// the order that euler_order() finds.
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
