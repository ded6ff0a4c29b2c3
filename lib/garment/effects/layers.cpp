#include <sloper/garment/scene/effect_spec.hpp>

#include <algorithm>

namespace sloper::garment {

namespace {

EffectChoice choose_layers(const EffectFacts& facts) {
  int layers = 0;
  for (const pattern::PanelInfo& panel : facts.garment.panels.panels)
    layers = std::max(layers, panel.layer);
  if (layers > 0 && facts.touches_body)
    return {true, "cloth lies over cloth: self contact keeps the order"};
  return {false, "there is one layer"};
}

} // namespace

EffectSpec layers_effect() {
  return {.name = "layers", .stage = EffectStage::NONE, .choose = choose_layers};
}

} // namespace sloper::garment
