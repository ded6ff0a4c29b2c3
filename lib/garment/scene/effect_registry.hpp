#pragma once
/// All effects that there are.
#include <sloper/garment/scene/effect_spec.hpp>

#include <vector>

namespace sloper::garment {

/// In the order of the report.
const std::vector<EffectSpec>& effect_registry();

} // namespace sloper::garment
