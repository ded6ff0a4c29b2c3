#pragma once
/// Reads a pattern file of any known format, recognised by its content.
#include <sloper/io/json_fwd.hpp>
#include <sloper/pattern/pattern.hpp>
#include <sloper/pattern/read/grade_rules.hpp>

#include <set>

namespace sloper::pattern {

/// Choices for a DXF: size, unit, pieces. Without `size` it is the sample size.
struct DxfChoice {
  std::string size;                  ///< name of a size of the table; empty: the sample size
  const GradeRules* rules = nullptr; ///< of the file's grade rule table
  double unit = 0;                   ///< m per unit of the file; 0: as it states
  double allowance = 0;              ///< m, taken off cut lines of pieces without a sew line
  /// Names of pieces to take although they are linings and the like.
  std::vector<std::string> pieces = {};
  /// Panels that a sidecar sews; empty without one.
  std::set<std::string> sewn = {};
};

/// Choices of the user for one file: sizes and pieces.
struct PatternChoice {
  std::string sewing;             ///< sidecar with the seams of a DXF
  std::string size;               ///< of a graded DXF; empty for the sample size
  std::string rules;              ///< path of the .rul file of a DXF
  double unit = 0, allowance = 0; ///< of a DXF; see DxfChoice
  /// Names of pieces to take, all where it is empty, and of those to leave.
  std::vector<std::string> pieces, without;
};

/// Reads a pattern of any format, and the part of it that `choice` names.
/// @param path  file, or "-" for standard input
/// @throws Error INPUT naming file, panel, edge and centimetres
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

/// Reason why a panel cannot be processed at all: `place` is an edge or a line of it, or
/// empty.
struct PanelFault {
  /// Edge or line; what is wrong; what to do.
  std::string place, fact, next;
};

/// A number that no later step can handle: coordinates that are not finite, control
/// points and sizes of more than metres, lines that leave the panel. For panels from
/// readers and from edits.
/// @return empty where there is none
std::optional<PanelFault> fault_of(const Panel& panel);

/// Last step of every reader: checks that outlines are finite, closed, non-empty and of a
/// plausible size, and mirrors panels that are drawn clockwise, as seen from inside.
/// @throws Error INPUT
void finish_pattern(Pattern& pattern, const std::string& file);

} // namespace sloper::pattern
