import json
import threading

import pytest
from caretree.sim.errors import RecordError
from caretree.sim.log.log_file import LogFile

pytest.importorskip("mcap", reason="mcap is an extra: pip install 'caretree[log]'")
from mcap.reader import make_reader


def messages(path):
    with path.open("rb") as file:
        return [
            (schema.name, channel.topic, message.log_time, message.sequence, json.loads(message.data))
            for schema, channel, message in make_reader(file).iter_messages()
        ]


def test_the_public_reader_opens_it(tmp_path):
    log = LogFile(tmp_path / "deep/run.mcap")
    log.attach("note.txt", "text/plain", "a note")
    log.write(0.5, [("/sent", "caretree.Sent", {"command": "stop"})])
    log.write(1.5, [("/sent", "caretree.Sent", '{"command":"go"}')])
    log.close()
    log.close()
    assert messages(log.path) == [
        ("caretree.Sent", "/sent", 500_000_000, 1, {"command": "stop"}),
        ("caretree.Sent", "/sent", 1_500_000_000, 2, {"command": "go"}),
    ]
    with log.path.open("rb") as file:
        (note,) = make_reader(file).iter_attachments()
    assert (note.name, note.data) == ("note.txt", b"a note")


def test_numbers_that_are_none_are_null(tmp_path):
    log = LogFile(tmp_path / "run.mcap")
    log.write(0.0, [("/sent", "caretree.Sent", {"command": "go", "times": [1.0, float("nan")], "speed": float("inf")})])
    log.close()
    assert messages(log.path)[0][4] == {"command": "go", "times": [1.0, None], "speed": None}


def test_a_log_is_not_written_over(tmp_path):
    path = tmp_path / "run.mcap"
    LogFile(path).close()
    with pytest.raises(RecordError, match=r"run\.mcap is there already: give another file with --log"):
        LogFile(path)


def test_a_folder_that_cannot_be_written_is_told(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(RecordError, match="cannot be written"):
        LogFile(tmp_path / "file/run.mcap")


def test_a_full_disk_is_told_at_the_end_and_stops_nothing(tmp_path):
    log = LogFile(tmp_path / "run.mcap")

    def full(*_, **__):
        raise OSError(28, "No space left on device")

    log._writer.add_message = full
    for _ in range(3):
        log.write(0.0, [("/sent", "caretree.Sent", {"command": "stop"})])
    with pytest.raises(RecordError, match=r"run\.mcap is not whole: No space left on device"):
        log.close()
    log.close()


def test_threads_may_write_at_once_and_after_the_end(tmp_path):
    log = LogFile(tmp_path / "run.mcap")
    begin = threading.Barrier(4)

    def many():
        begin.wait()
        for n in range(50):
            log.write(float(n), [("/sent", "caretree.Sent", {"command": "stop"})])

    threads = [threading.Thread(target=many) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    log.close()
    log.write(60.0, [("/sent", "caretree.Sent", {"command": "stop"})])
    found = messages(log.path)
    assert sorted(each[3] for each in found) == list(range(1, 201))
