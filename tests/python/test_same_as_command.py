"""The module does what the command does: the same numbers to the last bit, the same files, the same words."""
import csv
import io
import os
from pathlib import Path

import numpy as np
import pytest

import loopwright

OF_THE_RUN = {"wall_s", "peak_memory_mb"}


@pytest.mark.parametrize("structure", ["rib", "garter", "full_cardigan"])
def test_relaxed_cells_are_the_same_to_the_bit(structure, examples, command, tmp_path):
    file = examples / f"structures/{structure}.verm"
    said = command.json("relax", file, "--periodic", "-o", "of_command.h5")
    cloth = loopwright.relax(file, periodic=True)
    assert {key: value for key, value in said.items() if key not in OF_THE_RUN} == cloth.measure()
    cloth.save(tmp_path / "of_module.h5")
    assert (tmp_path / "of_module.h5").read_bytes() == (tmp_path / "of_command.h5").read_bytes()


def test_a_held_window_and_a_piece_let_go(examples, command, tmp_path):
    file = examples / "structures/garter.verm"
    command("relax", file, "--window", "2x2", "-o", "window.h5")
    window = loopwright.relax(file, window=(2, 2))
    window.save(tmp_path / "window_of_module.h5")
    assert (tmp_path / "window.h5").read_bytes() == (tmp_path / "window_of_module.h5").read_bytes()
    swatch = tmp_path / "swatch.verm"
    swatch.write_text((examples / "free_swatch.verm").read_text().replace("7 wales x 7 courses", "3 wales x 3 courses"))
    command("relax", swatch, "--let-go", "--most-iterations", "8", "-o", "free.h5")
    with pytest.warns(loopwright.NotAtRestWarning):
        free = loopwright.relax(swatch, let_go=True, most_iterations=8)
    free.save(tmp_path / "free_of_module.h5")
    assert (tmp_path / "free.h5").read_bytes() == (tmp_path / "free_of_module.h5").read_bytes()


def test_stretch_tests_are_the_same_to_the_bit(examples, command):
    file = examples / "acrylic_jersey.verm"
    text, _ = command("stretch", file, "--periodic", "--segments", "12", "--to", "0.1", "0", "--csv", "-")
    rows = list(csv.DictReader(io.StringIO(text)))
    test = loopwright.stretch(loopwright.relax(file, periodic=True), to=[0.1, 0])
    assert list(test.columns) == list(rows[0])
    for name, column in test.columns.items():
        assert [float(row[name]) for row in rows] == pytest.approx(column.astype(float), rel=1e-11), name
    assert test.whole and test.converged and len(test) == 11
    kept, expected = test.interlacings_kept
    assert kept == expected > 0
    loaded = loopwright.stretch(file, periodic=True, load=[5.0])
    assert loaded["course_force_N_m"][-1] == pytest.approx(5.0, rel=1e-3)


def test_membrane_constants_are_the_same(examples, command):
    file = examples / "structures/garter.verm"
    strains = dict(course=[0.05], wale=[-0.05, 0.05], shear=[0.05])
    said = command.json("homogenise", file, "--course", "0.05", "--wale", "-0.05", "0.05", "--shear", "0.05",
                        "--segments", "12")
    found = loopwright.homogenise(file, segments_per_loop=12, **strains)
    grid = found.pop("grid")
    assert found.pop("whole") is True and found.pop("stopped") is False
    assert found == said
    assert len(grid["course_strain"]) == 2 * 3 * 2
    assert (grid["interlacings_intact"] == grid["interlacings"]).all()


def test_sensitivities_are_the_same(examples, command):
    file = examples / "structures/garter.verm"
    said = command.json("sensitivity", file, "--segments", "12", "--deviation", "loop-length=2")
    assert said == loopwright.sensitivity(file, segments_per_loop=12, deviations={"loop-length": 2})
    assert said["relative_change_per_relative_change"]["loop-length"]["width"] > 0.5


def test_states_go_to_and_fro(examples, command, tmp_path):
    command("relax", examples / "structures/moss.verm", "--periodic", "-o", "moss.h5")
    cloth = loopwright.load(tmp_path / "moss.h5")
    assert cloth.converged and cloth.whole
    assert cloth.measure() == command.json("measure", "moss.h5")
    again = loopwright.relax(tmp_path / "moss.h5")
    assert again.converged and again.numbers["newton_iterations"] >= cloth.numbers["newton_iterations"]


def test_every_format_is_written_as_by_the_command(rib, command, tmp_path):
    rib.save(tmp_path / "rib.h5")
    for name, entry in loopwright.formats().items():
        suffix = entry["suffixes"][0] if entry["suffixes"] else ".bcc"
        command("export", "rib.h5", "--format", name, "-o", "command" + suffix)
        rib.export(tmp_path / ("module" + suffix), format=name)
        written = [(tmp_path / (who + suffix)).read_bytes() for who in ("command", "module")]
        # a glTF text names the file of its bytes
        assert written[0].replace(b"command", b"module") == written[1], name
        assert len(written[0]) > 100
    rib.export(tmp_path / "six.obj", repeats=(3, 2))
    assert (tmp_path / "six.obj").read_text().count("\nl ") == 6 * len(rib.yarns)


def test_pictures_are_the_same(rib, command, tmp_path):
    image = pytest.importorskip("matplotlib.image")
    rib.save(tmp_path / "rib.h5")
    command("render", "rib.h5", "-o", "command.png", "--view", "corner", "--picture-size", "200x150")
    pixels = rib.render(view="corner", size=(200, 150))
    assert pixels.shape == (150, 200, 4) and pixels.dtype == np.uint8
    drawn = image.imread(tmp_path / "command.png")  # opaque pictures are saved without alpha
    assert (np.round(drawn[..., :3] * 255).astype(np.uint8) == pixels[..., :3]).all()
    loopwright.write_png(tmp_path / "module.png", pixels)
    assert (tmp_path / "module.png").read_bytes() == (tmp_path / "command.png").read_bytes()
    assert len(np.unique(pixels.reshape(-1, 4), axis=0)) > 50
    (tmp_path / "notebook.png").write_bytes(rib._repr_png_())
    assert image.imread(tmp_path / "notebook.png").shape[:2] == (600, 800)
    assert (rib.render(size=(64, 64), transparent=True)[..., 3] == 0).any()


def test_a_picture_has_the_scale_that_is_asked_for(rib):
    """Cells follow each other after as many pixels as their lattice vectors say."""
    (across, _, _), (_, along, _) = rib.lattice_mm
    scale = 48 / across
    pixels = rib.render(size=(200, 200), pixels_per_mm=scale, repeats=(8, 10), table=False)[..., :3].astype(float)
    assert pixels.std() > 20
    one, two = pixels[:, :-48], pixels[:, 48:]
    assert abs(one - two).mean() < 0.1 * pixels.std()
    assert abs(pixels[:, :-40] - pixels[:, 40:]).mean() > 0.5 * pixels.std()
    rows = round(along * scale)
    assert abs(along * scale - rows) < 0.5
    assert abs(pixels[:-rows] - pixels[rows:]).mean() < 0.3 * pixels.std()


def test_what_cloth_went_through_counts(examples):
    """As the C++ function's own test: a cell on the needles, then let go, is wider than one that never was there."""
    program = loopwright.read(examples / "structures/garter.verm")
    first = program.build(periodic=True)
    pulled = loopwright.relax_as_knitted(first, machine_width_mm=1.5 * first.measure()["width_mm"], flat_gap_mm=1.5)
    assert pulled.whole and pulled.converged
    assert pulled.measure()["width_mm"] > 1.01 * loopwright.relax(first).measure()["width_mm"]
    with pytest.raises(loopwright.Error, match="the width on the machine must be a positive number"):
        loopwright.relax_as_knitted(first, machine_width_mm=0)


def test_findings_are_those_of_the_command(examples, command, tmp_path):
    (tmp_path / "bad.k").write_text(";!knitout-2\n;;Carriers: 1\ninhook 1\nknit + f1\nknit + f2 9\nxfer f1 f2\n")
    said = command.json("check", "bad.k", examples / "swatch.k", "--machine", "kniterate", status=1)
    for entry, file in zip(said["files"], [tmp_path / "bad.k", examples / "swatch.k"]):
        found = loopwright.check(file, machine="kniterate")
        assert [(d.severity, d.line, d.column, d.message) for d in found.diagnostics] == sorted(
            ((d["severity"], d.get("line", 0), d.get("column", 0), d["message"]) for d in entry["diagnostics"]),
            key=lambda d: d[1:3])
        for key in ("errors", "warnings", "advice", "loops", "yarns", "passes", "interlacings", "instructions"):
            assert getattr(found, key) == entry[key], key
        assert bool(found) == (entry["errors"] == 0)


def test_programmes_of_others_are_judged_alike(command):
    """Every file of the corpus, broken ones among them."""
    corpus = Path(os.environ.get("LOOPWRIGHT_CORPUS", Path(__file__).parents[3] / "shared/corpus")) / "files"
    files = sorted(file for file in corpus.rglob("*") if file.suffix in (".k", ".knitout"))
    if not files:
        pytest.skip(f"there are no programmes of others in {corpus} (LOOPWRIGHT_CORPUS says where they lie)")
    findings = [loopwright.check(file) for file in files]
    said = command.json("check", *files, status=0 if all(findings) else 1)["files"]
    assert len(files) > 40 and not all(findings)
    for found, entry in zip(findings, said):
        assert [found.errors, found.warnings, found.advice, found.loops, found.interlacings] == [
            entry[key] for key in ("errors", "warnings", "advice", "loops", "interlacings")], entry["file"]
        assert sorted(d.message for d in found.diagnostics) == sorted(d["message"] for d in entry["diagnostics"])
