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

case_a_mistyped_word_of_a_list_is_told_with_the_nearest() {
  asks 2 "--view frnt: is not known (did you mean 'front'?)" "known are front, back" --view left,frnt -o out.png skirt.json
  asks 2 "--show landmark: is not known (did you mean 'landmarks'?)" "known are landmarks, bones" --show landmark -o out.png a.body.json
  asks 2 "--fabric twil: is not known (did you mean 'twill'?)" "known are auto, panels" --fabric twil -o out.png skirt.json
}

case_a_garment_beside_another_body_is_told() {
  run 0 "$program" --size 64x64 -o out.png a.body.json skirt.json
  ! grep -q "another body" stderr || fail "tells of its own body"
  run 0 "$program" --size 64x64 -o out.png "$data/b.body.json" skirt.json
  says "skirt.json hung on another body than b.body.json"
}

case_a_garment_that_is_not_at_rest_is_told() {
  sed 's/"converged": true/"converged": false/' skirt.json > placed.json
  cp skirt.obj placed.obj
  run 0 "$program" --size 64x64 -o out.png a.body.json placed.json
  says "placed.json is not at rest: it was placed without a drape, or its drape did not end"
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
  for option in "--mask small.png" "--tolerance 0.9" "--different 0.5" "--seconds 1" "--labels a,b" "--columns 2"; do
    # shellcheck disable=SC2086
    run 2 "$program" --size 64x64 $option -o out.png skirt.json
    says "${option%% *}: "
    [[ ! -e out.png ]] || fail "a picture was written"
  done
}

case_compare_sees_another_colour_of_the_same_brightness() {
  run 0 "$program" -q --size 200x250 --color 4f7396 -o blue.png a.body.json skirt.json
  run 0 "$program" -q --size 200x250 --color 96694f -o brown.png a.body.json skirt.json
  run 0 "$program" --compare blue.png blue.png
  run 1 "$program" --compare -o difference.png blue.png brown.png
  [[ -s difference.png ]] || fail "no picture of the difference"
  run 0 "$program" --compare --different 1 blue.png brown.png # similarity alone
}

case_ctrl_c_ends_a_turntable() {
  local pid status=0 before
  "$program" --size 600x800 --view turntable:360 --as animation -o out.png a.body.json skirt.json > stdout 2> stderr &
  pid=$!
  sleep 1
  before=$SECONDS
  kill -TERM "$pid"
  wait "$pid" || status=$?
  [[ $status -eq 143 && $((SECONDS - before)) -le 10 ]] || fail "exit $status after $((SECONDS - before)) s"
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
body, garment = [n for n in nodes if n.get("skin") == 0] # which it wears
attributes = gltf["meshes"][body["mesh"]]["primitives"][0]["attributes"]
position, joints, weights = (values(attributes[key]) for key in ("POSITION", "JOINTS_0", "WEIGHTS_0"))
assert all(abs(sum(weights[k:k + 4]) - 1) < 1e-5 for k in range(0, len(weights), 4)) and max(joints) < len(names)
tip = max(range(len(position) // 3), key=lambda v: position[3 * v]) # on the left hand
assert names[joints[4 * tip]] in ("hand_l", "forearm_l"), names[joints[4 * tip]]
cloth = gltf["meshes"][garment["mesh"]]["primitives"][0]["attributes"]
position, joints, weights = (values(cloth[key]) for key in ("POSITION", "JOINTS_0", "WEIGHTS_0"))
assert all(abs(sum(weights[k:k + 4]) - 1) < 1e-5 for k in range(0, len(weights), 4))

def with_leg(v, side): # of a vertex of the skirt
    return sum(w for j, w in zip(joints[4 * v:4 * v + 4], weights[4 * v:4 * v + 4]) if names[j] in ("thigh_" + side, "shin_" + side))

vertices = range(len(position) // 3)
left, right = max(vertices, key=lambda v: position[3 * v] - position[3 * v + 1]), min(vertices, key=lambda v: position[3 * v] + position[3 * v + 1])
low = min(position[1::3])
middle = min((v for v in vertices if position[3 * v + 1] < low + 0.05 and position[3 * v + 2] > 0), key=lambda v: abs(position[3 * v]))
assert with_leg(left, "l") > 0.9 and with_leg(right, "r") > 0.9, "its sides go with the legs"
assert 0.2 < with_leg(middle, "l") < 0.8 and 0.2 < with_leg(middle, "r") < 0.8, "its front goes half with each"
PYTHON
}

# The rules of glTF 2.0 that its validator knows, for what we write.
case_a_glb_keeps_the_rules_of_its_format() {
  run 0 "$program" -q --size 64x64 -o print.png a.body.json
  run 0 "$program" -o plain.glb --map strain a.body.json skirt.json
  run 0 "$program" -o printed.glb --fabric print.png a.body.json skirt.json
  python3 - << 'PYTHON' || fail "the GLB's rules"
import json, struct
SIZE, WIDTH = {5123: 2, 5125: 4, 5126: 4}, {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
for name in ("plain.glb", "printed.glb"):
    data = open(name, "rb").read()
    magic, version, total, length, kind = struct.unpack_from("<4sIII4s", data)
    assert (magic, version, total, kind, length % 4) == (b"glTF", 2, len(data), b"JSON", 0)
    gltf = json.loads(data[20:20 + length])
    size, kind = struct.unpack_from("<I4s", data, 20 + length)
    binary = data[28 + length:]
    assert kind == b"BIN\0" and size == len(binary) == gltf["buffers"][0]["byteLength"] and size % 4 == 0
    end = 0
    for view in gltf["bufferViews"]: # one after the other, aligned
        assert view["byteOffset"] % 4 == 0 and end <= view["byteOffset"] < end + 4, name
        end = view["byteOffset"] + view["byteLength"]
    assert end <= size
    def values(index):
        a = gltf["accessors"][index]
        view, n = gltf["bufferViews"][a["bufferView"]], a["count"] * WIDTH[a["type"]]
        assert n * SIZE[a["componentType"]] == view["byteLength"]
        return struct.unpack_from("<%d%s" % (n, {5123: "H", 5125: "I", 5126: "f"}[a["componentType"]]), binary, view["byteOffset"])
    used = set()
    for mesh in gltf["meshes"]:
        part, = mesh["primitives"]
        attributes = part["attributes"]
        used.add(part["material"])
        count = {gltf["accessors"][k]["count"] for k in attributes.values()}
        assert len(count) == 1 and max(values(part["indices"])) < min(count)
        position, accessor = values(attributes["POSITION"]), gltf["accessors"][attributes["POSITION"]]
        for k in range(3):
            assert accessor["min"][k] == min(position[k::3]) and accessor["max"][k] == max(position[k::3])
        normal, color, weight = (values(attributes[key]) for key in ("NORMAL", "COLOR_0", "WEIGHTS_0"))
        assert all(abs(sum(x * x for x in normal[k:k + 3]) - 1) < 1e-3 for k in range(0, len(normal), 3)) and 0 <= min(color) and max(color) <= 1
        joint = values(attributes["JOINTS_0"])
        assert max(joint) < len(gltf["skins"][0]["joints"]) and all(w > 0 or j == 0 for j, w in zip(joint, weight)) and min(weight) >= 0
        for k in range(0, len(weight), 4): # no joint twice
            own = [j for j, w in zip(joint[k:k + 4], weight[k:k + 4]) if w > 0]
            assert len(own) == len(set(own))
    for child in (c for node in gltf["nodes"] for c in node.get("children", ())):
        assert child not in gltf["scenes"][0]["nodes"]
    if name == "printed.glb":
        texture = gltf["materials"][2]["pbrMetallicRoughness"]["baseColorTexture"]["index"]
        image = gltf["images"][gltf["textures"][texture]["source"]]
        at = gltf["bufferViews"][image["bufferView"]]["byteOffset"]
        assert used == {0, 2} and image["mimeType"] == "image/png" and binary[at:at + 8] == b"\x89PNG\r\n\x1a\n"
        assert set(color) == {1.0}, "the texture's colours are the cloth's"
    else:
        assert used == {0, 1} and len(set(color)) > 3, "the map's colours"
PYTHON
}

case_where_nothing_can_draw_is_told() {
  "$program" --help | grep -q 'context.*egl' || { echo "SKIPPED: built without EGL"; return 0; }
  export __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent
  asks 4 "--context egl: EGL gives no surfaceless display" "" --context egl -o out.png a.body.json
  says "; " # and what to do instead
}

# Questions of pattern-mesh name edges: the picture of the pieces shows which they are.
case_edges_that_are_asked_about_are_named_on_the_pieces() {
  python3 - "$data/skirt.pattern.json" > drawn.json << 'EOF'
import json, sys
document = json.load(open(sys.argv[1]))
document["seams"] = []
for panel in document["panels"]:
    for number, edge in enumerate(panel.get("outline", [])):
        edge["edge"] = f"edge{number}"
print(json.dumps(document))
EOF
  local mesher=${program%/*}/pattern-mesh
  run 0 "$mesher" -q --write-pattern drawn.dxf drawn.json
  run 1 "$mesher" --edge-length 0.05 -o panels.json drawn.dxf
  cp stdout questions.json
  run 0 "$program" --size 600x500 --view pattern -o plain.png drawn.dxf
  run 0 "$program" --size 600x500 --view pattern --show edges -o named.png drawn.dxf
  run 0 "$program" --size 600x500 --view pattern --show edges -o asked.png drawn.dxf questions.json
  run 1 "$program" --compare --different 0.001 plain.png named.png
  run 1 "$program" --compare --different 0.001 named.png asked.png
  asks 2 "is a second sidecar of seams" "one pattern with its sidecar" --view pattern -o out.png drawn.dxf questions.json \
    "$PWD/questions.json"
  asks 2 "--show edges: edges are named on the flat pattern" "give --view pattern" --show edges -o out.png drawn.dxf
}

case_options_that_change_nothing_are_told() {
  run 0 "$program" --size 64x64 --view front,back -o plain.png a.body.json skirt.json
  ! grep -q "changes nothing" stderr || fail "tells of options that count"
  run 0 "$program" --size 64x64 --map parts --fabric twill -o plain.png a.body.json skirt.json
  ! grep -q "changes nothing" stderr || fail "tells of options that count"
  run 0 "$program" --size 64x64 --range 5 --print-size 0.2 -o out.png a.body.json skirt.json
  says "--range changes nothing: it is the scale of a map; give --map too"
  says "--print-size changes nothing: no picture is printed on the cloth"
  run 0 "$program" --size 64x64 --map strain --fabric twill --color ff0000 -o out.png a.body.json skirt.json
  says "--fabric changes nothing: the map colours the cloth"
  says "--color changes nothing: the map colours the cloth"
  run 0 "$program" --view front,back --as animation -o out.glb a.body.json skirt.json
  says "--as changes nothing: it is for pictures, and out.glb is a model"
  run 0 "$program" --sheet --view back -o out.png plain.png plain.png
  says "--view changes nothing: the pictures are drawn already"
}

case_garments_that_pass_through_each_other_are_told() {
  sed -E 's/"name": "skirt"/"name": "other"/' skirt.json > moved.json
  sed -i 's/skirt\.obj/moved.obj/' moved.json
  awk '/^v / { $2 += 0.01 } { print }' skirt.obj > moved.obj
  run 0 "$program" --size 64x64 -o out.png a.body.json skirt.json moved.json
  says "skirt.json and moved.json pass through each other, at "
  says "drape puts one over the other (--over)"
  run 0 "$program" --size 64x64 -o out.png a.body.json skirt.json skirt.json
  ! grep -q "pass through" stderr || fail "tells of two drapes of one pattern"
}
