"""Results of the corpus have the same bytes as when `bytes.tsv` was recorded."""

from support.result_bytes import differences, recorded, words_of_cases, words_of_files


def test_results_have_the_recorded_bytes() -> None:
    """After an intended change, `scripts/corpus_bytes --record` updates the record."""
    words = dict([*words_of_cases(), *words_of_files()])
    changed = differences(recorded(), words)
    assert not changed, "\n".join(changed)
