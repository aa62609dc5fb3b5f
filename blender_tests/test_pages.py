# SPDX-License-Identifier: GPL-3.0-or-later
"""The hand-written pages: short, in plain sentences, true to the files and commands there are."""

import re
from pathlib import Path
from statistics import mean

import pytest

ROOT = Path(__file__).resolve().parents[1]
README = ROOT / "README.md"
PAGES = [
    README,
    ROOT / "CONTRIBUTING.md",
    ROOT / "blender_tests/README.md",
    *sorted((ROOT / "docs").glob("*.md")),
]
MADE = ("build", "dist")  # what commands make is not in a clone
FILE = re.compile(r"[\w.*-]+(/[\w.*-]+)*\.(py|h|md|osl|toml|sh|txt|blend)")
LINK = re.compile(r"!?\[([^\]]*)\]\(([^)\s]+)\)")
SENTENCE_END = re.compile(r'(?<=[.!?])["*)]*\s+(?=["*(\[]*[A-Z`])')

each_page = pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))


def code(text: str) -> list[str]:
    """Return the indented blocks' lines and what stands in backticks."""
    return re.findall(r"^ {4}(.+)$", text, re.MULTILINE) + re.findall(r"`([^`\n]+)`", text)


def anchors(page: Path) -> set[str]:
    """Return the anchors of a page's headings, as GitHub makes them."""
    titles = re.findall(r"^#+ (.+)$", page.read_text("utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def sentences(text: str) -> list[str]:
    """Return the sentences of a page's prose, a point of a list being one at least."""
    prose = re.sub(r"^( {4}|\||#|<!--|!\[).*$", "", text, flags=re.MULTILINE)
    prose = LINK.sub(r"\1", prose)
    paragraphs = re.split(r"\n\s*\n|\n(?=- |\d+\. )", prose)
    parts = [part for text in paragraphs for part in SENTENCE_END.split(" ".join(text.split()))]
    return [part for part in parts if any(c.isalpha() for c in part)]


def test_the_readme_is_short() -> None:
    assert len(README.read_text("utf-8").split()) <= 900


@each_page
def test_sentences_are_short(page: Path) -> None:
    lengths = {sentence: len(sentence.split()) for sentence in sentences(page.read_text("utf-8"))}
    assert mean(lengths.values()) <= 20
    assert not [sentence for sentence, words in lengths.items() if words > 40]


@each_page
def test_links_lead_somewhere(page: Path) -> None:
    for _, link in LINK.findall(page.read_text("utf-8")):
        if link.startswith("https://"):
            continue
        path, _, anchor = link.partition("#")
        target = page.parent / path if path else page
        assert target.exists(), link
        assert not anchor or anchor in anchors(target), link


@each_page
def test_named_files_exist(page: Path) -> None:
    for words in code(page.read_text("utf-8")):
        top = words.partition("/")[0]
        is_path = FILE.fullmatch(words) or (
            "/" in words and " " not in words and (ROOT / top).is_dir()
        )
        if is_path and top not in MADE:
            bases = {ROOT, page.parent}
            assert any(any(base.glob(words.rstrip("/"))) for base in bases), words


@each_page
def test_named_commands_exist(page: Path) -> None:
    targets = re.findall(r"^([\w.-]+):.*## ", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE)
    for words in code(page.read_text("utf-8")):
        command = re.match(r"make ([\w.-]+)", words)
        assert not command or command[1] in targets, words
        module = re.match(r"python -m ([\w.]+)", words)
        if module:
            path = ROOT / module[1].replace(".", "/")
            assert path.with_suffix(".py").is_file() or (path / "__main__.py").is_file(), words


@each_page
def test_history_is_the_changelogs_alone(page: Path) -> None:
    assert not re.search(r"\b(formerly|no longer|previously)\b", page.read_text("utf-8"))
