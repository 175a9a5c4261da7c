#!/usr/bin/env python3
"""Exported glTF files against the rules of the format's specification (Khronos, glTF 2.0, version 2.0.1), written here from
its text alone, and read by Assimp where it is installed.

Usage: check_gltf.py COMMAND   Needs nothing but Python; Assimp's part is left out without the Debian package assimp-utils,
that of Khronos' own validator without npm's gltf-validator.
"""
import base64
import json
import math
import re
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import exported as e

COMPONENTS = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}  # 3.6.2.2
SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
# The properties that the specification's objects may have (its section 5), of those that are written here.
PROPERTIES = {
    "root": "extensionsUsed extensionsRequired accessors animations asset buffers bufferViews cameras images materials "
            "meshes nodes samplers scene scenes skins textures extensions extras",
    "asset": "copyright generator version minVersion extensions extras",
    "accessors": "bufferView byteOffset componentType normalized count type max min sparse name extensions extras",
    "buffers": "uri byteLength name extensions extras",
    "bufferViews": "buffer byteOffset byteLength byteStride target name extensions extras",
    "materials": "name extensions extras pbrMetallicRoughness normalTexture occlusionTexture emissiveTexture "
                 "emissiveFactor alphaMode alphaCutoff doubleSided",
    "meshes": "primitives weights name extensions extras",
    "primitives": "attributes indices material mode targets extensions extras",
    "nodes": "camera children skin matrix mesh rotation scale translation weights name extensions extras",
    "scenes": "nodes name extensions extras",
    "pbrMetallicRoughness": "baseColorFactor baseColorTexture metallicFactor roughnessFactor "
                            "metallicRoughnessTexture extensions extras",
}


class Faults(list):
    def unless(self, condition, text):
        if not condition:
            self.append(text)


def glb_parts(data, faults):
    """Section 4.4: header, a JSON chunk, a BIN chunk, all of whole words, padded with blanks and zeros."""
    magic, version, length = struct.unpack_from("<4sII", data)
    faults.unless((magic, version, length) == (b"glTF", 2, len(data)), "header: magic, version or length")
    chunks, at = [], 12
    while at < len(data):
        size, kind = struct.unpack_from("<I4s", data, at)
        faults.unless(size % 4 == 0 and at % 4 == 0, f"chunk {kind}: not of whole words")
        chunks.append((kind, data[at + 8:at + 8 + size]))
        at += 8 + size
    faults.unless(at == len(data), "bytes after the last chunk")
    faults.unless([kind for kind, _ in chunks] == [b"JSON", b"BIN\0"], "chunks are not JSON and BIN")
    document = json.loads(chunks[0][1])
    padding = len(chunks[1][1]) - document["buffers"][0]["byteLength"]
    faults.unless(0 <= padding <= 3, "the buffer's length is not that of its chunk")
    faults.unless("uri" not in document["buffers"][0], "the buffer of a GLB has no uri")
    return document, [chunks[1][1]]


def read_parts(path, faults):
    if path.suffix == ".glb":
        return glb_parts(path.read_bytes(), faults)
    document, start = json.loads(path.read_text()), "data:application/octet-stream;base64,"  # 3.6.1.2
    uris = [buffer["uri"] for buffer in document["buffers"]]
    faults.unless(all(uri.startswith(start) for uri in uris), "buffers: not in the file itself")
    return document, [base64.b64decode(uri.removeprefix(start), validate=True) for uri in uris]


def known_properties(document, faults):
    def look(kind, thing):
        for key in thing.keys() - set(PROPERTIES[kind].split()):
            faults.append(f"{kind}: there is no property {key}")

    look("root", document)
    look("asset", document["asset"])
    for kind in ("accessors", "buffers", "bufferViews", "materials", "meshes", "nodes", "scenes"):
        faults.unless(document.get(kind, [0]), f"{kind} is empty")  # an array has at least one element
        for thing in document.get(kind, []):
            look(kind, thing)
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            look("primitives", primitive)
    for material in document["materials"]:
        look("pbrMetallicRoughness", material.get("pbrMetallicRoughness", {}))


def values(document, buffers, number, faults):
    """The elements of an accessor, after the rules of section 3.6.2.4 (alignment, room) and 3.6.2.5 (bounds)."""
    accessor = document["accessors"][number]
    view = document["bufferViews"][accessor["bufferView"]]
    letter, count = COMPONENTS[accessor["componentType"]], SIZES[accessor["type"]]
    element = struct.calcsize("<" + letter) * count
    stride, start = view.get("byteStride", element), accessor.get("byteOffset", 0)
    where = f"accessor {number}"
    component = struct.calcsize("<" + letter)
    faults.unless(start % component == 0 and (view.get("byteOffset", 0) + start) % component == 0, where + ": alignment")
    faults.unless(stride % 4 == 0 or "byteStride" not in view, where + ": stride is no multiple of 4")
    faults.unless("byteStride" not in view or 4 <= stride <= 252, where + ": stride out of range")
    faults.unless(start + stride * (accessor["count"] - 1) + element <= view["byteLength"], where + ": leaves its view")
    faults.unless(view.get("byteOffset", 0) + view["byteLength"] <= len(buffers[view["buffer"]]), where + ": view too long")
    data, at = buffers[view["buffer"]], view.get("byteOffset", 0) + start
    found = [struct.unpack_from(f"<{count}{letter}", data, at + k * stride) for k in range(accessor["count"])]
    for key, choose in (("min", min), ("max", max)):
        if key in accessor:
            exact = [choose(column) for column in zip(*found)]
            faults.unless(all(struct.pack("<" + letter, told) == struct.pack("<" + letter, is_)
                              for told, is_ in zip(accessor[key], exact)), f"{where}: {key} is {exact}")
    return found


def check_primitive(document, buffers, primitive, faults):
    attributes = {name: values(document, buffers, number, faults) for name, number in primitive["attributes"].items()}
    accessors = document["accessors"]
    for name, number in primitive["attributes"].items():  # 3.7.2.1
        wanted = {"POSITION": "VEC3", "NORMAL": "VEC3", "TEXCOORD_0": "VEC2"}.get(name)
        faults.unless(wanted is None or (accessors[number]["type"], accessors[number]["componentType"]) == (wanted, 5126),
                      f"{name}: type")
        faults.unless(wanted is not None or name.startswith("_"), f"{name}: a name of one's own begins with _")
        view = document["bufferViews"][accessors[number]["bufferView"]]
        faults.unless(view.get("target") == 34962, f"{name}: its view is no ARRAY_BUFFER")
    faults.unless({"min", "max"} <= accessors[primitive["attributes"]["POSITION"]].keys(), "POSITION has no bounds")
    counts = {len(column) for column in attributes.values()}
    faults.unless(len(counts) == 1, "attributes differ in length")
    faults.unless(all(abs(math.hypot(*n) - 1) < 1e-4 for n in attributes["NORMAL"]), "normals are not of unit length")
    faults.unless(all(math.isfinite(x) for p in attributes["POSITION"] for x in p), "positions are not finite")
    number = primitive["indices"]
    indices = [index for index, in values(document, buffers, number, faults)]
    faults.unless(accessors[number]["type"] == "SCALAR" and accessors[number]["componentType"] in (5121, 5123, 5125)
                  and "byteStride" not in document["bufferViews"][accessors[number]["bufferView"]], "indices: type")
    faults.unless(primitive.get("mode", 4) == 4 and len(indices) % 3 == 0, "indices: not triangles")
    faults.unless(max(indices) < min(counts), "indices: out of range")
    faults.unless(max(indices) < {5121: 255, 5123: 65535, 5125: 2 ** 32 - 1}[accessors[number]["componentType"]],
                  "indices: the restart value")
    faults.unless(set(indices) == set(range(min(counts))), "vertices that no triangle uses")
    if max(indices) >= min(counts):
        return attributes, []
    triangles = list(zip(indices[::3], indices[1::3], indices[2::3]))
    faults.unless(all(len({attributes["POSITION"][k] for k in t}) == 3 for t in triangles), "degenerate triangles")
    return attributes, triangles


def faults_of(path):
    """What the specification forbids in a file; and its vertices and triangles, nodes counted."""
    faults = Faults()
    document, buffers = read_parts(path, faults)
    faults.unless(document["asset"]["version"] == "2.0", "asset: version")
    known_properties(document, faults)
    for buffer, data in zip(document["buffers"], buffers):
        faults.unless(len(data) >= buffer["byteLength"], "a buffer is shorter than it says")
    vertices = triangles = 0
    uses = {}
    for node in document["nodes"]:  # 3.5.2: a tree, each node has at most one parent
        for child in node.get("children", []):
            uses[child] = uses.get(child, 0) + 1
        uses.setdefault(("mesh", node["mesh"]), 0)
        uses[("mesh", node["mesh"])] += 1
        faults.unless(not ("matrix" in node and node.keys() & {"translation", "rotation", "scale"}), "node: two poses")
    roots = [n for scene in document["scenes"] for n in scene["nodes"]]
    faults.unless(len(set(roots)) == len(roots) and not set(roots) & uses.keys(), "scene: a node that is no root")
    faults.unless(0 <= document.get("scene", 0) < len(document["scenes"]), "scene: out of range")
    for number, mesh in enumerate(document["meshes"]):
        for primitive in mesh["primitives"]:
            attributes, faces = check_primitive(document, buffers, primitive, faults)
            faults.unless(0 <= primitive["material"] < len(document["materials"]), "material: out of range")
            vertices += len(attributes["POSITION"]) * uses[("mesh", number)]
            triangles += len(faces) * uses[("mesh", number)]
    for material in document["materials"]:
        pbr = material.get("pbrMetallicRoughness", {})
        numbers = pbr.get("baseColorFactor", []) + [pbr.get("metallicFactor", 1), pbr.get("roughnessFactor", 1)]
        faults.unless(all(0 <= x <= 1 for x in numbers), "material: a factor out of range")
    return faults, vertices, triangles


VALIDATE = """
const validator = require('gltf-validator'), fs = require('fs'), path = require('path');
const file = process.argv[1], folder = path.dirname(file);
validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
  uri: path.basename(file),
  externalResourceFunction: (uri) => Promise.resolve(new Uint8Array(fs.readFileSync(path.join(folder, uri)))),
}).then((report) => console.log(JSON.stringify(report.issues)), (error) => { console.error(error); process.exit(1); });
"""


def has_khronos_validator():
    """npm's gltf-validator, where node finds it (npm install -g gltf-validator; NODE_PATH names other folders)."""
    if not shutil.which("node"):
        return False
    return subprocess.run(["node", "-e", "require('gltf-validator')"], capture_output=True).returncode == 0


def check_with_khronos(path, check):
    done = subprocess.run(["node", "-e", VALIDATE, path], text=True, capture_output=True)
    if done.returncode != 0:
        check.holds(False, f"{path.name}: the Khronos validator says {done.stderr.strip()}")
        return
    issues = json.loads(done.stdout)
    bad = [m for m in issues["messages"] if m["severity"] < 2]  # errors and warnings
    check.holds(not bad, f"{path.name}: the Khronos validator finds {issues['numErrors']} errors, "
                         f"{issues['numWarnings']} warnings {bad[:3]}")


def check_checker(folder, check):
    """The rules find what is wrong: files that were good and are spoiled."""
    good = (folder / "rib.glb").read_bytes()
    size = struct.unpack_from("<I", good, 12)[0]
    document = json.loads(good[20:20 + size])

    def spoil(change, data=None):
        spoiled = json.loads(json.dumps(document))
        change(spoiled)
        text = json.dumps(spoiled).encode()
        text += b" " * (-len(text) % 4)
        rest = data or good[20 + size:]
        (folder / "spoiled.glb").write_bytes(
            struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(rest), len(text), b"JSON") + text + rest)
        return faults_of(folder / "spoiled.glb")[0]

    def with_count(d):
        d["accessors"][0]["count"] -= 1

    def with_bound(d):
        d["accessors"][0]["max"][1] += 1e-3

    def with_property(d):
        d["meshes"][0]["colour"] = 1

    def with_material(d):
        d["meshes"][0]["primitives"][0]["material"] = 7

    check.holds(spoil(lambda d: None) == [], "the rules find nothing in a good file")
    for change in (with_count, with_bound, with_property, with_material):
        check.holds(spoil(change) != [], f"the rules find a file {change.__name__.replace('_', ' ')} that is wrong")


def main():
    command, check = Path(sys.argv[1]).resolve(), e.Checks()
    assimp, khronos = shutil.which("assimp"), has_khronos_validator()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        e.write_helix(folder / "helix.obj")
        e.run(command, "export", "helix.obj", "--yarn", "diameter=1mm", "-o", "helix.glb", folder=folder)
        e.run(command, "relax", e.ROOT / "examples/structures/rib.verm", "--periodic", "-o", "rib.h5", folder=folder)
        e.run(command, "export", "rib.h5", "-o", "rib.glb", folder=folder)
        e.run(command, "export", "rib.h5", "--repeats", "3x2", "-o", "six.gltf", folder=folder)
        e.run(command, "build", e.ROOT / "examples/structures/intarsia.verm", "--window", "4x4", "-o", "piece.glb",
              folder=folder)
        for file in ("helix.glb", "rib.glb", "six.gltf", "piece.glb"):
            faults, vertices, triangles = faults_of(folder / file)
            check.holds(not faults, f"{file}: {vertices} vertices, {triangles} triangles keep the rules {faults}")
            if khronos:
                check_with_khronos(folder / file, check)
            if not assimp:
                continue
            said = subprocess.run([assimp, "info", folder / file], text=True, capture_output=True).stdout
            faces = int(re.search(r"^Faces:\s+(\d+)", said, re.MULTILINE).group(1))
            once = triangles // 6 if file == "six.gltf" else triangles  # a mesh counts once, however many nodes show it
            check.holds(faces == once, f"{file}: Assimp reads {faces} triangles")
        check_checker(folder, check)
    if not khronos:
        print("npm's gltf-validator is not installed: its reading is left out")
    if not assimp:
        print("Assimp (Debian package assimp-utils) is not installed: its reading is left out")
    check.exit()


main()
