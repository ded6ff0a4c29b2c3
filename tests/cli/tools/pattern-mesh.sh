# shellcheck shell=bash disable=SC2034
good=(0)
inputs=(skirt.pattern.json a.body.json a.body.obj)
command_line=(--edge-length 0.05 --body a.body.json -o out.json skirt.pattern.json)

case_what_is_no_pattern_is_told_with_a_next_step() {
  run 0 "$program" -q --edge-length 0.05 -o panels.json skirt.pattern.json
  run 3 "$program" -o out.json panels.json
  says 'is a "panels" document, which is meshed already; give the pattern that it was made from'
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
