# shellcheck shell=bash disable=SC2034
good=(4) # twenty steps do not bring it to rest
inputs=(panels.json panels.obj a.body.json a.body.obj)
command_line=(--body a.body.json --panels panels.json --accuracy draft --set max_steps=20 -o out.json)
