# shellcheck shell=bash disable=SC2034,SC2154
good=(0)
inputs=()
command_line=(--weight 121 --overhang-warp 42 --overhang-weft 36 --overhang-bias 38 --name poplin -o out.json)

value() { # KEY FILE: the first number of that key
  grep -oE "\"$1\": [-0-9.e]+" "$2" | head -n 1 | sed 's/.*: //'
}

case_overhangs_are_peirce_s_formula() {
  run 0 "$program" "${command_line[@]}"
  # W g (L / 2)^3
  awk -v b="$(value bend_warp_n_m out.json)" 'BEGIN { e = 0.121 * 9.80665 * 0.021^3; exit !(b > 0.9999 * e && b < 1.0001 * e) }' || fail "another rigidity along warp"
  awk -v b="$(value bend_bias_n_m out.json)" 'BEGIN { e = 0.121 * 9.80665 * 0.019^3; exit !(b > e && b < 1.1 * e) }' || fail "another rigidity along the bias"
  run 0 "$program" --weight 121 --overhang-warp 42 -o one.json
  says "cannot tell warp against weft"
}

case_what_no_cloth_has_is_refused() {
  run 2 "$program" --weight 121 -o out.json --overhang-warp much
  run 3 "$program" --weight 121 -o out.json
  says "nothing was measured that bending follows from"
  run 3 "$program" --weight 121 -o out.json --overhang-bias 40
  run 3 "$program" --weight 121 -o out.json --overhang-warp 2
  run 3 "$program" --weight 121 -o out.json --overhang-warp 420
  says "overhang of 420.0 mm: is longer than the strip of 200 mm; give what hangs over the edge, in mm, from 5 to 200"
  run 3 "$program" --weight 121 -o out.json --drape-percent 120
  run 3 "$program" --weight 121 -o out.json --drape-percent 66 --drape-percent 0.66
  says "--drape-percent 0.66: is less than any cloth drapes to; give it in per cent: 66?"
  run 3 "$program" --weight 121 -o out.json --drape-percent 3
  run 3 "$program" --weight 121 -o out.json --drape-percent 60 --folds -3
  says "folds: are those of no drape"
  run 2 "$program" --weight 121 -o out.json --drape-percent 60 --disc 290
  run 2 "$program" --weight 0 -o out.json --overhang-warp 40
  run 3 "$program" --weight 121 -o out.json --preset tweet --overhang-warp 40
  [[ ! -e out.json ]] || fail "an output was written"
}

case_pictures_that_tell_nothing_are_refused() {
  python3 - << 'PY'
import struct
import zlib


def png(name, size, pixel):
    rows = b"".join(b"\0" + bytes(pixel(x, y) for x in range(size)) for y in range(size))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(name, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 0, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def radius(x, y):
    return ((x - 100) ** 2 + (y - 100) ** 2) ** 0.5


png("grey.png", 200, lambda x, y: 128)
png("no-disc.png", 200, lambda x, y: 40 if radius(x, y) < 75 else 255)
png("cut.png", 200, lambda x, y: 40 if radius(x, y) < 120 else 255)
PY
  run 3 "$program" --weight 121 -o out.json grey.png
  says "grey.png: is all of one grey"
  run 3 "$program" --weight 121 -o out.json no-disc.png
  says "there is no disc to be seen on the cloth; give --mm-per-pixel"
  run 3 "$program" --weight 121 -o out.json cut.png
  says "the cloth reaches the picture's border"
  run 3 "$program" --weight 121 -o out.json --mm-per-pixel 5 no-disc.png
  says "check the diameters and the scale"
}

case_a_drape_that_stands_out_straight_cannot_tell() {
  run 4 "$program" --weight 121 --drape-percent 99.5 --disc 60 -o out.json
  says "cannot tell bending from the drape"
  grep -q cannot_tell out.json || fail "the document does not say so"
}

case_drape_takes_what_it_writes() {
  cp "$data"/panels.json "$data"/panels.obj "$data"/a.body.json "$data"/a.body.obj .
  run 0 "$program" "${command_line[@]}"
  run 4 "$(dirname "$program")/drape" --body a.body.json --panels panels.json --material out.json --accuracy draft --set max_steps=3 --report report.json -o skirt.json
  grep -q '"name": "poplin"' skirt.json || fail "the garment is of another material"
  grep -A2 orthotropic_bending report.json | grep -q '"active": true' || fail "it does not bend by direction"
}
