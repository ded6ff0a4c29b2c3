# shellcheck shell=bash disable=SC2034
good=(0)
inputs=(skirt.pattern.json a.body.json a.body.obj)
command_line=(--edge-length 0.05 --body a.body.json -o out.json skirt.pattern.json)

case_what_is_no_pattern_is_told_with_a_next_step() {
  run 0 "$program" -q --edge-length 0.05 -o panels.json skirt.pattern.json
  run 3 "$program" -o out.json panels.json
  says 'is a "panels" document, which is already meshed; give the pattern that it was made from'
  echo hello > hello.txt
  run 3 "$program" -o out.json hello.txt
  says "is neither JSON nor a text DXF; give a pattern JSON"
  grep -v length_unit skirt.pattern.json > unitless.json
  run 3 "$program" -o out.json unitless.json
  says 'has no "length_unit"; add for example "length_unit": "cm"'
  run 2 "$program" -o - skirt.pattern.json
  says "cannot go to standard output"
  run 3 "$program" --edits "$data/skirt.json" -o out.json skirt.pattern.json
  says 'is a "garment" document, not edits'
  # shellcheck disable=SC2016
  run 5 bash -c '"$0" --check skirt.pattern.json > /dev/full' "$program"
  run 5 "$program" --write-pattern no/such/folder/x.json -o out.json skirt.pattern.json
}

case_a_check_is_of_the_edited_pattern() {
  echo '{"format": "edits", "version": 1, "length_unit": "cm", "edits": [{"edit": "scale", "x": 2, "y": 2}]}' > twice.json
  run 0 "$program" --check skirt.pattern.json
  cp stdout as_drawn
  run 0 "$program" --check --edits twice.json --write-pattern twice.pattern.json skirt.pattern.json
  cmp -s stdout as_drawn && fail "the edits changed no measure"
  cp stdout edited
  run 0 "$program" --check twice.pattern.json
  cmp stdout edited || fail "the pattern that was written measures otherwise"
}

case_names_that_tell_nothing_are_warned_of() {
  local outline='[{"edge": "hem", "path": [["M", 0, 0], ["L", 42, 0]]}, {"edge": "l", "path": [["L", 42, 12]]}, {"edge": "top", "path": [["L", 0, 12]]},
    {"edge": "r", "path": [["L", 0, 0]]}]'
  cat > tube.json << EOF
{"format": "pattern", "version": 1, "length_unit": "cm", "name": "tube",
 "panels": [{"name": "P1", "outline": $outline}, {"name": "P2", "outline": $outline}],
 "seams": [{"name": "a", "a": [{"panel": "P1", "edge": "l"}], "b": [{"panel": "P2", "edge": "r"}]},
           {"name": "b", "a": [{"panel": "P2", "edge": "l"}], "b": [{"panel": "P1", "edge": "r"}]}]}
EOF
  run 0 "$program" --edge-length 0.05 --body a.body.json -o out.json tube.json
  says "placed by their shapes: P1 (lower_body, front), P2 (lower_body, back)"
}

case_sides_that_differ_in_length_are_sewn_with_a_warning() {
  # the corner at the hip, whatever the body's measures made of it: 4 cm up on one side of the seam
  local corner
  corner=$(grep -oE '"L", 2[0-9.]*, -1[0-9.]*' skirt.pattern.json | head -n 1)
  [[ -n $corner ]] || fail "no corner at the hip"
  python3 - "$corner" << 'PY'
import sys
text = open("skirt.pattern.json", encoding="utf-8").read()
_, x, y = sys.argv[1].split(", ")
for letter in "LM":
    text = text.replace(f'"{letter}", {x}, {y}', f'"{letter}", {x}, {float(y) + 4:g}', 1)
open("longer.json", "w", encoding="utf-8").write(text)
PY
  run 1 "$program" --check longer.json
  run 0 "$program" --edge-length 0.05 -o out.json longer.json
  says "apart"
  grep -q "apart" out.json || fail "no finding"
}

case_a_size_of_no_person_is_meshed_with_a_warning() {
  sed 's/"length_unit": "cm"/"length_unit": "mm"/' skirt.pattern.json > small.json
  run 1 "$program" --check small.json
  grep -q 'error: wrong-unit: .* nobody is that small; .* check "length_unit"' stdout || fail "not told"
  run 0 "$program" --edge-length 0.005 -o out.json small.json
  says "nobody is that small"
  grep -q "nobody is that small" out.json || fail "no finding"
}

case_a_missing_seam_is_meshed_with_a_warning() {
  # A side of the skirt's left half, drawn in two edges; what is left is still JSON.
  python3 - skirt.pattern.json > open.json << 'EOF'
import json, sys
document = json.load(open(sys.argv[1]))
document["seams"] = [s for s in document["seams"] if s["name"] not in ("front_l.side", "front_l.side_hip")]
print(json.dumps(document))
EOF
  run 1 "$program" --check open.json
  [[ $(grep -c 'error: open-seam: front_l: side' stdout) -eq 2 ]] || fail "not both edges are told"
  run 0 "$program" --edge-length 0.05 -o out.json open.json
  says "front_l: side: is not sewn to back_l: side, though it seems to belong there"
  grep -q "is not sewn to back_l: side" out.json || fail "no finding"
}

case_what_is_half_sewn_is_told_by_the_check_and_with_the_mesh() {
  # Both sides of the skirt hang open: each half looks like the other.
  python3 - skirt.pattern.json > open.json << 'EOF'
import json, sys
document = json.load(open(sys.argv[1]))
document["seams"] = [s for s in document["seams"] if ".side" not in s["name"]]
print(json.dumps(document))
EOF
  run 0 "$program" --check skirt.pattern.json
  run 1 "$program" --check open.json
  grep -q 'error: half-sewn: front_l: side_hip: is open over .* cm and back_l: side_hip' stdout || fail "not told"
  run 0 "$program" --edge-length 0.05 --body a.body.json -o out.json open.json
  says "is one sewn to the other?"
  grep -q '"pattern.half-sewn"' out.json || fail "no finding"
  "$(dirname "$program")/drape" -q --body a.body.json --panels out.json --accuracy draft --set max_steps=5 \
    --report open.report.json -o worn.json || true # 5 steps are too few
  grep -q '"pattern.half-sewn"' open.report.json || fail "the drape does not say so"
  # The same as a drawing whose seams were answered: one was missed.
  python3 - open.json << 'EOF'
import json, sys
document = json.load(open(sys.argv[1]))
def runs(side, along):  # without a direction the second side is met against its outline
    ahead = lambda r: r.get("from", 0) < r.get("to", 1) if "from" in r else along
    return [{"panel": r["panel"], "run": r["edge"], "dir": "+" if ahead(r) else "-"} for r in side]
seams = [{"name": s["name"], "kind": s.get("kind", "seam"), "a": runs(s["a"], True),
          "b": runs(s["b"], False)} for s in document["seams"]]
json.dump({"format": "sewing-seams", "version": 1, "seams": seams}, open("seams.json", "w"))
json.dump(dict(document, seams=[]), open("drawn.json", "w"))
EOF
  run 0 "$program" -q --write-pattern drawn.dxf drawn.json
  run 4 "$program" --edge-length 0.05 --sewing seams.json -o answered.json drawn.dxf
  says "is one sewn to the other?"
  [[ -s answered.json ]] || fail "not written"
  python3 - << 'EOF' || fail "the mesh does not bear its fault"
import json
mesh, sound = (json.load(open(name + ".json")) for name in ("answered", "out"))
assert mesh["faults"] and set(mesh["faults"]) <= set(mesh["findings"]), mesh["findings"]
assert "faults" not in sound
EOF
}

# A roll line of the pattern 9 mm from the seam of a collar: with edges of 30 mm it was left out, and the collar folded elsewhere.
case_a_collar_keeps_a_roll_line_near_its_outline() {
  local makers
  makers=$(dirname "${program%/*}")/samples
  run 0 "$makers/make-pattern" -q shirt --body a.body.json -o plain.json
  python3 - << 'EOF'
import json

pattern = json.load(open("plain.json"))
collar = next(panel for panel in pattern["panels"] if panel["name"] == "collar")
edges = {edge["edge"]: edge["path"] for edge in collar["outline"]}
corner, curve = edges["low"]
low = [corner[1:], curve[1:3], curve[3:5], curve[5:7]]
corner, curve = edges["free"]
free = [curve[5:7], curve[3:5], curve[1:3], corner[1:]]
a, b, c, d = [[p + 0.18 * (q - p) for p, q in zip(*ends)] for ends in zip(low, free)]
collar["lines"] = [{"name": "roll", "kind": "roll", "path": [["M"] + a, ["C"] + b + c + d]}]
json.dump(pattern, open("rolled.json", "w"))
EOF
  run 0 "$program" -q --edge-length 0.03 -o plain.panels.json plain.json
  run 0 "$program" -q --edge-length 0.03 --body a.body.json -o rolled.panels.json rolled.json
  python3 - << 'EOF' || fail "the mesh has no edges along the roll line, or others changed"
import json

plain, rolled = (json.load(open(name + ".panels.json")) for name in ("plain", "rolled"))
assert not any(finding["id"] == "mesh.line-left-out" for finding in rolled.get("findings", [])), rolled["findings"]
sizes = [{panel["name"]: panel["vertices"][1] for panel in mesh["panels"]} for mesh in (plain, rolled)]
assert sizes[1]["collar"] > 2 * sizes[0]["collar"], sizes
assert all(sizes[0][name] == sizes[1][name] for name in sizes[0] if name not in ("collar", "stand")), sizes
EOF
  run 0 "${program%/*}/drape" -q --accuracy draft --body a.body.json --panels rolled.panels.json --report r.json -o s.json
  python3 -c 'import json
(line,) = json.load(open("r.json"))["roll_lines"]
assert line["turned_share"] > 0.9 and line["inwards_share"] < 0.05, line' || fail "the collar stands"
}

case_a_unit_on_the_command_line_that_makes_a_giants_garment_is_refused() {
  run 0 "$program" -q --write-pattern skirt.dxf skirt.pattern.json
  run 0 "$program" --unit mm --edge-length 0.05 -o out.json skirt.dxf
  rm out.json
  local unit
  for unit in cm in m; do
    run 3 "$program" --unit "$unit" --edge-length 0.05 -o out.json skirt.dxf
    says "skirt.dxf: back_l"
    [[ ! -e out.json ]] || fail "$unit: meshed"
  done
}

# A drawing of the skirt without seams, with edges that have numbers for names: some seams are asked
# for.
draw_unsewn() {
  python3 - skirt.pattern.json > drawn.json << 'EOF'
import json, sys
document = json.load(open(sys.argv[1]))
document["seams"] = []
for panel in document["panels"]:
    for number, edge in enumerate(panel.get("outline", [])):
        edge["edge"] = f"edge{number}"
print(json.dumps(document))
EOF
  run 0 "$program" -q --write-pattern drawn.dxf drawn.json
}

case_first_answers_are_taken_where_nobody_wants_to_be_asked() {
  draw_unsewn
  run 1 "$program" --edge-length 0.05 -o asked.json drawn.dxf
  says "answers with --answers first"
  says "draws the edges that are asked for"
  cp stdout questions.json
  python3 -c 'import json; assert json.load(open("questions.json"))["questions"]' || fail "nothing is asked"
  run "0|4" "$program" --edge-length 0.05 --answers first -o first.json drawn.dxf
  says "the first answers to"
  cp stdout sewing.json
  python3 - << 'EOF' || fail "not what was asked for"
import json

questions, sewing, first = (json.load(open(name + ".json")) for name in ("questions", "sewing", "first"))
assert not sewing["questions"]
edges = lambda seam: [(run["panel"], run["run"]) for side in "ab" for run in seam[side]]
sewn = [edge for seam in sewing["seams"] for edge in edges(seam)]
assert len(sewn) == len(set(sewn)), sewn
names = [seam["name"] for seam in sewing["seams"]]
assert all(seam["name"] in names for seam in questions["seams"])
best = max(questions["questions"], key=lambda question: question["candidates"][0]["score"])
assert best["candidates"][0]["name"] in names
taken = [text for text in first["findings"] if "is a first answer" in text]
assert len(taken) == len(names) - len(questions["seams"]), taken
EOF
  # What was written is a sidecar: it may be corrected, and sews the same.
  run "0|4" "$program" --edge-length 0.05 --sewing sewing.json -o again.json drawn.dxf
  python3 -c 'import json
a, b = ([s["name"] for s in json.load(open(n + ".json"))["pattern"]["seams"]] for n in ("first", "again"))
assert sorted(a) == sorted(b), (a, b)' || fail "the sidecar sews other seams"
  # Where nothing is found for a piece, the status says so.
  python3 - << 'EOF'
import json

document = json.load(open("drawn.json"))
for name, corners in ("odd", [[0, 0], [250, 0], [120, 220]]), ("spare", [[0, 0], [2, 0], [3, 13], [-4, 11]]):
    count = len(corners)
    outline = [{"edge": f"edge{k}", "path": [["L"] + corners[(k + 1) % count]]} for k in range(count)]
    outline[0]["path"].insert(0, ["M"] + corners[0])
    panels = document["panels"] + [{"name": name, "outline": outline}]
    json.dump(dict(document, panels=panels), open(name + ".json", "w"))
EOF
  run 0 "$program" -q --write-pattern odd.dxf odd.json
  run 4 "$program" --edge-length 0.05 --answers first -o odd.panels.json odd.dxf
  says "nothing is found that odd is sewn to"
  [[ -s odd.panels.json ]] || fail "not written"
  # A small one is left out, and named.
  run 0 "$program" -q --write-pattern spare.dxf spare.json
  run "0|4" "$program" --edge-length 0.05 --answers first -o spare.panels.json spare.dxf
  says "nothing is found for them: spare"
  grep -q '"spare"' stdout || fail "the sidecar does not leave it out"
}

# The undo is made edit by edit, and each was called the first.
case_a_wrong_edit_is_named_by_its_place_with_undo_too() {
  cp "$data/skirt.pattern.json" .
  local panel
  panel=$(python3 -c 'import json; print(json.load(open("skirt.pattern.json"))["panels"][0]["name"])')
  echo '{"format": "edits", "version": 1, "length_unit": "cm", "edits": [{"edit": "scale", "x": 1.01, "y": 1.01}, {"edit": "move-edge", "panel": "'"$panel"'", "edge": 0, "by": 1}]}' > e.json
  run 3 "$program" --edits e.json --write-pattern q.json skirt.pattern.json
  says "/edits/1/by"
  run 3 "$program" --edits e.json --undo u.json skirt.pattern.json
  says "/edits/1/by"
}

case_a_fault_that_an_edit_made_is_told_where_the_pattern_is_written() {
  printf '%s' '{"format": "edits", "version": 1, "length_unit": "cm", "edits": [{"edit": "scale", "panel": "front_l", "x": 1.0, "y": 0.8}]}' > edits.json
  run 0 "$program" -v --edits edits.json --write-pattern edited.json "$data"/skirt.pattern.json
  says "warning: after the edits: "
  says "[pattern.fault-by-edit]"
  run 0 "$program" --write-pattern same.json "$data"/skirt.pattern.json
  ! grep -q "after the edits" stderr || fail "tells of edits where none were made"
}
