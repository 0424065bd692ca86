import os
import subprocess
import sys

import pytest
from caretree.sim import portable_blas

COMMAND = "import sys; from caretree.trees.cli import main; assert 'numpy' not in sys.modules; main(['--help'])"
LOADED = "import numpy, threadpoolctl; print({each['architecture'] for each in threadpoolctl.threadpool_info()})"


def ran(code, **environment):
    kept = {name: value for name, value in os.environ.items() if name != "OPENBLAS_CORETYPE"}
    return subprocess.run([sys.executable, "-c", code], env=kept | environment, capture_output=True, text=True)


@pytest.mark.skipif(not portable_blas.has_them(), reason="the processor is told by Linux alone")
@pytest.mark.parametrize(("given", "taken"), [({}, "Haswell"), ({"OPENBLAS_CORETYPE": "Sandybridge"}, "Sandybridge")])
def test_every_command_has_the_same_loops_unless_it_is_told_others(given, taken):
    pytest.importorskip("threadpoolctl")
    out = ran(f"try:\n    exec({COMMAND!r})\nexcept SystemExit:\n    pass\n{LOADED}", **given)
    assert out.returncode == 0, out.stderr
    assert out.stdout.splitlines()[-1] == f"{{'{taken}'}}"


@pytest.mark.parametrize(
    ("machine", "flags", "taken"),
    [("x86_64", "flags: fma sse2 avx2", "Haswell"), ("x86_64", "flags: sse2", None), ("aarch64", "avx2 fma", None)],
)
def test_a_processor_that_lacks_them_keeps_its_own(monkeypatch, tmp_path, machine, flags, taken):
    (tmp_path / "cpuinfo").write_text(flags)
    monkeypatch.setattr(portable_blas, "CPU", tmp_path / "cpuinfo")
    monkeypatch.setattr(portable_blas.platform, "machine", lambda: machine)
    monkeypatch.setenv("OPENBLAS_CORETYPE", "")  # so that it is put back
    monkeypatch.delenv("OPENBLAS_CORETYPE")
    portable_blas.portable_blas()
    assert os.environ.get("OPENBLAS_CORETYPE") == taken
