# shellcheck shell=bash disable=SC2034
good=(0)
inputs=()
output=out.obj
command_line=(--preset f-165-a --cell 0.018 -o out.obj)

case_a_girth_that_is_not_in_metres_is_told_what_to_write() {
  run 2 "$program" --girth waist=75 -o out.obj
  says '"waist=75" would be 75 m: lengths are in metres; where 75 cm are meant, say --girth waist=0.75'
  run 2 "$program" --girth waist=75cm -o out.obj
  says "say --girth waist=0.75"
}
