# shellcheck shell=bash disable=SC2034
good=(0)
inputs=(a.body.json)
command_line=(skirt --body a.body.json -o out.json)

case_a_measure_that_is_not_in_metres_is_told_what_to_write() {
  run 2 "$program" skirt --measure waist=75 -o out.json
  says '"waist=75" would be 75 m: lengths are in metres; where 75 cm are meant, say --measure waist=0.75'
  run 2 "$program" skirt --measure waist=750 -o out.json
  says "where 750 mm are meant, say --measure waist=0.75"
  run 2 "$program" skirt --measure waist=75cm -o out.json
  says '"waist=75cm" names a unit: lengths are in metres, without one; say --measure waist=0.75'
  run 2 "$program" skirt --measure waist=7.5 -o out.json
  says "for example --measure waist=0.75"
  for text in waist waist= =0.75 waist=nan waist=0x1 waist=0.75ft; do
    run 2 "$program" skirt --measure "$text" -o out.json
    says "\"$text\" is not NAME=METRES; for example --measure waist=0.75"
  done
  run 2 "$program" skirt --measure wais=0.75 -o out.json
  says 'did you mean "waist"?'
  local pair
  for pair in chest=bust seat=hip inseam=inside-leg height=stature; do
    run 2 "$program" skirt --measure "${pair%=*}=0.75" -o out.json
    says "there is no measure \"${pair%=*}\" (did you mean \"${pair#*=}\"?)"
  done
  run 0 "$program" skirt --body a.body.json --measure waist=0.75 -o out.json
}

case_a_name_of_another_format_is_refused() {
  run 2 "$program" skirt --body a.body.json -o skirt.dxf
  says "--output: skirt.dxf does not end in .json, and nothing else is written; name skirt.json"
  [[ ! -e skirt.dxf ]] || fail "a pattern is written"
}

case_measures_that_are_not_given_follow_from_stature() {
  local garment
  for garment in shirt tshirt skirt trousers; do
    run 0 "$program" "$garment" --measure stature=1.4 -o short.json
    run 0 "$program" "$garment" --measure stature=1.9 -o tall.json
    ! cmp -s short.json tall.json || fail "a $garment is the same for a child and for the tall"
  done
  says "back-length 44.9"
  run 0 "$program" tshirt -o standard.json
  run 0 "$program" tshirt --measure stature=1.65 -o out.json
  cmp standard.json out.json || fail "the standard figure is not 1.65 m tall"
  run 0 "$program" tshirt --measure stature=1.9 --measure back-length=0.39 --measure bust=0.92 -o first.json
  run 0 "$program" tshirt --measure back-length=0.39 --measure bust=0.92 --measure stature=1.9 -o last.json
  cmp first.json last.json || fail "the order of the measures matters"
  says "waist-to-hip 23.0"
  ! grep -qE "back-length|bust " stderr || fail "a measure that is given follows from stature"
}

case_the_flare_of_a_skirt_is_at_its_hem() {
  run 0 "$program" skirt --body a.body.json -o straight.json
  run 0 "$program" skirt --body a.body.json --flare 0 -o out.json
  cmp straight.json out.json || fail "no flare is one"
  run 0 "$program" skirt --body a.body.json --flare 0.1 -o out.json
  ! cmp -s straight.json out.json || fail "a flare is none"
  run 2 "$program" shirt --body a.body.json --flare 0.1 -o out.json
  says "is of skirts"
  run 2 "$program" skirt --body a.body.json --flare 0.5 -o out.json
  run 2 "$program" skirt --measure stature=1 --flare 0.25 -o out.json
  says "too much"
}

case_a_collar_is_turned_over_where_there_is_one() {
  run 0 "$program" shirt --body a.body.json -o upright.json
  run 0 "$program" shirt --body a.body.json --turned-collar -o out.json
  ! cmp -s upright.json out.json || fail "the collar stands"
  run 2 "$program" skirt --body a.body.json --turned-collar -o out.json
  says "there is no collar to turn"
  run 2 "$program" shirt --body a.body.json --turned-collar --band-collar -o out.json
}

case_a_shirt_whose_collar_stands_is_warned_of() {
  run 0 "$program" shirt --body a.body.json -o out.json
  says "the collar has no roll line and stands up to the chin: say --turned-collar"
  local collar
  for collar in --turned-collar --band-collar; do
    run 0 "$program" shirt "$collar" --body a.body.json -o out.json
    [[ ! -s stderr ]] || fail "$collar: $(cat stderr)"
  done
}
