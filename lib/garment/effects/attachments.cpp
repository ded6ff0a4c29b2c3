#include <garment/scene/panel_runs.hpp>
#include <sloper/base/error.hpp>
#include <sloper/cloth/forces/attachments.hpp>
#include <sloper/garment/scene/effect_spec.hpp>

namespace sloper::garment {

namespace {

std::vector<cloth::Attachment> attachments_of(const Garment& garment, const body::Body* body) {
  std::vector<cloth::Attachment> attachments;
  for (const SceneAttachment& a : garment.scene.attachments) {
    Vec3 anchor = a.anchor;
    if (!a.landmark.empty()) {
      if (!body || !body->landmarks.count(a.landmark))
        throw input_error("scene.no-landmark"_id, "",
                          "attachment to landmark \"" + a.landmark + "\"",
                          body ? "the body has no such landmark" : "there is no body");
      anchor = body->landmarks.at(a.landmark).p;
    }
    for (int p : run_particles(garment, a.run))
      attachments.push_back({p, anchor, a.rest_length_m, a.stiffness_n_m});
  }
  return attachments;
}

EffectChoice choose_attachments(const EffectFacts& facts) {
  if (!facts.scene.attachments.empty())
    return {true, "the scene has elastic attachments"};
  return {false, "the scene has no attachments"};
}

void add_attachments(EffectBuild& build) {
  if (build.open_seams)
    return;
  build.solver.emplace<cloth::AttachmentsEffect>(attachments_of(build.garment, build.body));
}

} // namespace

EffectSpec attachments_effect() {
  return {.name = "attachments",
          .stage = EffectStage::SCENE,
          .choose = choose_attachments,
          .add = add_attachments};
}

} // namespace sloper::garment
