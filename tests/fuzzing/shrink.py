"""Make wrong scenes smaller, and store them as cases of the corpus."""

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from .judge import Judge
from .places import Point, UndecidedError, location
from .scenes import UNIT, Body, Expression, Part, Scene

#: Multiples of this many steps that coordinates are rounded to, the coarsest first.
COARSER = (UNIT, UNIT // 2, UNIT // 10, UNIT // 1000, 10)


def shrunk(scene: Scene, judge: Judge) -> Scene:
    """Return a scene that is wrong in the same way and cannot be simplified in one step."""
    kinds = _kinds(scene, judge)
    while True:
        smaller = (each for each in simpler(scene) if kinds & _kinds(each, judge))
        found = next(smaller, None)
        if found is None:
            return scene
        scene = found


def _kinds(scene: Scene, judge: Judge) -> set[str]:
    return {complaint.split(":")[0] for complaint in judge(scene)}


def simpler(scene: Scene) -> Iterator[Scene]:
    """Yield scenes with one operation, operand, part, motion, point or digit less."""
    for inner in _inner(scene.expression):
        yield _without_unused(replace(scene, expression=inner))
    for k in range(1, len(scene.bodies)):
        numbers = {j: 0 if j == k else j for j in range(len(scene.bodies))}
        yield _without_unused(replace(scene, expression=_renamed(scene.expression, numbers)))
    for k in range(len(scene.points) if len(scene.points) > 1 else 0):
        half = len(scene.points) // 2
        if k < 2 and half > 1:
            yield replace(scene, points=scene.points[k * half : (k + 1) * half])
        yield replace(scene, points=scene.points[:k] + scene.points[k + 1 :])
    for k, body in enumerate(scene.bodies):
        for other in _simpler_bodies(body):
            yield replace(scene, bodies=scene.bodies[:k] + (other,) + scene.bodies[k + 1 :])
    for step in COARSER:
        rounded = _on_grid(scene, step)
        if rounded != scene:
            yield rounded


def _inner(expression: Expression) -> Iterator[Expression]:
    """Yield the expression with one of its nodes replaced by a child of that node."""
    if isinstance(expression, int):
        return
    operator, *arguments = expression
    yield from arguments
    for k, argument in enumerate(arguments):
        for other in _inner(argument):
            yield (operator, *arguments[:k], other, *arguments[k + 1 :])


def _without_unused(scene: Scene) -> Scene:
    used = sorted(_operands(scene.expression))
    numbers = {old: new for new, old in enumerate(used)}
    bodies = tuple(scene.bodies[k] for k in used)
    return replace(scene, bodies=bodies, expression=_renamed(scene.expression, numbers))


def _operands(expression: Expression) -> set[int]:
    if isinstance(expression, int):
        return {expression}
    return set[int]().union(*(_operands(each) for each in expression[1:]))


def _renamed(expression: Expression, numbers: dict[int, int]) -> Expression:
    if isinstance(expression, int):
        return numbers[expression]
    return (expression[0], *(_renamed(each, numbers) for each in expression[1:]))


def _simpler_bodies(body: Body) -> Iterator[Body]:
    for k in range(len(body.motions)):
        yield replace(body, motions=body.motions[:k] + body.motions[k + 1 :])
    if len(body.parts) > 1:
        for k in range(len(body.parts)):
            yield replace(body, parts=body.parts[:k] + body.parts[k + 1 :])
    if body.rule != "positive":
        yield replace(body, rule="positive")


def _on_grid(scene: Scene, step: int) -> Scene:
    def point(p: Point) -> Point:
        x, y, z = (round(k / step) * step for k in p)
        return x, y, z

    def rounded(body: Body) -> Body:
        # What rounding presses flat is a plain part no more.
        parts = tuple(
            Part(tuple(map(point, part.vertices)), part.faces, False) for part in body.parts
        )
        same = all(new.vertices == old.vertices for new, old in zip(parts, body.parts, strict=True))
        return body if same else replace(body, parts=parts)

    points = tuple(dict.fromkeys(map(point, scene.points)))
    moved = replace(scene, bodies=tuple(map(rounded, scene.bodies)))
    return moved if moved != scene else replace(scene, points=points)


# Cases


def case_of(scene: Scene, why: str) -> dict[str, Any]:
    """Return a scene as a case of the corpus, with the known facts of its result."""
    places = []
    for point in scene.points:
        try:
            place = location(scene.known(), scene.value, point)
        except UndecidedError:
            continue
        places.append([*(k / UNIT for k in point), place])
    return {
        "why": why,
        "operands": [_operand(body) for body in scene.bodies],
        "expression": scene.text(),
        "expect": {"places": places},
    }


def _operand(body: Body) -> dict[str, Any]:
    if body.plane is not None:
        return {"half_space": list(body.half_space())}
    vertices, faces = body.arrays()
    given: dict[str, Any] = {"vertices": vertices, "faces": faces}
    return given if body.rule == "positive" else {**given, "winding": body.rule}


def keep_case(folder: Path, name: str, scene: Scene, why: str) -> Path:
    """Write a scene as a case, and return its path."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.json"
    path.write_text(json.dumps(case_of(scene, why), indent=1) + "\n")
    return path
