#pragma once
/// Places on the outline of a DXF piece, and half pieces that are opened about their mirror line.
#include <pattern/read/dxf_sewing.hpp>
#include <sloper/pattern/pattern.hpp>

#include <vector>

namespace sloper::pattern {

/// Distance (m) of a point from a path, its curves taken as their chords.
double distance_to_path(const Path& path, const Vec2& p);

/// The panel edge nearest to p by distance to its middle part, so that a text set at a corner by
/// rounding finds its own run.
int edge_near(const Panel& panel, const Vec2& p);

/// The edge of the outline that a mirror line lies on, or -1, which is a finding.
/// @param line  its points in the file's unit
/// @param unit  m
int fold_edge(const Panel& panel, const std::vector<Vec2>& line, double unit,
              std::vector<Message>& findings);

/// Adds the other half of a piece. Its notches are mirror images; runs sewn on the drawn half keep
/// their edges.
/// @param fold  index of the mirror line's edge
/// @param sewn  texts of the panel that state seams
void open_fold(Panel& panel, int fold, const std::vector<DxfSewing::Text*>& sewn,
               std::vector<Message>& findings);

} // namespace sloper::pattern
