# shellcheck shell=bash disable=SC2034
good=(4) # ten steps do not bring it to rest
inputs=(skirt.json skirt.obj b.body.json b.body.obj)
command_line=(--garment skirt.json --to b.body.json --accuracy draft --set max_steps=10 -o out.json)

case_a_cache_changes_no_byte() { a_cache_changes_no_byte; }
