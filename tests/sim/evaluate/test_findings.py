"""What one look finds is added to what another found."""

from caretree.sim.evaluate.findings import Findings


def test_findings_add_up():
    one = Findings(problems=["a"], numbers={"x": 1.0})
    one.add(Findings(problems=["b"], numbers={"y": 2.0}, places={"y": "at 3.0 s"}))
    assert one == Findings(problems=["a", "b"], numbers={"x": 1.0, "y": 2.0}, places={"y": "at 3.0 s"})
