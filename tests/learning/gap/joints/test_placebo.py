from ..solved import solved


def test_placebo_does_not_help_and_the_smallest_size_is_smaller_than_the_found(axis_set):
    study, _, effects, _, _ = solved(axis_set(lambda q, v, a: 6.0 * v))
    placebos = study.show()[2]
    assert placebos
    assert all(p.ratio > 0.97 for p in placebos)
    assert 0.0 < effects[0].smallest < 1.0
