#pragma once
/// Body measures for the drafts, from a body document or from a mannequin.
#include "draft.hpp"
#include <sloper/io/json_fwd.hpp>
namespace sloper::samples {
/// A standard figure's measures, all of them in proportion to the stature, m.
Measures standard_measures(double stature);
/// From a body document or a mannequin's truth: both name landmarks, levels and girths alike. What
/// is missing is taken from stature by average proportions.
/// @throws Error INPUT when stature cannot be had
Measures measures_from_body(const io::Json& body, const std::string& file);
/// Sets one measure by name. @throws Error USAGE with the nearest name
void set_measure(Measures& m, const std::string& name, double value);
/// The measures by name, in order.
std::vector<std::pair<std::string, double Measures::*>> measure_names();
/// The pattern document of a draft.
io::Json pattern_document(const Draft& draft);
} // namespace sloper::samples
