#pragma once
/// The body as cloth meets it: its skin, or a temporary substitute. Hands and feet may be
/// convex hulls (extremity_hulls.hpp), a dense skin a coarser one (coarse_skin.hpp), the
/// whole body may be drawn in towards its bones (body_shrink.hpp), and forearms may be
/// removed (under_arms.hpp). All of it ends before a drape is audited: the audit is of
/// the skin itself.
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/garment/body_model/body_shrink.hpp>
#include <sloper/garment/body_model/coarse_skin.hpp>
#include <sloper/garment/body_model/extremity_hulls.hpp>
#include <sloper/garment/body_model/under_arms.hpp>
#include <sloper/garment/garment.hpp>
#include <sloper/io/json_fwd.hpp>

#include <optional>
#include <vector>

namespace sloper::garment {

/// Owns the collider of one drape and switches between the substitutes.
class CollisionBody {
public:
  /// State that a checkpoint keeps. All else follows from it and from the body.
  struct State {
    unsigned covered = 0;    ///< of ExtremityHulls::Ends: hulls stand for them, since cloth is near
    bool full_skin = false;  ///< no coarser one from now on
    bool arms_aside = false; ///< forearms and hands are removed until the garment hangs
    bool shrunk = false;     ///< the body was drawn in at some time
    double scale = 1;        ///< of its thickness

    /// Adds its keys to a checkpoint's object; read() is the inverse.
    void write(io::Json& state) const;
    static State read(const io::Node& state); ///< @throws Error INPUT
  };

  /// @param body  null for none; outlives this   @param coarse_tolerance_m
  /// DrapeSettings::skin_tolerance_m
  CollisionBody(const body::Body* body, double coarse_tolerance_m, Reporter& reporter);

  /// The body as given to the constructor; null for none.
  const body::Body* body() const { return m_body; }
  /// Whether there is a body with triangles.
  bool has_skin() const { return m_body && !m_body->skin.triangles.empty(); }
  /// Null before prepare() or use_full_skin(), and where there is no skin.
  collision::BodyCollider* collider() { return m_collider ? &*m_collider : nullptr; }
  const collision::BodyCollider* collider() const { return m_collider ? &*m_collider : nullptr; }
  /// State that a checkpoint keeps.
  const State& state() const { return m_state; }

  /// Makes the collider of the body at its full size, with hulls for the ends and a coarser skin
  /// where that pays. @param covered of ExtremityHulls::Ends
  void prepare(unsigned covered);
  /// Rebuilds the collider of a checkpoint, without the positions that only the phase
  /// knows.
  /// @param garment  whose sleeves leave forearms where they are
  void restore(const State& state, const Garment& garment);
  /// Ends that have any of these points beside or beyond them, of ExtremityHulls::Ends. @param
  /// points m
  unsigned ends_near(const std::vector<Vec3>& points) const;
  /// The skin itself from now on: no hull, nothing coarse.
  void use_full_skin();
  /// Whether a coarser skin stands for the dense one at present.
  bool has_coarse_proxy() const { return m_coarse.has_value(); }
  /// The skin itself in place of the coarser one; hulls stay.
  void drop_coarse_proxy();

  /// Draws the body in towards its bones. @param scale  0..1, of its thickness
  void draw_in(double scale);
  /// Scale of the body while it is inflated: the phase moves the skin.
  void set_scale(double scale) { m_state.scale = scale; }
  /// Largest distance of a skin vertex from its bone, m. Only after draw_in().
  double reach() const { return m_shrink->reach(); }

  /// Decides whether forearms obstruct cloth that is sewn around the lower body, and are
  /// in no sleeve.
  /// @param garment  unsewn, placed
  void find_arms_aside(const Garment& garment);
  /// Removes the forearms, where find_arms_aside() found that they obstruct.
  void put_arms_aside();
  /// The arms hang where they were scanned.
  void let_arms_hang();

  /// The skin of the body at this scale, as the collider has it. @return #V of the collider by 3, m
  std::vector<Vec3> skin_at(double scale) const;
  /// Another skin of the same body, as the collider has it. @param skin  #V of the body by 3, m
  std::vector<Vec3> collision_surface(const std::vector<Vec3>& skin) const;
  /// The body stands so from now on. @param skin  #V of the body by 3, m
  void stand_at(const std::vector<Vec3>& skin);

private:
  void collide_with(const TriangleMesh& skin);
  void make_forearms(const Garment& garment);

  const body::Body* m_body;
  double m_coarse_tolerance;
  Reporter& m_reporter;
  State m_state;
  std::optional<collision::BodyCollider> m_collider;
  std::optional<ExtremityHulls> m_extremity_hulls;
  std::optional<CoarseSkin> m_coarse;
  std::optional<BodyShrink> m_shrink;
  std::optional<Forearms> m_forearms;
  body::Body m_end_body; // where a motion left it
};

/// Placed vertices of the panels of the body parts whose names begin so, m. @param part  "arm_l",
/// "leg", "lower_body"
std::vector<Vec3> placed_on(const Garment& garment, const std::string& part);

} // namespace sloper::garment
