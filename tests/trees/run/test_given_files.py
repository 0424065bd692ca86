"""A record finds the files that its run was given from any folder, and tells when they are others by now."""

from argparse import Namespace

import pytest
from caretree.trees.run.given_files import HASHES, changed_files, hashes_of, place_files


@pytest.fixture
def gown(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "gown.yaml").write_text("base: medium")
    (tmp_path / "medium").write_text("a file called as a gown is")
    return tmp_path / "gown.yaml"


def noted(**given):
    return {**given, HASHES: hashes_of(given)}


def test_files_are_given_with_their_whole_path_and_names_stay(gown):
    options = Namespace(gown="gown.yaml", model=None)
    place_files(options)
    assert (options.gown, options.model) == (str(gown), None)
    options = Namespace(gown="medium", model="nowhere.yaml")
    place_files(options)
    assert (options.gown, options.model) == ("medium", "nowhere.yaml")


def test_a_changed_and_a_lost_file_are_told(gown):
    record = noted(gown=str(gown), model="model.yaml")
    assert set(record[HASHES]) == {"gown"}
    assert changed_files(record) == ""
    gown.write_text("base: long")
    assert changed_files(record) == f"the gown file {gown} has been changed since"
    gown.unlink()
    assert changed_files(record) == f"the gown file {gown} is gone since"


def test_a_record_without_hashes_is_believed(gown):
    assert changed_files({"gown": str(gown)}) == ""
    assert changed_files({"gown": str(gown), HASHES: "damaged"}) == ""
