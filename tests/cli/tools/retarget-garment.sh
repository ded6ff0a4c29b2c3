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
dress_from_shared() { # FROM TO PATTERN [DRAPE_OPTION...]
  local shared=${SLOPER_SHARED:-}/data folder=${program%/*} sewing=()
  [[ -d $shared ]] || { echo "SKIPPED: SLOPER_SHARED does not name a folder with data"; exit 77; }
  local pattern=$shared/patterns/$3
  [[ $pattern != *.dxf ]] || sewing=(--sewing "${pattern%.dxf}.seams.json")
  run 0 "$folder/scan-landmarks" -q -o from.json "$shared/bodies/$1.obj"
  run 0 "$folder/scan-landmarks" -q -o to.json "$shared/bodies/$2.obj"
  run 0 "$folder/pattern-mesh" -q --body from.json "${sewing[@]}" -o panels.json "$pattern"
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
  dress_from_shared plain/body_006 plain/body_004 sewing/dxf/shirt.dxf --accuracy draft --material denim
  run 4 "$program" --accuracy draft --garment worn.json --to to.json --report report.json -o there.json
  says "on the hand"
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
