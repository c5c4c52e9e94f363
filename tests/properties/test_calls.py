"""Random calls of the public interface return results, or raise errors that say why."""

import pytest

from fuzzing.calls import judge_call, random_call


@pytest.mark.parametrize("first", range(0, 1200, 100))
def test_any_call_ends_in_an_answer_or_a_reason(first: int) -> None:
    told = (judge_call(random_call(seed)) for seed in range(first, first + 100))
    assert [complaint for complaint in told if complaint] == []


def test_the_judge_of_calls_notices() -> None:
    assert judge_call("b.cube(1).volume") is None
    assert judge_call("b.cube(-1).volume") is None
    assert "ZeroDivisionError" in (judge_call("b.cube(1).volume / 0") or "")
