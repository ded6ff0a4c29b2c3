#pragma once
/// Contact of cloth with a body: repulsion inside the gap, static and sliding friction, and planes
/// that no step passes.
///
/// Every pair of near elements has a potential of its distance d: cloth vertex and body face
/// (reach: the gap), cloth edge and body edge, cloth face and body vertex (reach: EDGE_REACH of the
/// gap). Sums over pairs, and not the nearest alone, are smooth where the nearest feature changes:
/// cloth in a groove or a pinch is pushed by both walls (Li et al. 2020, "Incremental Potential
/// Contact", for the choice of pairs). Per area: k (g - d)^3 / (6 g), and near the skin a barrier
/// that grows as ln(1/d). A pair weighs by how much of the reach its body element covers, so that
/// fine skin does not push harder. Friction is Coulomb with a memory: each touching particle is
/// tied to an anchor on the skin by a tangent spring; where the spring would pull harder than mu N
/// the anchor is dragged along. So a garment that hangs by friction really comes to rest.
///
/// A cloth that is outside stays outside (MotionLimits). One that starts with faces through the
/// skin or vertices inside is pushed out: its crossing elements are pushed along the skin's normal
/// and not guarded until they are free. Test: tests/cloth/contact/test_contact.cpp
#include <sloper/cloth/cloth_mesh.hpp>
#include <sloper/cloth/effect.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/collision/displacement_bounds.hpp>

namespace sloper::cloth {

/// Elements of cloth and skin that are compared; each level includes those before it.
enum class ContactLevel {
  VERTEX = 1, ///< cloth vertex against body face
  FACE,       ///< body vertex against cloth face
  EDGE,       ///< edge against edge
  CONTINUOUS  ///< and no step passes through: what starts outside stays outside
};

/// Numbers of contact with the body.
struct BodyContactOptions {
  double gap_m = 0.003;        ///< distance to the skin at which contact begins
  double stiffness_n_m3 = 3e5; ///< k: pressure per depth; skin gives way about as much
  double friction = 0.0;       ///< mu, Coulomb
  double tangent_ratio = 0.5;  ///< tangent over normal stiffness while sticking
  double slide_ratio = 0.05;   ///< the same while sliding: only steadies the step
  ContactLevel level = ContactLevel::CONTINUOUS; ///< elements that are compared
  /// Pairs are kept up to this distance beyond the activation distance, so that they
  /// serve several steps.
  double slack_m = 0.003;
};

/// The contact effect of one cloth and one body.
class BodyContactEffect : public Effect {
public:
  /// `mesh` and `body` outlive the effect.
  BodyContactEffect(const ClothMesh& mesh, collision::BodyCollider& body,
                    const BodyContactOptions& options);
  const char* name() const override { return "body_contact"; }
  void declare(Couplings& couplings) const override;
  void bind(const BlockMatrix& matrix) override;
  void begin_step(const std::vector<Vec3>& x, double h) override;
  void update_contacts(const std::vector<Vec3>& x, double h) override {
    const double push =
        m_push; // what crosses is pushed harder with every step, and no harder within one
    begin_step(x, h);
    m_push = std::min(m_push, push);
  }
  bool is_search() const override { return true; }
  void prefetch_contacts(const std::vector<Vec3>& x, double h) override {
    if (m_n_crossing == 0)
      begin_step(x, h); // what crosses is pushed harder with every search
  }
  bool crosses() const override { return m_n_crossing > 0; }
  void add(StepContext& c) override;
  /// Potential of the pairs of the last search and of the ties of friction, J.
  double energy(const std::vector<Vec3>& x) const override;
  bool add_separating_planes(const std::vector<Vec3>& x, const std::vector<Vec3>& dx,
                             MotionLimits& limits, bool last) override;

  /// The largest displacement of each skin vertex that passes no cloth at x, m (#V): half of its
  /// distance to the cloth, and no farther than the search has seen. Cloth that already crosses the
  /// skin does not count. Searches. Only after a first step.
  std::vector<double> max_safe_skin_displacement(const std::vector<Vec3>& x);
  /// Pushes a predictor off the skin where cloth at x + predictor would come nearer to it
  /// than half of what collision_free_step_fraction() allows. O(near pairs).
  /// @param displacement  #V by 3, m: displacement of the skin
  /// @param predictor  #P by 3, m, in and out: the predictor; small pushes only
  void push_predictor_off_skin(const std::vector<Vec3>& x, const std::vector<Vec3>& displacement,
                               std::vector<Vec3>& predictor);
  /// The largest fraction of a displacement of the skin that is free of collisions, while
  /// the cloth moves by the same fraction of its predictor: each pair comes nearer by at
  /// most a third of its distance, sideways and apart without limit, and no farther than
  /// the search has seen. Searches when it must. Cloth that already crosses the skin does
  /// not count.
  /// @param displacement  #V by 3, m: displacement of the skin
  /// @param predictor  #P by 3, m: predictor
  /// @return in [0, 1]; 0 before the first step
  double collision_free_step_fraction(const std::vector<Vec3>& x,
                                      const std::vector<Vec3>& displacement,
                                      const std::vector<Vec3>& predictor);
  /// Moves the body, with the same topology. Anchors of friction move with their skin;
  /// near pairs hold as far as skin and the cloth near it move alike.
  /// @param positions  #V by 3, m
  /// @param predictor  #P by 3, m: displacement of the cloth at x meanwhile; empty: none
  void move_body(const std::vector<Vec3>& positions, const std::vector<Vec3>& x,
                 const std::vector<Vec3>& predictor = {});
  /// Distance beyond the activation distance up to which pairs are kept, m: large where
  /// skin and cloth pass each other fast.
  void set_slack(double slack_m) {
    m_options.slack_m = slack_m;
    m_stale = true;
  }
  /// Coulomb coefficient from the next step on.
  void set_friction(double mu) { m_options.friction = mu; }
  /// Positions were changed by the caller: crossings are looked for at the next search,
  /// which comes before the next step.
  void refresh();
  /// State that persists from step to step and cannot be derived from positions: the ties
  /// of friction, and how hard crossed pairs are pushed.
  struct Memory {
    std::vector<Vec3> anchor;     ///< #P by 3, m
    std::vector<char> has_anchor; ///< #P
    double push = 1;              ///< factor on the stiffness of crossed pairs
  };
  /// For checkpoints.
  Memory memory() const { return {m_anchor, m_has_anchor, m_push}; }
  /// Takes the memory of a checkpoint.
  void recall(const Memory& memory);
  /// Cloth triangles through the skin or with a vertex inside, at the last search; 0 once
  /// all are free.
  std::size_t n_crossing() const { return m_n_crossing; }
  Vec3 crossing_place() const; ///< where the first of them was, m; only when there is one
  long searches = 0;           ///< for near pairs, so far
  long friction_calls = 0;     ///< steps in which friction was computed

private:
  /// Reach of edges and faces, as a share of the gap: they matter where the skin bulges between the
  /// cloth's vertices.
  static constexpr double EDGE_REACH = 0.5;
  /// Distances to the skin are not measured beyond this, m.
  static constexpr double FAR = 0.04;
  /// Cloth is searched for again when a particle has used this share of what it may move unseen.
  static constexpr double USED = 0.6;
  struct Pair {
    std::array<int, 3> slot; // off-diagonal blocks of the particles (0,1), (1,2), (2,0)
    std::array<int, 3> particle;
    std::array<int, 3> body; // vertices of the body
    int n, n_body;           // particles and body vertices in use
    bool crossed;            // pushed along the skin's normal, not guarded
    double reach, stiffness; // m, N/m
    double share = -1; // see share_of(): of add(), which leaves its change out of the force; < 0:
                       // not looked at there
    double clear = 0;  // m: not nearer than this at m_added_at; 0: not known
    bool guarded = false; // against the present step
  };
  /// A pair's closest points now.
  struct Closest {
    Vec3 normal;     // unit, from the skin to the cloth
    double distance; // negative only for crossed pairs
    std::array<double, 3> weight, body_weight;
    bool valid;
  };
  Closest closest(const Pair& pair, const std::vector<Vec3>& x) const;
  /// See edge_edge_mollifier()
  double share_of(const Pair& pair, const std::vector<Vec3>& x) const;
  void measure_moved(const std::vector<Vec3>& x) const;
  double farthest(const Pair& pair) const;
  static double against(const Pair& pair, const std::vector<Vec3>& displacement,
                        const std::vector<Vec3>& predictor);
  void guard(const Pair& pair, const Closest& c, MotionLimits& limits) const;
  bool guarded() const { return m_options.level == ContactLevel::CONTINUOUS; }
  void weigh_skin();
  void search(const std::vector<Vec3>& x);
  void find_crossed(const std::vector<Vec3>& x);
  void measure_clearance(const std::vector<Vec3>& x);
  void collect_pairs();
  void add_pair(const Pair& pair, const Closest& c, StepContext& context);
  void push_out(int particle, StepContext& context);
  void add_friction(StepContext& context);
  double friction_energy(const std::vector<Vec3>& x) const; ///< J
  void carry_anchors(const std::vector<Vec3>& positions);
  void measure_against(const std::vector<Vec3>& x, const std::vector<Vec3>& displacement,
                       const std::vector<Vec3>& predictor);

  const ClothMesh& m_mesh;
  collision::BodyCollider& m_body;
  BodyContactOptions m_options;
  std::vector<Triangle> m_triangles;
  collision::Topology m_topology;
  std::vector<int> m_edge_slot;                                 // by edge
  std::vector<double> m_edge_area, m_face_area, m_longest_edge; // by edge, triangle, triangle
  std::vector<double> m_body_face_weight, m_body_vertex_weight; // 0..1

  struct Nearing { // a pair that skin or carried cloth moves
    const Pair* pair;
    double room; // m: ends that come no nearer than that are left alone
    int measured = -1;
  };
  struct Measured {
    Closest closest;
    double skin_toward; // m
  };

  std::vector<Pair> m_pairs;
  std::vector<Nearing> m_nearing;   // of push_predictor_off_skin()
  std::vector<Measured> m_measured; // by pair; few of them ever need it
  collision::BodyPairs m_found;
  std::vector<Vec3> m_searched_at,
      m_added_at; // #P by 3, m: where the last search and the last add() saw the cloth
  mutable std::vector<double>
      m_moved;                     // #P, m: of each particle since m_added_at, or of a displacement
  std::vector<double> m_reach_now; // #P: may move this far from m_searched_at unseen
  std::vector<double>
      m_skin_moved; // #P, m: of skin near it against what carried it, at most, since the search
  collision::DisplacementBounds m_displacement_bounds;
  std::vector<double> m_against; // #P, m: of measure_against(), how far skin near it goes against
                                 // its predictor, at most
  bool m_stale = true, m_look_for_crossings = true;
  std::vector<char> m_inside, m_crossing, m_asked; // by particle, triangle, triangle
  std::size_t m_n_crossing = 0;
  double m_push = 1; // factor on the stiffness of crossed pairs

  struct Clearance {
    Vec3 at = Vec3::Zero();
    double distance = -1; // no skin nearer to `at`; negative: unknown
    int triangle = -1;
  };
  std::vector<Clearance> m_clearance;
  std::vector<Vec3> m_load; // contact force on each particle, N
  std::vector<double> m_load_stiffness,
      m_tangent; // N/m; the latter of the tie to the anchor, 0 for none
  std::vector<Vec3> m_anchor;
  std::vector<Vec3> m_carried; // how far the skin has taken each anchor since the last step, m
  std::vector<char> m_has_anchor;
};

} // namespace sloper::cloth
