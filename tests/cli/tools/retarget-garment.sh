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
  says "does not fit: the garment slides down"
  printf '{"format": "fit-policy", "version": 1, "default": {"too_small_ease": 0.9}}' > policy.json
  run 1 "$program" "${of[@]}" --fit-page fit.html --policy policy.json
  says "; out.json has it as it was placed, not draped"
  grep -q '"state": "placed"' fit.json || fail "the fit report does not say that it was not draped"
  grep -q "as it was placed" fit.html || fail "the page does not say that it was not draped"
}
