"""The page of a fault campaign has a cell for every fault, told apart by how it ended."""

from caretree.trees.campaign.fault_row import Row
from caretree.trees.campaign.heat_map import COLOURS, page, write_heat_map

ROWS = [
    Row(node="lift <1>", phase="step", fault="occlusion", outcome="success", time_to_safe=3.25),
    Row(node="lift <1>", phase="step", fault="grip_slip", outcome="safe_stop", unsafe="an arm still moves"),
    Row(node="lift <1>", phase="cancel", fault="occlusion", outcome="not_reached"),
]


def test_every_row_is_a_cell_with_its_colour_its_time_and_why(tmp_path):
    text = page("wave & more", ROWS)
    assert text.count('class="cell"') == 3
    assert "<h1>wave &amp; more</h1>" in text
    assert "<th>lift &lt;1&gt;<td>step" in text
    assert f'background:{COLOURS["success"]}" title="success: ">3.2' in text
    assert f'background:{COLOURS["unsafe"]}" title="safe stop: an arm still moves">' in text
    assert "&nbsp;1&nbsp;</span> not reached: nothing is said of it" in text
    assert write_heat_map(tmp_path, "odd \ud800 name", ROWS).read_text().endswith("</table>\n")
