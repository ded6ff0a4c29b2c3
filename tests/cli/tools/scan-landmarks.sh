# shellcheck shell=bash disable=SC2034
good=(0)
inputs=(a.ply)
command_line=(-o out.json a.ply)
