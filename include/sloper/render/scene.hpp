#pragma once
/// The scene that is drawn: meshes with a colour per vertex, collected from documents and
/// OBJ files.
#include <optional>
#include <sloper/base/message.hpp>
#include <sloper/body/body.hpp>
#include <sloper/garment/garment.hpp>
#include <string>

namespace sloper::render {

/// Distance within which a panel's vertex counts as near a border, m; border distances
/// are clamped to it.
inline constexpr double BORDER_REACH = 0.02; // m
/// Value of a vertex for which the map is not defined.
inline constexpr double NO_VALUE = -1e9;

/// A surface to be drawn. Vertices of different panels are not shared, so that panels
/// keep sharp colours.
struct DrawMesh {
  std::string name;            ///< of its file, without folder and ending
  std::vector<Vec3> positions; ///< m
  /// Cloth that was made smooth: where the vertex lies on the draped triangles, m; else empty.
  std::vector<Vec3> flat;
  int pieces = 1; ///< triangles into which each draped triangle was cut; they follow each other
  std::vector<Vec3> normals;              ///< unit; smooth over welded seams
  std::vector<Vec3> colors;               ///< linear RGB, 0..1
  std::vector<Triangle> triangles;        ///< counter-clockwise seen from outside
  std::vector<std::array<int, 2>> lines;  ///< borders of panels, drawn darker
  std::vector<char> is_hem;               ///< by line: a free border, not a seam
  bool is_cloth = false, is_flat = false; ///< flat: drawn unlit
  bool is_closed = false; ///< a body without a hole, seen from outside: its far side never shows
  // Cloth only; empty elsewhere.
  std::vector<Vec2> uv; ///< m, across and along the warp: the fabric's pattern lies on it
  /// Pattern distance to the nearest sewn and free border, m, at most BORDER_REACH.
  std::vector<double> seam, hem;
  std::vector<double> values;      ///< of the map, in its unit; NO_VALUE or empty: none
  std::vector<int> panel_of;       ///< by vertex
  std::vector<std::string> panels; ///< their names
  double thickness = 0;            ///< m
};

/// Whether the triangles at each edge use it equally often in both directions, and the
/// mesh is oriented outwards. O(#F).
bool is_closed(const TriangleMesh& mesh);

/// An edge of a pattern that a question of pattern-mesh is about.
struct AskedEdge {
  int question = 0;        ///< from 1 on, in the order of the document
  int answer = 0;          ///< 0: the edge that is asked for; else the answer that sews it to that
  std::string panel, edge; ///< names
};

/// Documents as they are drawn: the data and its meshes.
struct Scene {
  std::optional<body::Body> body;         ///< of the documents
  std::vector<garment::Garment> garments; ///< in the order of the documents
  std::vector<int> garment_mesh;          ///< by garment: its mesh
  int body_mesh = -1;                     ///< of `body`
  bool draped = false;                    ///< there is a garment, not only panels
  std::vector<DrawMesh> meshes;           ///< in the order of the documents
  std::vector<std::string> names;         ///< file names, for the PNG's text chunk
  std::vector<AskedEdge> asked;           ///< of a sidecar with questions
  /// Garments that hang on another body than the one beside them, or pass through each other.
  std::vector<Message> findings;
};

/// Reads documents by their "format" (body.json, shirt.json, panels.json) and bare OBJ,
/// PLY or STL files (in metres). A sidecar of seams belongs to the patterns beside it; its
/// questions are kept.
/// @param paths  in drawing order
/// @throws Error INPUT
Scene read_scene(const std::vector<std::string>& paths);

/// A garment as it is drawn: one vertex per panel vertex, normals over welded seams.
DrawMesh cloth_mesh(const garment::Garment& garment);

/// Makes the cloth among the meshes smooth for drawing: triangles are cut in four along curved
/// patches (Phong tessellation, Boubekeur and Alexa 2008) until edges are finer than about 6 mm or
/// a mesh has 200,000 triangles; free borders get a rim as thick as the fabric. What a mesh holds
/// per vertex is interpolated linearly; border distances are measured anew.
///
/// The smooth surface passes neither through a mesh that is no cloth nor through cloth, where the
/// draped triangles do not: it lies nearer to those there (see ClothClearance).
/// @param as_model  for another program, in which the body may stand beside it. Where all meshes
/// are cloth the skin is unknown then: nothing goes behind the draped triangles, no rim either
void smooth_cloth(std::vector<DrawMesh>& meshes, bool as_model = false);

/// How cloth is coloured: each panel its own colour, or each garment one.
enum class ClothColors { PANELS, GARMENTS };
/// @param colors  0xRRGGBB by garment; those that are missing come from the fabric (denim, silk,
/// wool, jersey, canvas), once each, or a palette
void color_cloth(Scene& scene, ClothColors how, const std::vector<int>& colors = {});

/// 0xRRGGBB to linear light.
Vec3 linear_color(int hex);
/// Muted panel colours that differ for colour-blind eyes too (after Okabe and Ito 2008,
/// softened), linear RGB.
/// @param k  number of the panel; colours repeat after 8
Vec3 panel_color(int k);

} // namespace sloper::render
