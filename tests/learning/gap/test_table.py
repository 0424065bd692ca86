import numpy as np
from caretree.learning.gap.measurement import load_set


def test_a_byte_order_mark_and_comments_are_no_obstacle(axis_set):
    folder = axis_set()
    file = folder / "e1.csv"
    plain = load_set(folder).episodes[1].columns["force"]
    lines = file.read_text().splitlines()
    file.write_text("\n".join([lines[0], "# a remark", *lines[1:]]), encoding="utf-8-sig")
    assert np.array_equal(load_set(folder).episodes[1].columns["force"], plain)
