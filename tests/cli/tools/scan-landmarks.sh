# shellcheck shell=bash disable=SC2034
good=(0)
inputs=(a.ply)
command_line=(-o out.json a.ply)

case_a_scan_is_never_written_over() {
  local scan=out.obj
  cp a.ply a.obj && cp a.obj "$scan" && cp a.obj before
  run 2 "$program" -o out.json "$scan"
  says "out.obj: --output: would be written over what SCAN reads (a mesh goes beside its document); name another output"
  run 2 "$program" -o "./$scan" "$scan"
  run 2 "$program" -o out "$scan"
  run 2 "$program" -o other.json --csv "$scan" "$scan"
  cmp "$scan" before || fail "the scan is another one"
  [[ ! -e out.json && ! -e other.json ]] || fail "something was written"
}

case_a_document_may_carry_the_name_of_its_scan() {
  cp a.ply b.obj.ply && cp a.ply before
  local pass
  for pass in first second; do
    run 0 "$program" -q -o b.obj.ply.json b.obj.ply
    [[ -s b.obj.ply.json && -s b.obj.ply.obj ]] || fail "the $pass run wrote no document and mesh"
  done
  cmp -s b.obj.ply before || fail "the scan is another one"
}

case_a_document_is_not_named_as_a_mesh() {
  run 2 "$program" -o out.obj a.ply
  says "out.obj is the name of a mesh; name the document: out.json"
  local name
  for name in zz.ply zz.PLY zz.glb zz.stl; do
    run 2 "$program" -o "$name" a.ply
    says "$name is the name of a mesh; name the document: zz.json"
    [[ ! -e $name ]] || fail "something is written as $name"
  done
  [[ ! -e out.obj && ! -e out.obj.obj ]] || fail "something was written"
}

case_rules_of_another_kind_are_told_as_such() {
  run 3 "$program" --rules "$data/a.body.json" -o out.json a.ply
  says 'is a "body" document; give rules as'
  [[ ! -e out.json ]] || fail "something was written"
}

case_a_document_is_no_scan_and_told_so() {
  run 3 "$program" -o out.json "$data/a.body.json"
  says "a.body.json: is a JSON document, not a scan; expected a scan in OBJ"
  [[ ! -e out.json ]] || fail "something was written"
}

case_inches_are_taken_by_their_name_and_by_themselves() {
  local unit
  awk '/^v /{printf "v %.6f %.6f %.6f\n", $2 / 0.0254, $3 / 0.0254, $4 / 0.0254; next} {print}' "$data/a.obj" > inches.obj
  for unit in auto inch; do
    run 0 "$program" --unit "$unit" -o out.json inches.obj
    grep -q '"unit": "inch"' out.json || fail "--unit $unit took another unit"
  done
  run 3 "$program" --unit inch -o out.json "$data/a.obj"
  says "m tall in inch"
}

case_an_obj_without_faces_may_have_been_cut_off_and_warnings_name_the_scan() {
  grep '^v ' "$data/a.obj" > points.obj
  run 0 "$program" -o out.json points.obj
  says "points.obj has points and no faces, and the skin is made up between them; if it should"
  sed 's/^v //' points.obj > points.xyz
  run 0 "$program" -o out.json points.xyz
  ! grep -q "no faces, and" stderr || fail "a cloud of points needs no faces"
}

case_a_unit_beside_a_stature_is_not_dropped_in_silence() {
  cp "$data/a.obj" .
  run 0 "$program" --unit cm --stature 1.66 -o out.json a.obj
  says "--unit cm is not used: --stature says the size"
  run 0 "$program" --stature 1.66 -o out.json a.obj
  ! grep -q "is not used" stderr || fail "nothing was given twice"
}
