#include <garment/scene/effect_registry.hpp>

/// One line an effect, in the order of the report: NAME has its specification in
/// garment/effects/NAME.cpp, the models of bending in garment/effects/bending/NAME.cpp.
#define SLOPER_EFFECTS(EFFECT) \
  EFFECT(edge_springs)         \
  EFFECT(triangle_stretch)     \
  EFFECT(membrane)             \
  EFFECT(shear)                \
  EFFECT(bending)              \
  EFFECT(dihedral_bending)     \
  EFFECT(orthotropic_bending)  \
  EFFECT(damping)              \
  EFFECT(sewing)               \
  EFFECT(gravity)              \
  EFFECT(weights)              \
  EFFECT(pins)                 \
  EFFECT(attachments)          \
  EFFECT(closures)             \
  EFFECT(elastic_bands)        \
  EFFECT(wind)                 \
  EFFECT(pressure)             \
  EFFECT(body_contact)         \
  EFFECT(body_motion)          \
  EFFECT(friction)             \
  EFFECT(self_contact)         \
  EFFECT(layers)

namespace sloper::garment {

#define SLOPER_DECLARE_EFFECT(name) EffectSpec name##_effect();
SLOPER_EFFECTS(SLOPER_DECLARE_EFFECT)
#undef SLOPER_DECLARE_EFFECT

const std::vector<EffectSpec>& effect_registry() {
#define SLOPER_LIST_EFFECT(name) name##_effect(),
  static const std::vector<EffectSpec> effects = {SLOPER_EFFECTS(SLOPER_LIST_EFFECT)};
#undef SLOPER_LIST_EFFECT
  return effects;
}

} // namespace sloper::garment
