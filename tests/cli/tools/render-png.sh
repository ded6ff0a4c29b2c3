# shellcheck shell=bash disable=SC2034
good=(0)
output=out.png
inputs=(skirt.json skirt.obj a.body.json a.body.obj)
command_line=(--size 200x200 -o out.png a.body.json skirt.json)
