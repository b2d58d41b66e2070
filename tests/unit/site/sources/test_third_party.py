"""Every package that VIPO asks for is named in docs/third-party.md, and every one in Python is used."""

from __future__ import annotations

import json
import re
import tomllib
from functools import cache
from importlib.metadata import packages_distributions

from tests.kit.files import ROOT

PAGE = (ROOT / "docs" / "third-party.md").read_text()
SOURCES = (
    "vipo_*",
    "registry",
    "editor",
    "simulation",
    "execution",
    "connectors",
    "firmware",
    "tests",
    "bench",
    "scripts",
)
IMPORT = re.compile(r"^\s*(?:import|from) (\w+)", re.MULTILINE)
NOT_IMPORTED = {
    "django-stubs": "mypy loads it, as pyproject.toml says",
    "import-linter": "a command",
    "mypy": "a command",
    "pytest-asyncio": "pytest loads it by itself",
    "pytest-timeout": "pytest loads it by itself",
    "ruff": "a command",
    "sniffio": "servestatic imports it where it is there",
    "types-pyyaml": "mypy finds it by itself",
}


def asked_for_in_python() -> set[str]:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    wanted = [
        *project["dependencies"],
        *(each for extra in project["optional-dependencies"].values() for each in extra),
    ]
    return {plain(re.split(r"[\[<>=~!; ]", each)[0]) for each in wanted} - {project["name"]}


def asked_for_in_javascript() -> set[str]:
    package = json.loads((ROOT / "frontend" / "package.json").read_text())
    return {*package["dependencies"], *package["devDependencies"]}


def named_on_the_page() -> set[str]:
    """Return what the first cells of the tables name, without what stands in brackets."""
    cells = [line.split("|")[1] for line in PAGE.splitlines() if line.startswith("|")]
    return {name.strip().lower() for cell in cells for name in re.sub(r"\(.*?\)", "", cell).split(",")}


@cache
def imported() -> set[str]:
    """Return the packages that any module of VIPO, its tests or its scripts imports, by their names in an index."""
    files = [path for folder in SOURCES for root in ROOT.glob(folder) for path in root.rglob("*.py")]
    modules = {module for path in files for module in IMPORT.findall(path.read_text())}
    owners = packages_distributions()
    return {plain(owner) for module in modules for owner in owners.get(module, ())}


def plain(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def test_every_package_is_named_with_its_purpose() -> None:
    assert sorted((asked_for_in_python() | asked_for_in_javascript()) - named_on_the_page()) == []


def test_every_package_in_python_is_used() -> None:
    assert sorted(name for name in asked_for_in_python() - imported() if name not in NOT_IMPORTED) == []


def test_what_is_said_not_to_be_imported_is_asked_for_and_is_not() -> None:
    assert sorted(NOT_IMPORTED.keys() - asked_for_in_python()) == []
    assert sorted(NOT_IMPORTED.keys() & imported()) == []
