# shellcheck shell=bash disable=SC2034
good=(4) # ten steps do not bring it to rest
inputs=(skirt.json skirt.obj b.body.json b.body.obj)
command_line=(--garment skirt.json --to b.body.json --accuracy draft --set max_steps=10 -o out.json)

case_a_cache_changes_no_byte() { a_cache_changes_no_byte; }

# A verdict asked for by a policy is an answer, whether the drape comes to its end or is ended by it; without a policy no garment was made.
case_what_does_not_fit_ends_with_1_under_a_policy_and_with_4_without() {
  local policy
  local of=(--garment skirt.json --to b.body.json --accuracy draft --fit fit.json --report report.json -o out.json)
  for policy in '"slip_m": 0.005' '"slip_m": 9, "default": {"too_large_ease": 0.001}'; do
    printf '{"format": "fit-policy", "version": 1, %s}' "$policy" > policy.json
    run 1 "$program" "${of[@]}" --policy policy.json
    says "does not fit: the garment"
    grep -q '"fits": false' fit.json || fail "$policy: the report says that it fits"
    [[ $policy != '"slip_m": 0.005' ]] || grep -q "slides down too far to fit" report.json || fail "the drape was not ended by it"
  done
  run 4 "$program" "${of[@]}"
  says "does not fit: the garment" # slides down, or stays stretched: what comes first is the body's
  printf '{"format": "fit-policy", "version": 1, "default": {"too_small_ease": 0.9}}' > policy.json
  run 1 "$program" "${of[@]}" --fit-page fit.html --policy policy.json
  says "; out.json has it as it was placed, not draped"
  grep -q '"state": "placed"' fit.json || fail "the fit report does not say that it was not draped"
  grep -q "as it was placed" fit.html || fail "the page does not say that it was not draped"
}

# Measures two scans of the shared data, from.json and to.json, and drapes a pattern of theirs on the first: worn.json. Skips without them.
dress_from_shared() { # FROM TO PATTERN [DRAPE_OPTION...]; the caller's `edge` is the mesh's, m
  local shared=${SLOPER_SHARED:-}/data folder=${program%/*} sewing=()
  [[ -d $shared ]] || { echo "SKIPPED: SLOPER_SHARED does not name a folder with data"; exit 77; }
  local pattern=$shared/patterns/$3
  [[ $pattern != *.dxf ]] || sewing=(--sewing "${pattern%.dxf}.seams.json")
  run 0 "$folder/scan-landmarks" -q -o from.json "$shared/bodies/$1.obj"
  run 0 "$folder/scan-landmarks" -q -o to.json "$shared/bodies/$2.obj"
  run 0 "$folder/pattern-mesh" -q ${edge:+--edge-length "$edge"} --body from.json "${sewing[@]}" -o panels.json "$pattern"
  run 0 "$folder/drape" -q --body from.json --panels panels.json "${@:4}" -o worn.json
}

# Cloth slid 5 mm on a bust more pointed than the one that it came from, and a girth graded for below it was stretched there by an eighth.
case_a_shirt_made_over_for_a_body_that_it_is_too_tight_on_is_let_out() {
  dress_from_shared smpl/f_smpl_average_A40 plain/body_008 garmentcode/tshirt_f_smpl_average_A40_specification.json
  run 0 "$program" -v --garment worn.json --to to.json --mode keep-fit --report report.json -o there.json
  says "let out there"
  grep -q '"gradings": [2-4]' report.json || fail "the report does not say that it was graded more than once"
}

# The collar is placed in the chin of a body with a shorter neck: what clearing leaves there, the drape brings out.
case_a_collar_that_is_placed_in_a_chin_is_brought_out() {
  local edge=0.025
  # sewn on the given mesh alone: by way of the coarse one the shirt hangs otherwise, and its drape there is ended as too small
  dress_from_shared plain/body_006 plain/body_004 sewing/dxf/shirt.dxf --accuracy draft --material denim --set levels=1
  run 4 "$program" --accuracy draft --garment worn.json --to to.json --report report.json -o there.json
  says "does not fit"
  python3 -c 'import json
report = json.load(open("report.json"))
assert report["placement"]["placed"]["faces_through_body"] > 100, "the collar was not in the chin"
assert report["stop_reason"] == "at rest" and report["quality"]["faces_through_body"] == 0, report["quality"]' || fail "faces are still through the skin"
}

# Two particles that were kept in place for a pinch bore four fifths of the skirt's weight, 5 cm down, and it was said to be at rest.
case_a_skirt_too_wide_slides_to_where_the_hip_bears_it() {
  local slip
  dress_from_shared smpl/f_smpl_average_A40 plain/body_008 garmentcode/pencil_skirt_f_smpl_average_A40_specification.json
  run 0 "$program" -q --garment worn.json --to to.json --fit fit.json -o there.json
  slip=$(python3 -c 'import json; print(round(1e3 * json.load(open("fit.json"))["slip_m"]))')
  ((slip > 90 && slip < 140)) || fail "it slid $slip mm; solved finely, 118"
}

# keep-fit moves the mesh off the lines that its pattern drew, and the report had no roll line.
case_a_collar_that_is_made_over_is_judged_by_its_roll_line() {
  local makers folder=${program%/*}
  makers=$(dirname "$folder")/samples
  cp "$data"/a.body.{json,obj} .
  echo '{"format": "scene", "version": 1, "roll_lines": [{"panel": "collar", "from": [0.06, 0.06], "via": [[0.5, 0.62]], "to": [0.94, 0.06]}]}' > roll.json
  run 0 "$makers/make-pattern" -q shirt --body a.body.json -o s.pattern.json
  run 0 "$folder/pattern-mesh" -q --body a.body.json --edge-length 0.02 -o s.panels.json s.pattern.json
  run 0 "$folder/drape" -q --accuracy draft --scene roll.json --body a.body.json --panels s.panels.json -o s.json
  run "0|4" "$program" --accuracy draft --mode keep-fit --garment s.json --to "$data/b.body.json" --report report.json -o there.json
  python3 -c 'import json
(line,) = json.load(open("report.json"))["roll_lines"]
assert line["turned"] and line["turned_share"] > 0.8, line' || fail "the collar stands, or nothing is said of it"
  # Made over, its mesh is off the lines of the pattern: it was said to be turned over by 17 %, and the leaf measured as the neck.
  run "0|4" "$program" --accuracy draft --garment there.json --to "$data/b.body.json" --report report.json --fit fit.json -o again.json
  python3 -c 'import json
(line,) = json.load(open("report.json"))["roll_lines"]
assert line["turned_share"] > 0.8, line
fit = json.load(open("fit.json"))
assert "neck_edge" not in fit["girths"] and "turned over" in fit["left_out"]["neck edge"], fit["left_out"]' || fail "the lines are lost"
}

# A mesh without a pattern comes out with the lines that it came with, but for coordinates; its materials go along.
case_a_mesh_without_a_pattern_comes_out_as_it_came_in() {
  cp "$data"/a.body.{json,obj} .
  mkdir in out
  { echo "mtllib cloth.mtl"; awk '/^v /{print} /^f /{if (!n++) print "usemtl cloth"; printf "f"; for (i = 2; i <= 4; i++) { split($i, a, "/"); printf " %s", a[1] } print ""}' skirt.obj; } > in/skirt.obj
  printf 'newmtl cloth\nmap_Kd weave.png\n' > in/cloth.mtl
  echo picture > in/weave.png
  run 0 "$program" --no-drape --garment in/skirt.obj --from a.body.json --to b.body.json --report report.json -o out/skirt-b.obj
  cmp <(grep -v '^v ' in/skirt.obj) <(grep -v '^v ' out/skirt-b.obj) || fail "more than coordinates differ"
  cmp in/cloth.mtl out/cloth.mtl || fail "the materials did not go along"
  cmp in/weave.png out/weave.png || fail "the texture did not go along"
  [[ $(grep -c '^v ' out/skirt-b.obj) -eq $(grep -c '^v ' in/skirt.obj) ]] || fail "vertices are missing"
  grep -q '"rest_shape": "mesh"' report.json || fail "the report does not say what the mesh was taken for"
  run 0 "$program" --no-drape --garment in/skirt.obj --from a.body.json --to b.body.json -o out/skirt-b.json
  [[ -s out/skirt-b.json && -s out/skirt-b.obj && -s out/skirt-b.mesh.obj ]] || fail "document, its mesh and the garment's own are not all there"
  run 0 "$program" --no-drape --garment skirt.obj --from a.body.json --to b.body.json --report report.json -o out/skirt-b.obj
  grep -q '"rest_shape": "texture"' report.json || fail "the flat pattern in its texture coordinates was not seen"
}

# Cloth that lies as close on the body that wore it as a girth of it may have been stretched there: it fits, as far as is known.
case_a_mesh_whose_strain_is_unknown_fits_as_far_as_is_known() {
  cp "$data"/a.body.{json,obj} .
  awk '/^v /{print} /^f /{printf "f"; for (i = 2; i <= 4; i++) { split($i, a, "/"); printf " %s", a[1] } print ""}' skirt.obj > plain.obj
  printf '{"format": "fit-policy", "version": 1, "strain_p99": 1000, "strain_max": 1000, "default": {"too_small_strain": 1000, "loose_ease": 1000, "too_large_ease": 1000}, "slip_m": 9}' > wide.json
  local file
  for file in plain.obj skirt.obj; do
    run 4 "$program" --garment $file --from a.body.json --to a.body.json --policy wide.json --accuracy draft --set max_steps=10 --fit $file.fit.json --fit-page $file.html -o out.json
  done
  python3 -c 'import json
mesh, pattern = (json.load(open(name + ".obj.fit.json")) for name in ("plain", "skirt"))
assert "strain_unknown" in mesh and "strain_unknown" not in pattern
assert 0 <= mesh["probability"]["fits"] <= 1 and 0 <= pattern["probability"]["fits"] <= 1
assert json.load(open("out.json")).get("strain_unknown") is None' || fail "the reports do not say whose strain is unknown"
  grep -q "It fits with a probability of" plain.obj.html || fail "the page does not say how likely it fits"
  run 4 "$program" --garment plain.obj --from a.body.json --to a.body.json --accuracy draft --set max_steps=10 -o out.json
  grep -q '"strain_unknown": true' out.json || fail "the garment does not keep that its strain is unknown"
}

case_what_a_mesh_needs_and_what_it_does_not() {
  cp "$data"/a.body.{json,obj} .
  run 2 "$program" --garment skirt.obj --to b.body.json -o out.json
  says "give the body.json of that body"
  run 2 "$program" --garment skirt.json --from a.body.json --to b.body.json -o out.json
  run 2 "$program" --garment skirt.json --to b.body.json -o out.obj
  run 2 "$program" --garment skirt.obj --from a.body.json --to b.body.json -o out.ply
  says "comes out as it came in"
  awk '/^v /{$4 += 9} {print}' skirt.obj > far.obj
  run 3 "$program" --garment far.obj --from a.body.json --to b.body.json -o out.json
  says "far.obj: lies nowhere near the body"
  [[ ! -e out.json && ! -e out.obj ]] || fail "something was written"
}

case_of_several_sizes_the_nearest_is_taken() {
  cp skirt.json skirt@M.json && cp skirt.obj skirt@M.obj
  sed -i 's/"skirt.obj"/"skirt@M.obj"/' skirt@M.json
  sed 's/\("level:[a-z_]*": \)[0-9.]*/\19/g; s/"skirt@M.obj"/"skirt@XXL.obj"/' skirt@M.json > skirt@XXL.json
  cp skirt.obj skirt@XXL.obj
  run 0 "$program" -v --no-drape --nearest-size --garment skirt@XXL.json --to b.body.json --report report.json -o out.json
  says "skirt@M.json"
  grep -q '"sureness"' report.json || fail "the report does not rank the sizes"
  run 3 "$program" --no-drape --nearest-size --garment skirt.json --to b.body.json -o out.json
  says "its name has no size"
}

# What pattern-mesh found, how long it is, how it was put on, and the built-in policy by its name.
case_the_fit_report_carries_findings_lengths_and_mode() {
  python3 - << 'PYTHON'
import json
document = json.load(open("skirt.json"))
document["findings"] = ['band "top" is 2 cm too short'] + document.get("findings", [])
document["finding_ids"] = ["placement.too-tight"] + document.get("finding_ids", [])
document["converged"] = True
json.dump(document, open("skirt.json", "w"))
PYTHON
  run "1|4" "$program" --garment skirt.json --to b.body.json --accuracy draft --set max_steps=30 --policy woven \
    --fit fit.json --fit-csv fit.csv --fit-page fit.html -o out.json
  python3 - << 'PYTHON' || fail "$(head -c 600 fit.json)"
import csv, json
fit = json.load(open("fit.json"))
assert fit["findings"][0] == 'band "top" is 2 cm too short', fit["findings"]
assert fit["finding_ids"][0] == "placement.too-tight" and len(fit["findings"]) == len(fit["finding_ids"])
assert fit["mode"] == "keep-fabric" and fit["policy"] == "woven", (fit["mode"], fit["policy"])
hem = fit["lengths"]["hem"]
assert hem["place"] in ("knee", "crotch", "ankle", "hip") and hem["verdict"] in ("same", "shorter", "longer"), hem
rows = list(csv.DictReader(open("fit.csv", newline="")))
assert any(r["kind"] == "finding" and r["girth"] == "placement.too-tight" for r in rows), rows
assert any(r["kind"] == "length" and r["girth"] == "hem" and r["verdict"] == hem["verdict"] for r in rows), rows
page = open("fit.html").read()
assert "band &quot;top&quot; is 2 cm too short" in page and "mode: keep-fabric" in page and "<h2>Length</h2>" in page
PYTHON
  run 3 "$program" --garment skirt.json --to b.body.json --policy wovn -o out.json
}

case_options_of_a_drape_that_is_not_made_are_told() {
  run 0 "$program" --no-drape --accuracy fine --garment skirt.json --to "$data"/b.body.json -o out.json
  says "--accuracy changes nothing: with --no-drape there is no drape"
}
