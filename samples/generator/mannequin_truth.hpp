#pragma once
/// What is known of a mannequin by construction, under the names and definitions of the body
/// document.
#include "body_field.hpp"
namespace sloper::samples {
/// Part of every vertex: 0 head, 1 torso, 2 arm_l, 3 arm_r, 4 leg_l, 5 leg_r.
std::vector<unsigned char> vertex_parts(const TriangleMesh& mesh, const BodyField& field);
/// {"landmarks": {NAME: {p, trust}}, "levels": {NAME: {y, girth_m, width_m, depth_m, trust}},
/// "girths_m": {NAME: value}}. Joints are those of the construction; skin points are measured on
/// the mesh by the definition of their name. trust is "high" where the definition fixes the point,
/// "medium" where the figure's anatomy does, "low" where it is a guess.
io::Json mannequin_truth(const TriangleMesh& mesh, const std::vector<unsigned char>& parts,
                         const BodyField& field, const Mannequin& shape);
} // namespace sloper::samples
