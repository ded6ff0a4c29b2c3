#pragma once
/// The landmark rules: step 1 terminal points, step 2 curvature points, each in the file of its
/// region. All work on a closed skin in the body frame and fill body.landmarks, body.levels and
/// body.girths; nothing is guessed silently.
#include <algorithm>
#include <body/landmarks/crotch.hpp>
#include <body/landmarks/made_up_skin.hpp>
#include <body/measure/relief.hpp>
#include <functional>
#include <initializer_list>
#include <sloper/body/body.hpp>
#include <sloper/body/landmarks/corrections.hpp>
#include <sloper/body/landmarks/rules.hpp>
#include <sloper/body/measure/arm_trace.hpp>
namespace sloper::body {

/// What the decision tree's first questions find: which proportions to expect. Not a statement
/// about a person.
struct FigureClass {
  double female = 0.5; ///< 0 male proportions .. 1 female proportions, from shape alone
  std::optional<ReliefPoint> nipple[2], navel;
};

/// Where a navel can be, body frame, m.
Box3 navel_box(const Rules& rules, double stature);

FigureClass classify_figure(const LevelStack& levels, const std::array<ArmTrace, 2>& arms,
                            const Rules& rules, std::vector<std::string>& trail);

/// How the program finds something, under the name that the tree calls it by.
template<class T> struct LandmarkRule {
  const char* rule;
  std::function<std::optional<T>()> find; ///< nothing where the body does not show it
};

/// What a rule found, and which rule it was.
template<class T> struct Chosen {
  T value;
  const RuleChoice* rule;
};

/// What the rules work on, and where they put what they find.
struct Finder {
  const LevelStack& levels;
  const std::array<ArmTrace, 2>& arms;
  const std::vector<Vec3>& scan_points; ///< the scan's own points of the body
  const MadeUpSkin& made_up;            ///< none of a skin that is whole
  bool rebuilt;               ///< the skin is not the scan's own and has lost its finest ends
  CrotchSource crotch_source; ///< of the crotch of `levels`
  const Rules& rules;
  const Corrections& corrections;
  const ShapeFeatures& shape;
  const Situation situation;
  const FigureClass& figure;
  Body& body;
  std::vector<std::string>& trail; ///< the decision path, for --explain
  double s;                        ///< stature, m

  /// Tries the rules in the tree's order for `place`; the path goes to the trail under `label`, as
  /// "LABEL: RULE" for what was taken.
  /// @throws Error INTERNAL where the tree names a rule that the program does not have
  template<class T>
  std::optional<Chosen<T>> choose(const std::string& place, const std::string& label,
                                  std::initializer_list<LandmarkRule<T>> known) const {
    for (const RuleChoice& rule : rules.order(place)) {
      if (!rule.applies(situation))
        continue;
      const auto named = std::find_if(known.begin(), known.end(), [&](const LandmarkRule<T>& k) {
        return rule.name == k.rule;
      });
      if (named == known.end())
        no_such_rule(place, rule.name);
      if (auto value = named->find()) {
        explain(label + ": " + rule.name);
        return Chosen<T>{std::move(*value), &rule};
      }
      explain(label + ": not by " + rule.name);
    }
    explain(label + ": not found");
    return std::nullopt;
  }
  /// What the population says of a landmark that a rule found, m in the body frame; zero where
  /// nothing was learned of it.
  Vec3 correction(const std::string& place, const std::string& suffix = "") const;
  /// Height, m, at which the rest of the body lets expect a landmark; `otherwise` for a body unlike
  /// those learned from.
  double by_population(const std::string& place, double otherwise) const;
  /// The mean of a rule's height `y`, m, and of that which the rest of the body lets expect, the
  /// latter the heavier the farther they are apart; `y` for a body unlike all learned from. Of 102
  /// fresh bodies, 62 of them in natural stances, the back of the neck is off by 6.9 mm by its rule
  /// (standard deviation), by 3.1 by the rest of the body and by 3.2 so; the front by 6.7, 3.2 and
  /// 3.3.
  double more_likely(const std::string& place, double y) const;
  /// `p` with its correction; `on_skin`: the nearest skin to that.
  Vec3 corrected(const std::string& place, const std::string& suffix, const Vec3& p,
                 bool on_skin) const;
  /// The landmark `place` + `suffix`, put, corrected, where the first rule of the tree finds it.
  /// @return whether one did
  bool find(const std::string& place, const std::string& suffix, int step,
            std::initializer_list<LandmarkRule<Vec3>> rules) const;
  void put(const std::string& name, const Vec3& p, int step, const RuleChoice& rule) const;
  /// What another rule gives for a landmark that was put: kept as an alternative when it is more
  /// than a millimetre away.
  void also(const std::string& name, const Vec3& p) const;
  bool has(const std::string& name) const { return body.landmarks.count(name) != 0; }
  const Vec3& at(const std::string& name) const { return body.landmarks.at(name).p; }
  /// A rule's number; where it differs with the figure (name.female, name.male), the two are mixed.
  double number(const std::string& name) const;
  void explain(const std::string& line) const { trail.push_back(line); }
  [[noreturn]] static void no_such_rule(const std::string& place, const std::string& rule);
};

inline const char* side_suffix(int side) {
  return side == 0 ? "_l" : "_r";
}

/// The trunk outline at a height as front and back depth near x = 0, m; empty where there is no
/// trunk.
struct Profile {
  double front, back;
};
std::optional<Profile> midline(const LevelStack& levels, double y, double x, double half_width);

void find_leg_landmarks(
    const Finder& finder); ///< foot tips, heels, crotch, hip joints, knees, ankles
void find_head_landmarks(const Finder& finder); ///< head tip, neck
void find_arm_landmarks(
    const Finder& finder); ///< hand tips, axillae, acromia, shoulders, elbows, wrists
void find_trunk_landmarks(const Finder& finder); ///< bust, waist, abdomen, hip and all levels
void find_girths(const Finder& finder);
void name_body_class(const Finder& finder); ///< body.body_class and its reasons

} // namespace sloper::body
