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

case_a_name_of_another_format_is_refused() {
  run 2 "$program" --preset f-165-a --cell 0.018 -o a.b/zz.ply
  says "--output: a.b/zz.ply does not end in .obj, and nothing else is written; name a.b/zz.obj"
  run 2 "$program" --preset f-165-a --cell 0.018 -o out.obj --truth truth.yaml
  says "name truth.json"
  [[ ! -e out.obj ]] || fail "a figure is written"
  run 0 "$program" --preset f-165-a --cell 0.018 -o OUT.OBJ
  run 0 "$program" --preset f-165-a --cell 0.018 -o /dev/null
}

# A truth document has no mesh beside it: it was taken for one that would be written twice.
case_figure_and_truth_may_have_one_name() {
  run 0 "$program" --preset f-165-a --cell 0.018 -o anna.obj --truth anna.json
  [[ -s anna.obj && -s anna.json ]] || fail "one of them is not written"
  run 2 "$program" --preset f-165-a --cell 0.018 -o anna.obj --parts anna.obj
  says "would be written by --parts too"
}

case_a_girth_that_does_not_come_out_is_told_and_the_figure_is_written() {
  run 4 "$program" --preset f-165-a --cell 0.018 --girth waist=1.6 -o out.obj --truth truth.json
  says "--girth waist=1.6: the figure came out with 1.4"
  [[ -s out.obj && -s truth.json ]] || fail "the figure is not written"
  run 0 "$program" --preset f-165-a --cell 0.018 --girth waist=0.82 --girth hip=1.02 -o out.obj
  [[ ! -s stderr ]] || fail "girths that came out are warned of"
}

case_a_cell_that_closes_no_surface_is_made_finer() {
  # Toes of this figure closed on none of twelve grids of that spacing.
  run 0 "$program" --preset f-165-a --cell 0.02 -o out.obj
  [[ $(grep -c '^f ' out.obj) -gt 5000 ]] || fail "$(grep -c '^f ' out.obj) faces"
}
