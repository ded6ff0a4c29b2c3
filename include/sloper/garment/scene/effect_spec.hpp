#pragma once
/// The description of one effect: when it takes part, and how it is made. Each effect has
/// one, in garment/effects; the list of all is effect_registry.cpp.
#include <sloper/body/body.hpp>
#include <sloper/cloth/contact/body_contact.hpp>
#include <sloper/cloth/contact/self_contact.hpp>
#include <sloper/cloth/forces/sewing_spring.hpp>
#include <sloper/cloth/solver/implicit_step.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/garment/scene/settings.hpp>

namespace sloper::garment {

inline constexpr double SEW_REACH = 0.05; ///< m: the pull of a stitch does not grow beyond this gap

/// What effects are chosen by: facts of the garment, the scene and the body.
struct EffectFacts {
  const Garment& garment;                                 ///< as it stands
  const body::Body* body;                                 ///< null for none
  const DrapeSettings& settings;                          ///< with `effects`, the user's choice
  const SceneEffects& scene;                              ///< the garment's
  bool has_open_seams;                                    ///< seams are still to be sewn
  bool touches_body;                                      ///< there is a body with a skin
  bool has_shear, has_bending, has_damping, has_friction; ///< some fabric of the garment does
  bool is_fem, is_triangles; ///< the model of stretch that the scene asks for; else springs
  bool is_dihedral;          ///< the model of bending that the scene asks for
  bool is_directional;       ///< some fabric bends by direction, or softens as it bends
};

/// On or off, with the reason.
struct EffectChoice {
  bool wanted;     ///< takes part unless the user chooses otherwise
  const char* why; ///< for the report, on or off
};

/// Effects that a drape speaks to while it runs, as typed handles; null where they are not in the
/// solver.
struct EffectHandles {
  /// Cloth against skin.
  cloth::BodyContactEffect* body_contact = nullptr;
  /// Cloth against cloth.
  cloth::SelfContactEffect* self_contact = nullptr;
  /// Springs of open seams.
  cloth::SewingSpringEffect* sewing = nullptr;
};

/// What an effect is made with; all references outlive the solver.
struct EffectBuild {
  cloth::ClothSolver& solver;        ///< takes the effect
  const cloth::ClothMesh& mesh;      ///< rest state of the cloth
  const Garment& garment;            ///< as it stands
  const body::Body* body;            ///< null for none
  const DrapeSettings& settings;     ///< of the drape
  collision::BodyCollider* collider; ///< null for none
  bool open_seams; ///< panels are being sewn: only what holds them together and apart takes part
  EffectHandles& handles; ///< out
};

/// When an effect comes into the solver. Forces are summed in this order, and within a stage in
/// that of the registry.
enum class EffectStage {
  FABRIC,  ///< in-plane and bending models that share the fabric's numbers
  MODEL,   ///< models that a scene chooses in their place
  SCENE,   ///< what a scene adds
  CONTACT, ///< seams and contact
  LOAD,    ///< weight and friction: they come once the cloth has relaxed
  NONE,    ///< carried by other effects
};

/// Models of the same thing, of which one takes part.
enum class EffectModel {
  NONE,
  STRETCH,
  BENDING,
};

/// Everything that the drape needs to offer one effect; made by NAME_effect() in
/// garment/effects.
struct EffectSpec {
  const char* name;                      ///< of the effect, its switch, its line in the report
  EffectStage stage;                     ///< when it enters the solver
  EffectModel model = EffectModel::NONE; ///< of those of one model, one takes part
  /// Decides whether it takes part where the user leaves it to the scene.
  EffectChoice (*choose)(const EffectFacts& facts);
  /// Makes the effect and adds it to the solver; null for stage NONE.
  void (*add)(EffectBuild& build) = nullptr;
  /// Changes the rest state before any effect is made, whether this one is on or off; null for
  /// those that do not.
  void (*prepare)(cloth::ClothMesh& mesh, const Garment& garment, bool is_on) = nullptr;
};

} // namespace sloper::garment
