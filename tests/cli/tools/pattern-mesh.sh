# shellcheck shell=bash disable=SC2034
good=(0)
inputs=(skirt.pattern.json a.body.json a.body.obj)
command_line=(--edge-length 0.05 --body a.body.json -o out.json skirt.pattern.json)
