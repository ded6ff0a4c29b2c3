# shellcheck shell=bash disable=SC2034,SC2154
good=(4) # twenty steps do not bring it to rest
inputs=(panels.json panels.obj a.body.json a.body.obj)
command_line=(--body a.body.json --panels panels.json --accuracy draft --set max_steps=20 -o out.json)

case_ctrl_c_leaves_the_last_good_state() {
  local pid status=0 before
  "$program" --body a.body.json --panels panels.json --set settle_force_ratio=1e-6 --set settle_speed_m_s=1e-6 --set max_steps=1000000 -o out.json > stdout 2> stderr &
  pid=$!
  sleep 0.7
  before=$SECONDS
  kill -TERM "$pid" # a shell's background jobs ignore SIGINT; both signals take one way
  wait "$pid" || status=$?
  [[ $status -eq 4 ]] || fail "exit $status, expected 4"
  [[ $((SECONDS - before)) -le 5 ]] || fail "took $((SECONDS - before)) s to stop"
  grep -q '"converged": false' out.json || fail "the garment is not marked"
  [[ -s out.obj ]] || fail "no mesh"
  says "stopped by the user"
}

case_a_drape_with_no_body_nor_panels_is_a_usage_error() {
  run 2 "$program" -o out.json
  run 2 "$program" --panels panels.json --from panels.json -o out.json
  run 2 "$program" --panels panels.json --set no_such_knob=1 -o out.json
  run 2 "$program" --panels panels.json --set max_steps=nan -o out.json
  run 2 "$program" --panels panels.json --effects gravty -o out.json
}
