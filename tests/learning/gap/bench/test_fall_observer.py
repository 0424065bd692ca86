from caretree.learning.gap.bench.fall_case import draw_fall
from caretree.learning.gap.bench.fall_observer import observe


def test_an_observer_who_knows_the_noise_names_what_is_far_from_every_rival(tmp_path):
    truth, drawn = draw_fall(290, tmp_path)  # a late release and a wrong scale, 22 standard deviations from any rival
    assert truth.kind == "two"
    seen = observe(truth.kind, drawn)
    assert seen.right
    assert set(seen.named) == {"delay", "gain_error"}
    assert seen.chance > 0.99
