"""Two runs never write one folder, and a run that died leaves it free."""

import subprocess
import sys

import pytest
from caretree.sim.errors import RecordError
from caretree.sim.record.folder_claim import FolderClaim, FolderTakenError, claim_free
from caretree.sim.record.record import RUN_FILE, TRACE_FILE, RunResult
from caretree.sim.record.recorder import Recorder

RESULT = RunResult(outcome="failure", reason="The gown fell.", sim_time_s=0.5)
HOLD = (
    "import sys; from pathlib import Path; from caretree.sim.record.folder_claim import FolderClaim; "
    "claim = FolderClaim(Path(sys.argv[1])); print('held', flush=True); sys.stdin.read()"
)


def recorder(directory):
    return Recorder(directory, task="wave", seed=0, world="scripted")


def test_a_second_run_is_refused_until_the_first_has_ended(tmp_path):
    first = recorder(tmp_path / "run")
    first.event({"t": 0.1})
    with pytest.raises(FolderTakenError, match=r"another run is writing .*run: give another folder with --out"):
        recorder(tmp_path / "run")
    assert len((tmp_path / "run" / TRACE_FILE).read_text().splitlines()) == 1
    first.close()
    recorder(tmp_path / "run").finish(RESULT)
    with pytest.raises(FolderTakenError, match="already holds a finished run"):
        recorder(tmp_path / "run")


def test_a_killed_process_leaves_the_folder_free(tmp_path):
    child = subprocess.Popen(
        [sys.executable, "-c", HOLD, str(tmp_path / "run")], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    assert child.stdout is not None
    assert child.stdin is not None
    with child.stdin, child.stdout:
        assert child.stdout.readline() == b"held\n"
        with pytest.raises(FolderTakenError):
            FolderClaim(tmp_path / "run")
        child.kill()
        child.wait()
    FolderClaim(tmp_path / "run").release()


def test_a_claim_that_was_not_used_leaves_nothing(tmp_path):
    claim = FolderClaim(tmp_path / "run")
    claim.release()
    claim.release()
    assert not (tmp_path / "run").exists()
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "notes.txt").write_text("keep")
    FolderClaim(tmp_path / "mine").release()
    assert [path.name for path in (tmp_path / "mine").iterdir()] == ["notes.txt"]


def test_free_folders_skip_runs_that_are_under_way_cut_short_or_over(tmp_path):
    taken = [claim_free(tmp_path, "wave"), claim_free(tmp_path, "wave")]
    assert [claim.directory.name for claim in taken] == ["wave", "wave-2"]
    cut = recorder(taken[0])
    cut.close()
    assert (tmp_path / "wave" / RUN_FILE).exists()
    assert claim_free(tmp_path, "wave").directory.name == "wave-3"
    for claim in taken:
        claim.release()


def test_a_file_in_the_way_is_one_sentence(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(RecordError, match="file is a file, but a folder for the record is asked for"):
        FolderClaim(tmp_path / "file")
    with pytest.raises(RecordError, match=r"opening the record in .* failed: Not a directory"):
        FolderClaim(tmp_path / "file" / "below")
