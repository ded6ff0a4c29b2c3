/// Times of the collision module: a sphere of cloth (20 480 triangles, 10 242 particles) close
/// above a body. Usage: bench_collision [BODY.obj [THREADS]]; without a body, a lumpy ball of 327
/// 680 triangles. Prints milliseconds: the least of several runs.
#include <support/shapes.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <sloper/base/parallel.hpp>
#include <sloper/collision/body_collider.hpp>
#include <sloper/collision/intersections.hpp>
#include <sloper/collision/self_proximity.hpp>
#include <sloper/io/obj.hpp>

using namespace sloper;
using namespace sloper::collision;

namespace {

template<class Work> double report(const char* name, int runs, const Work& work) {
  double best = 1e300;
  for (int i = 0; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    best = std::min(
        best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                  .count());
  }
  std::printf("%-58s %9.3f ms\n", name, best);
  return best;
}

} // namespace

int main(int argc, char** argv) {
  if (argc > 2)
    set_thread_count(std::atoi(argv[2]));
  TriangleMesh body;
  if (argc > 1 && argv[1][0] != '-') {
    const io::ObjMesh obj = io::read_obj(argv[1]);
    body = {obj.positions, obj.triangles};
  } else {
    body = shapes::sphere(7, 0.5);
    for (Vec3& p : body.positions)
      p *= 1 + 0.02 * std::sin(12 * p.x()) * std::sin(10 * p.y()) * std::cos(11 * p.z());
  }
  std::printf("body: %zu triangles; threads: %d\n", body.triangles.size(), thread_count());

  BodyCollider collider;
  report("body: prepare", 1, [&] { collider = BodyCollider(body); });
  const BodyFindings& found = collider.findings();
  std::printf("  flipped %d, boundary edges %d, non-manifold edges %d, self intersections %d, "
              "untrusted %d, buried %d\n",
              found.flipped_triangles, found.boundary_edges, found.non_manifold_edges,
              found.self_intersections, found.untrusted_triangles, found.buried_triangles);
  report("body: move (refit, normals, winding moments)", 3,
         [&] { collider.set_positions(body.positions); });

  // cloth drawn onto the body, 5 mm above it
  const Box3 box = bounding_box(body.positions);
  TriangleMesh cloth = shapes::sphere(5);
  for (Vec3& p : cloth.positions)
    p = box.center() + Vec3(0, 0.1 * box.size().y(), 0) +
        p.cwiseProduct(Vec3(0.35, 0.2 * box.size().y(), 0.35));
  for (int i = 0; i < 20; ++i)
    for (Vec3& p : cloth.positions) {
      const SignedDistance d = collider.signed_distance(p, 10);
      p -= 0.5 * (d.distance - 0.005) * d.normal;
    }
  std::vector<int> hints(cloth.positions.size(), -1);
  std::vector<SignedDistance> distances(cloth.positions.size());
  const auto query = [&](double reach, bool hinted) {
    parallel_for(cloth.positions.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        distances[v] = collider.signed_distance(cloth.positions[v], reach, hinted ? hints[v] : -1);
    });
  };
  report("body: signed distance of all particles, reach 2 cm", 10, [&] { query(0.02, false); });
  for (std::size_t v = 0; v < hints.size(); ++v)
    hints[v] = distances[v].triangle;
  report("body: signed distance, reach 2 cm, hinted", 10, [&] { query(0.02, true); });
  report("body: signed distance, reach unbounded", 10, [&] { query(1e9, false); });
  report("body: winding number of all particles", 2, [&] {
    parallel_for(cloth.positions.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        distances[v].distance = collider.winding_number(cloth.positions[v]);
    });
  });
  std::size_t n_through = 0, n_contacts = 0;
  report("body: faces through", 5,
         [&] { n_through = collider.faces_through(cloth.positions, cloth.triangles).size(); });
  const Topology topology = make_topology(cloth.positions.size(), cloth.triangles);
  report("body: face and edge contacts, radius 6 mm", 5, [&] {
    n_contacts = collider.face_contacts(cloth.positions, cloth.triangles, topology, 0.006).size();
  });
  std::printf("  %zu faces through, %zu contacts\n", n_through, n_contacts);

  // the cloth against itself, on a sphere of even edges, jittered so that features come near
  cloth = shapes::sphere(5, 0.5);
  double edge = 0;
  for (const auto& e : topology.edges)
    edge += (cloth.positions[e[0]] - cloth.positions[e[1]]).norm() /
            static_cast<double>(topology.edges.size());
  shapes::jitter(cloth, 0.15 * edge, 5);
  const double radius = 0.6 * edge;
  for (int k : {6, 14, 18, 26}) {
    TriangleTree tree;
    std::printf("k = %d\n", k);
    report("  build tree", 3, [&] { tree = TriangleTree(cloth.positions, cloth.triangles, k); });
    report("  refit tree", 10, [&] { tree.refit(cloth.positions); });
    report("  self intersections", 5,
           [&] { self_intersections(cloth.positions, cloth.triangles, tree); });
    report("  edge-face intersections", 5,
           [&] { edge_face_intersections(cloth.positions, cloth.triangles, topology, tree); });
    SelfProximity proximity(cloth.positions.size(), cloth.triangles, {}, k);
    TriangleMesh moved = cloth;
    report("  self proximity, first", 1, [&] { proximity.update(moved.positions, radius); });
    int turn = 0;
    report("  self proximity, everything moved by half an edge", 5, [&] {
      for (std::size_t v = 0; v < moved.positions.size(); v += 2)
        moved.positions[v] = cloth.positions[v] + Vec3(0, ++turn % 2 ? 0.5 * edge : 0, 0);
      proximity.update(moved.positions, radius);
    });
    moved = cloth;
    report("  self proximity, small moves", 20, [&] {
      moved.positions[7] += Vec3(0, 1e-6, 0);
      proximity.update(moved.positions, radius);
    });
    std::printf("  %zu vertex-face, %zu edge-edge pairs, %d rebuilds\n",
                proximity.vertex_face().size(), proximity.edge_edge().size(),
                proximity.n_rebuilds());
  }
  return 0;
}
