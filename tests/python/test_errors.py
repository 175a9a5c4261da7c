"""What is wrong is raised with the command's words, its place and its remedy; a broken result says so."""
import inspect
import os
import pickle
import random
from pathlib import Path

import pytest

import loopwright

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
GOOD = ";!vermiculation-1\n;;Gauge: 12\n;;Yarn-A: wool 2/28 Nm\n;;Loop-Length: 5.9 mm\n;;Size: 4 wales x 4 courses\ng\n"


def test_a_wrong_programme_is_told_with_its_places():
    text = GOOD.replace("Gauge: 12", "Gauge: -12") + "gq\n"
    with pytest.raises(loopwright.Error) as caught:
        loopwright.read_text(text, name="bad.verm")
    error = caught.value
    assert [(d.line, d.column, d.severity) for d in error.diagnostics] == [(2, 10, "error"), (7, 2, "error")]
    assert str(error).splitlines() == [str(d) for d in error.diagnostics]
    assert str(error).startswith("bad.verm:2:10: error: Gauge must be greater than 0")
    assert error.diagnostics[1].remedy.startswith("letters are g e")
    again = pickle.loads(pickle.dumps(error))  # as multiprocessing hands it on
    assert str(again) == str(error) and [str(d) for d in again.diagnostics] == [str(d) for d in error.diagnostics]
    found = loopwright.check_text(text, name="bad.verm")
    assert not found and found.errors == 2 and str(found) == str(error)
    assert loopwright.check_text(GOOD) and "loops" in str(loopwright.check_text(GOOD))


@pytest.mark.parametrize("call, said", [
    (lambda: loopwright.read("nowhere.verm"), "nowhere.verm: error"),
    (lambda: loopwright.load("nowhere.h5"), "nowhere.h5"),
    (lambda: loopwright.read_text(GOOD).build(periodic=True, window=(4, 4)), "one of periodic and window"),
    (lambda: loopwright.read_text(GOOD).build(window="4by4"), "WALESxCOURSES"),
    (lambda: loopwright.read_text(GOOD).build(layout="round"), "there are flat, loop"),
    (lambda: loopwright.read_text(GOOD).build(friction=-1), "friction lies from 0 to 5"),
    (lambda: loopwright.read_text(GOOD, gauge_npi=0), "Gauge must be greater than 0"),
    (lambda: loopwright.read_text(GOOD, yarn="wool 9/99"), "unknown material"),
    (lambda: loopwright.check_text(GOOD, machine="stoll"), "there are shima, kniterate"),
    (lambda: loopwright.build(loopwright.read_text(GOOD).build(), periodic=True), "a piece already"),
    (lambda: loopwright.read_text(GOOD).build().export("a.xyz"), "known are .tubes.obj"),
    (lambda: loopwright.read_text(GOOD).build().export("a.obj", format="iges"), "there is no format 'iges'"),
    (lambda: loopwright.read_text(GOOD).build(window=(2, 2)).export("a.obj", repeats=(2, 2)), "periodic cell"),
    (lambda: loopwright.read_text(GOOD).build().export("nowhere/a.obj"), "nowhere"),
    (lambda: loopwright.read_text(GOOD).build().render(view="above"), "left-corner"),
    (lambda: loopwright.read_text(GOOD).build().render(size=(4, 4)), "16"),
    (lambda: loopwright.read_text(GOOD).build().yarns[0].centreline(0), "from 1 to 64"),
    (lambda: loopwright.stretch(loopwright.read_text(GOOD), direction="up"), "course, wale, both, shear"),
    (lambda: loopwright.stretch(loopwright.read_text(GOOD), to=[-2.0]), "between -0.9 and 5"),
    (lambda: loopwright.sensitivity(loopwright.read_text(GOOD), deviations={"colour": 2}), "there are loop-length"),
    (lambda: loopwright.homogenise(loopwright.read_text(GOOD), course=[-0.95]), "strains must ascend"),
])
def test_a_call_that_cannot_be_served_says_what_to_do(call, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(loopwright.Error) as caught:
        call()
    assert said in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_a_wrong_argument_is_a_type_error():
    with pytest.raises(TypeError):
        loopwright.read_text(GOOD, loop_length=5)
    with pytest.raises(TypeError):
        loopwright.read_text(GOOD).build(window=5)
    with pytest.raises(TypeError):
        loopwright.read_text(GOOD).build("periodic")


def test_cloth_that_is_not_at_rest_or_broken_warns():
    with pytest.warns(loopwright.NotAtRestWarning, match="not at rest"):
        cloth = loopwright.relax(loopwright.read_text(GOOD), periodic=True, most_iterations=2)
    assert cloth.converged is False and cloth.message
    # curves that cross: no step of theirs can be certified
    Path("crossing.obj").write_text("v -9 0 0\nv 0 0 0\nv 9 0 0\nv 0 -9 0.05\nv 0 0 0.05\nv 0 9 0.05\nl 1 2 3\nl 4 5 6\n")
    try:
        curves = loopwright.read_curves("crossing.obj", yarn="diameter=1mm")
        assert curves.measure()["min_clearance"] < 0.1 and len(curves.loops) == 0
    finally:
        Path("crossing.obj").unlink()


def test_stated_data_count_more_than_the_file():
    program = loopwright.read_text(GOOD)
    longer = program.changed(loop_length_mm=7.0, yarn="diameter=0.3mm")
    cells = [p.build(periodic=True) for p in (program, longer, longer.changed(loop_length_mm=5.9))]
    rest = [sum(y.rest_length_mm for y in cell.yarns) / len(cell.loops) for cell in cells]
    assert rest == pytest.approx([5.9, 7.0, 5.9], rel=1e-9)
    assert [cell.diameter_mm for cell in cells[1:]] == pytest.approx([0.3, 0.3])
    assert cells[0].diameter_mm != pytest.approx(0.3)


def test_text_that_is_not_utf8_is_read_and_told(tmp_path):
    """Bytes of an older encoding, in the file and in its name."""
    swatch = (EXAMPLES / "swatch.k").read_bytes().replace(b"; A small", b"; A sm\xe4ll")
    (tmp_path / "latin.k").write_bytes(swatch)
    program = loopwright.read(tmp_path / "latin.k")
    assert "; A sm\ufffdll" in program.text
    assert pickle.loads(pickle.dumps(program)).text == program.text
    assert "UTF-8" in str(loopwright.check(program)) and "UTF-8" in loopwright.check(program).diagnostics[0].message
    (tmp_path / "name.verm").write_bytes(GOOD.encode().replace(b";;Gauge", b";;Name: caf\xe9\n;;Gauge") + b"q\xe9\n")
    with pytest.raises(loopwright.Error) as caught:
        loopwright.read(tmp_path / "name.verm")
    assert [str(d) for d in pickle.loads(pickle.dumps(caught.value)).diagnostics] == str(caught.value).splitlines()
    (tmp_path / "name.verm").write_bytes(GOOD.encode().replace(b";;Gauge", b";;Name: caf\xe9\n;;Gauge"))
    assert loopwright.build(tmp_path / "name.verm", periodic=True).name == "caf\ufffd"
    unreadable = Path(os.fsdecode(bytes(tmp_path / "f") + b"\xe9.k"))
    unreadable.write_bytes(b"junk")
    assert "\ufffd.k" in repr(loopwright.check(unreadable))


@pytest.mark.parametrize("suffix", [".k", ".verm", ".h5", ".obj", ".bcc", ".yarns"])
def test_junk_is_an_error_and_nothing_else(suffix, tmp_path):
    draw = random.Random(suffix)
    for _ in range(60):
        file = tmp_path / ("junk" + suffix)
        file.write_bytes(draw.randbytes(draw.randrange(300)))
        with pytest.raises(loopwright.Error):
            loopwright.build(file)
        assert isinstance(str(loopwright.check(file)), str)


def public_names(thing):
    return {name for name in vars(thing) if not name.startswith("_") and name != "Progress"}


def test_the_type_hints_name_what_there_is():
    """The stub and the compiled half hold the same classes and functions with the same members."""
    import ast

    compiled = loopwright._loopwright
    tree = ast.parse((Path(loopwright.__file__).parent / "_loopwright.pyi").read_text())
    told = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    only_types = {"Measurements", "Homogenised", "Sensitivity"}
    assert set(told) - only_types == public_names(compiled)
    for name, node in told.items():
        if not isinstance(node, ast.ClassDef) or name in only_types:
            continue
        members = {child.name for child in node.body if isinstance(child, ast.FunctionDef)}
        there = public_names(getattr(compiled, name))
        assert {m for m in members if not m.startswith("_")} == there, name
        assert all(hasattr(getattr(compiled, name), m) for m in members), name


def test_the_stub_names_every_measurement(rib):
    import ast

    tree = ast.parse((Path(loopwright.__file__).parent / "_loopwright.pyi").read_text())
    told = next(node for node in tree.body if getattr(node, "name", "") == "Measurements")
    assert set(rib.measure()) <= {field.target.id for field in told.body if isinstance(field, ast.AnnAssign)}


def test_everything_public_has_a_docstring():
    for name in loopwright.__all__:
        thing = getattr(loopwright, name)
        if name not in ("Source", "__version__"):
            assert inspect.getdoc(thing), name
    assert (Path(loopwright.__file__).parent / "py.typed").exists()


def test_the_type_hints_hold():
    """mypy finds nothing in the package, and a wrong use of it."""
    import subprocess
    import sys

    pytest.importorskip("mypy", reason="mypy (Debian package mypy) is not installed")
    package = Path(loopwright.__file__).parent
    wrong = ("import loopwright\nloopwright.relax('rib.verm', periodic='yes')\n"
             "loopwright.read('rib.verm').build().measure()['width']\n")
    for arguments, faults in [(["-p", "loopwright"], 0), (["-c", wrong], 2)]:
        done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", "/dev/null", *arguments],
                              cwd=package.parent, capture_output=True, text=True)
        assert done.stdout.count(": error: ") == faults, done.stdout + done.stderr
