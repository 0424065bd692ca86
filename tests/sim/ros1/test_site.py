"""A site file is read whole, and each mistake in it is one sentence."""

import numpy as np
import pytest
from caretree.sim.ros1.site import SITES, SiteError, read_site, transform

TEXT = (SITES / "baxter.yaml").read_text()


def test_the_one_that_comes_with_the_package_is_read():
    site = read_site()
    assert site.arms["left"].joints[0] == "left_s0"
    assert site.grippers["right"].force == (5.0, 235.0)
    assert set(site.cameras) == {"head", "left_hand", "right_hand"}


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ("robot: baxter", "robot: pr2", "robot is 'pr2', but there are models of baxter"),
        ("alive: /caretree/alive\n", "", "alive is missing"),
        ("alive: /caretree/alive", "alife: /caretree/alive", "alife is unknown; .*; alive is meant?"),
        ("fresh: 0.3", "fresh: soon", "fresh is 'soon', but a number is asked for"),
        ("fresh: 0.3", "fresh: 0", "fresh is 0, but more than 0 is asked for"),
        ("fresh: 0.3", "fresh: .nan", "fresh is nan, but a number is asked for"),
        ("force: [5, 235]", "force: [5]", r"grippers.left.force is \[5\], but 2 of numbers is asked for"),
        ("left_w1, left_w2]", "left_w1]", "arms.left.joints has 6, but 7 are asked for: baxter's"),
        ("command: /cmd_vel", "command: cmd_vel", "base.command is 'cmd_vel', but a name that begins with / is asked"),
        ("command: /cmd_vel", "command: /map", "base.command and room.grid are both /map"),
        (
            "  head:\n    colour",
            "  tail:\n    colour",
            "cameras.tail is unknown; there are head, left_hand",
        ),
        ("robot: baxter", "robot: [baxter", r"site.yaml:\d+: expected"),
        ("robot: baxter", "robot: baxter\nrobot: baxter", "'robot' is given twice"),
    ],
)
def test_a_mistake_is_one_sentence(tmp_path, right, wrong, said):
    assert right in TEXT
    file = tmp_path / "site.yaml"
    file.write_text(TEXT.replace(right, wrong, 1))
    with pytest.raises(SiteError, match=said) as caught:
        read_site(str(file))
    assert str(file) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_site_that_is_not_there_says_which_are():
    with pytest.raises(SiteError, match=r"no site 'attic': .* there are baxter, or give a .yaml"):
        read_site("attic")


def test_turns_are_about_the_outer_axes():
    pose = transform((1.0, 2.0, 3.0), (0.3, -0.4, 0.5))
    assert np.allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3))
    quarter = transform((0.0, 0.0, 0.0), (np.pi / 2, 0.0, np.pi / 2))
    assert np.allclose(quarter[:3, :3] @ (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))  # about x first, then about z
    assert np.allclose(quarter[:3, :3] @ (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
