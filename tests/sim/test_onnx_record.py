"""Properties of ONNX files, from bytes made by hand."""

import pytest
from caretree.sim.errors import CaretreeError
from caretree.sim.onnx_record import read_properties


def field(number, data):
    length, head = len(data), []
    while length > 127:
        head.append(length & 127 | 128)
        length >>= 7
    return bytes([number << 3 | 2, *head, length]) + data


def test_properties_are_found_among_other_fields(tmp_path):
    long = "x" * 300
    file = tmp_path / "a.onnx"
    file.write_bytes(
        b"\x08\x08"  # field 1, a number: the version
        + field(7, b"a graph")
        + field(14, field(1, b"format") + field(2, b"one"))
        + field(14, field(1, b"long") + field(2, long.encode()))
    )
    assert read_properties(file) == {"format": "one", "long": long}


@pytest.mark.parametrize("data", [b"\x7a\xff", b"\x0b", b"\x3a\x7fshort"])
def test_what_is_no_message_is_refused_in_one_sentence(tmp_path, data):
    file = tmp_path / "b.onnx"
    file.write_bytes(data)
    with pytest.raises(CaretreeError, match="no network in an ONNX file"):
        read_properties(file)


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(CaretreeError, match="no network"):
        read_properties(tmp_path / "none.onnx")
