"""Arrays are views: nothing is copied, nothing can be written, and they keep what they look at."""
import gc

import numpy as np
import pytest

import loopwright


def address(array):
    return array.__array_interface__["data"][0]


def arrays_of(cloth):
    points, forces, loops, interlacings = cloth.points()[0], cloth.forces(), cloth.loops, cloth.interlacings
    yield from (cloth.yarns[0].control_points, cloth.yarns[0].held, points.place_mm, points.arc_mm, points.loop,
                points.curvature_per_mm, points.tension, points.contact, forces.tension, forces.contact)
    for name in ("number", "yarn", "begin", "apex", "end", "kind", "side", "course", "slot", "bed", "line"):
        assert len(getattr(loops, name)) == len(loops)
        yield getattr(loops, name)
    for name in ("parent", "child", "sign"):
        assert len(getattr(interlacings, name)) == len(interlacings)
        yield getattr(interlacings, name)


def test_nothing_is_copied(rib):
    for name in ("control_points", "held"):
        one, two = getattr(rib.yarns[0], name), getattr(rib.yarns[0], name)
        assert address(one) == address(two) and one.base is not None and not one.flags.owndata
    loops = rib.loops
    assert address(loops.apex) - address(loops.begin) == 8  # members of one struct, side by side
    assert loops.apex.strides == loops.course.strides != (8,)
    points = rib.points()[0]
    assert address(points.place_mm) == address(points.place_mm)
    forces = rib.forces()
    assert address(forces.tension) == address(forces.tension)


def test_nothing_can_be_written(rib):
    for array in arrays_of(rib):
        assert not array.flags.writeable
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
        with pytest.raises(ValueError):
            array.flags.writeable = True


def test_arrays_outlive_their_cloth(examples):
    cloth = loopwright.build(examples / "structures/rib.verm", periodic=True)
    points, slots, line = cloth.yarns[0].control_points, cloth.loops.slot, cloth.yarns[0].centreline()
    before = points.copy(), slots.copy(), line.copy()
    del cloth
    gc.collect()
    filler = [loopwright.build(examples / "structures/moss.verm", periodic=True) for _ in range(20)]
    assert all((now == then).all() for now, then in zip((points, slots, line), before)) and filler


def test_control_points_are_those_of_the_spline(rib):
    """The centreline is the uniform cubic B-spline of the control points, evaluated here by its basis."""
    yarn = rib.yarns[0]
    q = yarn.control_points * rib.diameter_mm
    across = yarn.shift[0] * rib.lattice_mm[0] + yarn.shift[1] * rib.lattice_mm[1]
    q = np.vstack([q, q[:3] + across])
    steps = 8
    u = np.arange(steps) / steps
    weights = np.stack([(1 - u) ** 3, 3 * u ** 3 - 6 * u ** 2 + 4, -3 * u ** 3 + 3 * u ** 2 + 3 * u + 1, u ** 3]) / 6
    spline = np.concatenate([weights.T @ q[e:e + 4] for e in range(yarn.segments)])
    line = yarn.centreline(steps)
    assert line.shape == (yarn.segments * steps + 1, 3)
    assert np.abs(line[:-1] - spline).max() < 1e-12
    assert np.abs(line[-1] - line[0] - across).max() < 1e-12
    length = np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
    assert length == pytest.approx(rib.measure()["loop_length_mm"] * len(rib.loops), rel=1e-3)


def test_tension_balances_a_load(examples):
    """Pulled along its courses, the yarn that crosses a section of the cell carries what the frame feels, up to
    contact: garter at a strain where its yarn runs along the courses."""
    test = loopwright.stretch(examples / "structures/garter.verm", periodic=True, to=[0.3], friction=0.0)
    forces = test.cloth.forces()
    assert forces.tension_name == "tension_cN" and forces.contact_name == "contact_cN_per_mm"
    assert forces.contact.shape[0] == len(forces.tension) == sum(y.segments for y in test.cloth.yarns)
    assert test["course_force_N_m"][-1] > 0 and forces.tension.mean() > 0
    # a first geometry has no forces, and says so
    first = loopwright.build(examples / "structures/garter.verm", periodic=True)
    assert first.forces() is None and first.points()[0].tension is None and first.converged is None


def test_loops_are_those_of_the_notation(rib):
    assert set(rib.loops.side) == {1, -1} and set(rib.loops.bed) == {0, 1}
    assert (rib.loops.begin < rib.loops.apex).all() and (rib.loops.apex < rib.loops.end).all()
    line = rib.loops.line[0]
    text = loopwright.read_text(LETTERS, name="two lines").build().loops
    assert line > 0 and set(text.line) == {6, 7}
    assert set(text.side[text.line == 6]) == {1} and set(text.side[text.line == 7]) == {-1}


LETTERS = """;!vermiculation-1
;;Gauge: 12
;;Yarn-A: wool 2/28 Nm
;;Loop-Length: 5.9 mm
;;Size: 4 wales x 4 courses
g
e
"""
