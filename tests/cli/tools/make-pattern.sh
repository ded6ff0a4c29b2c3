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
  run 0 "$program" skirt --body a.body.json --measure waist=0.75 -o out.json
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
