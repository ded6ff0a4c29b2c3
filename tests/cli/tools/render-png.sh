# shellcheck shell=bash disable=SC2034
good=(0)
output=out.png
inputs=(skirt.json skirt.obj a.body.json a.body.obj)
command_line=(--size 200x200 -o out.png a.body.json skirt.json)

# asks STATUS FACT NEXT_STEP OPTION...: refused with both, and no picture is left
asks() {
  local status=$1 fact=$2 next=$3
  shift 3
  run "$status" "$program" --size 200x200 "$@"
  says "$fact"
  says "$next"
  [[ ! -e out.png ]] || fail "a picture was written"
}

case_what_cannot_be_drawn_is_told_with_a_next_step() {
  asks 3 "none.json: no such file" "check the path" -o out.png none.json
  sed -E '/^vt /d; s|([0-9]+)/[0-9]+|\1|g' skirt.obj > bare.obj
  sed 's/skirt\.obj/bare.obj/' skirt.json > bare.json
  asks 3 "bare.obj: the faces have no pattern coordinates" "give the OBJ that was written" --map strain -o out.png bare.json
  asks 2 "needs a garment with pattern coordinates" "give shirt.json" --map strain -o out.png a.body.json
  asks 2 "needs the body too" "give body.json" --map gap -o out.png skirt.json
  asks 5 "there is no folder no/such" "make it first" -o no/such/out.png skirt.json
  asks 2 "is no kind of file" "end it in .png" -o out.gif skirt.json
  asks 3 "is not a readable PNG" "give a picture" --sheet -o out.png skirt.json
  run 2 "$program" --size 20000x20000 -o out.png skirt.json
  says "is not a size from 16x16 to 8192x8192"
  says "write for example"
  [[ ! -e out.png ]] || fail "a picture was written"
}

case_options_that_would_do_nothing_are_refused() {
  local option
  printf 'no document' > text.txt
  asks 3 "text.txt: is neither a document nor a mesh" "give body.json" -o out.png text.txt
  run 0 "$program" -q --size 64x64 -o small.png a.body.json
  asks 3 "small.png: is a picture already" "--sheet puts" -o out.png small.png
  asks 3 'is a "garment" document, not a camera' "write for example" --camera skirt.json -o out.png skirt.json
  run 2 "$program" --size 8192x8192 --view turntable:100 -o out.png skirt.json
  says "million pixels"
  says "--as files"
  for option in "--mask small.png" "--tolerance 0.9" "--seconds 1" "--labels a,b" "--columns 2"; do
    # shellcheck disable=SC2086
    run 2 "$program" --size 64x64 $option -o out.png skirt.json
    says "${option%% *}: "
    [[ ! -e out.png ]] || fail "a picture was written"
  done
}

case_ctrl_c_ends_a_turntable() {
  local pid status=0 before
  "$program" --size 600x800 --view turntable:360 --as animation -o out.png a.body.json skirt.json > stdout 2> stderr &
  pid=$!
  sleep 1
  before=$SECONDS
  kill -TERM "$pid"
  wait "$pid" || status=$?
  [[ $status -eq 4 && $((SECONDS - before)) -le 10 ]] || fail "exit $status after $((SECONDS - before)) s"
  says "stopped by the user"
  [[ ! -e out.png ]] || fail "half an animation was written"
}

case_a_glb_of_a_body_can_be_posed() {
  run 0 "$program" -o out.glb a.body.json skirt.json
  python3 - << 'PYTHON' || fail "the GLB's skin"
import json, struct
data = open("out.glb", "rb").read()
length = struct.unpack_from("<I", data, 12)[0]
gltf, binary = json.loads(data[20:20 + length]), data[28 + length:]

def values(index):
    a = gltf["accessors"][index]
    n = a["count"] * {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}[a["type"]]
    return struct.unpack_from("<%d%s" % (n, {5126: "f", 5123: "H"}[a["componentType"]]), binary, gltf["bufferViews"][a["bufferView"]]["byteOffset"])

skin, = gltf["skins"]
nodes, names = gltf["nodes"], [gltf["nodes"][j]["name"] for j in skin["joints"]]
assert names[0] == "root" and "forearm_l" in names
place = {}

def visit(node, at):
    place[node] = [p + q for p, q in zip(at, nodes[node].get("translation", (0, 0, 0)))]
    for child in nodes[node].get("children", ()):
        visit(child, place[node])

for root in gltf["scenes"][0]["nodes"]:
    visit(root, (0, 0, 0))
assert len(place) == len(nodes)
bones = {bone["name"]: bone["head"] for bone in json.load(open("a.body.json"))["bones"]}
inverse = values(skin["inverseBindMatrices"])
for k, joint in enumerate(skin["joints"]):
    if names[k] != "root":
        assert max(abs(p - q) for p, q in zip(place[joint], bones[names[k]])) < 1e-6, names[k]
    assert max(abs(p + q) for p, q in zip(place[joint], inverse[16 * k + 12:16 * k + 15])) < 1e-6, names[k]
body, = [n for n in nodes if n.get("skin") == 0]
attributes = gltf["meshes"][body["mesh"]]["primitives"][0]["attributes"]
position, joints, weights = (values(attributes[key]) for key in ("POSITION", "JOINTS_0", "WEIGHTS_0"))
assert all(abs(sum(weights[k:k + 4]) - 1) < 1e-5 for k in range(0, len(weights), 4)) and max(joints) < len(names)
tip = max(range(len(position) // 3), key=lambda v: position[3 * v]) # on the left hand
assert names[joints[4 * tip]] in ("hand_l", "forearm_l"), names[joints[4 * tip]]
PYTHON
}
