"""The same input gives the same bytes as when `bytes.tsv` was written."""

from support.result_bytes import differences, recorded, words_of_cases, words_of_files


def test_results_have_the_recorded_bytes() -> None:
    """If that is meant to change, `scripts/corpus_bytes --record` writes the record anew."""
    words = dict([*words_of_cases(), *words_of_files()])
    changed = differences(recorded(), words)
    assert not changed, "\n".join(changed)
