#pragma once
/// What the JSON pattern formats share: edges with SVG-like paths, and loops that must close.
#include <sloper/io/json_fwd.hpp>
#include <sloper/pattern/pattern.hpp>

namespace sloper::pattern {

/// [["M",x,y], ["L",x,y], ["Q",cx,cy,x,y], ["C",c1x,c1y,c2x,c2y,x,y], ["A",radius,large,ccw,x,y]];
/// "M" may be left out where the path starts at `start`.
Path read_path(const io::Node& node, double unit, const Vec2* start);

/// A loop of named edges. Ends that miss by less than 0.1 mm are joined; a wider gap is an error
/// naming panel, edge and centimetres.
/// @param key "edge" or "run"
std::vector<PanelEdge> read_loop(const io::Node& node, const char* key, double unit,
                                 const std::string& panel);

/// Metres per "m", "cm", "mm" or "in". @throws Error INPUT
double unit_of(const io::Node& node);

/// Index of a panel or of an edge by name. @throws Error INPUT with a suggestion
int panel_named(const Pattern& pattern, const io::Node& node);
int edge_named(const Panel& panel, const io::Node& node);

} // namespace sloper::pattern
