"""What the pages say holds: links lead somewhere and Python blocks run."""

import re
from pathlib import Path

import pytest
from caretree.skills.core.skill import Skill
from caretree.trees.proof.check import check
from caretree.trees.run.runner import run
from caretree.trees.run.task import Task, load_task

ROOT = Path(__file__).parents[2]
PAGES = sorted([ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").glob("*.md")])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text()):
        if "://" not in target:
            assert (page.parent / target).exists(), target


SOURCES = [path for top in ("sim", "perception", "learning", "skills", "trees") for path in (ROOT / top).rglob("*.py")]


def test_files_that_are_named_exist():
    named = re.compile(r"(?<![\w/])(?:sim|perception|learning|skills|trees|tests|docs)(?:/\w+)+\.(?:py|md)\b")
    lost = {
        f"{page.relative_to(ROOT)}: {file}"
        for page in [*PAGES, *SOURCES]
        for file in named.findall(page.read_text(encoding="utf-8"))
        if not (ROOT / file).exists()
    }
    assert lost == set()


XML = [(page.name, text) for page in PAGES for text in re.findall(r"```xml\n(.*?)```", page.read_text(), re.S)]


@pytest.mark.parametrize(("page", "text"), XML, ids=[page for page, _ in XML])
def test_xml_blocks_run(page, text, tmp_path):
    (tmp_path / "page.xml").write_text(text)
    task = load_task(str(tmp_path / "page.xml"))
    world, senses = task.scripted(0)
    assert check(task).ok
    assert run(task, world, senses=senses).outcome == "success"


BLOCKS = [(page.name, code) for page in PAGES for code in re.findall(r"```python\n(.*?)```", page.read_text(), re.S)]


@pytest.fixture
def registry():
    """Skills of the pages are no skills of the package: they leave the registry again."""
    before = list(Skill.registry)
    yield
    Skill.registry[:] = before


@pytest.mark.usefixtures("registry")
@pytest.mark.parametrize(("page", "code"), BLOCKS, ids=[page for page, _ in BLOCKS])
def test_python_blocks_run(page, code):
    names: dict[str, object] = {"__name__": "page"}
    exec(compile(code, page, "exec"), names)
    build = names.get("build")
    if callable(build):
        script = names.get("scripted")
        task = Task("page", build, ROOT / page, script if callable(script) else None)
        world, senses = task.scripted(0)
        assert check(task).ok
        result = run(task, world, senses=senses)
        assert result.outcome == "success", result.reason
