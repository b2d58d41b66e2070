"""What `make audit` makes of the answers of pip-audit and npm, most of all where these were given by nobody."""

from __future__ import annotations

import json

import pytest

from scripts.audit import CLEAN, CONSTRAINTS, PROBE, UNASKED, WEAK, Findings, read_npm_audit, read_pip_audit

WEAK_DJANGO = {"id": "PYSEC-2026-1", "fix_versions": ["5.2.20"], "aliases": [], "description": "Long"}
SKIPPED = {"name": "django", "skip_reason": "Dependency not found on PyPI and could not be audited: django (5.2.19)"}
NPM_REFUSED = {"message": "405 Method Not Allowed - POST https://registry.example/bulk", "error": {"summary": ""}}
NPM_WEAK = {
    "vulnerabilities": {"ws": {"range": "<8.17.1", "severity": "high", "fixAvailable": True}},
    "metadata": {"dependencies": {"total": 12}},
}


def pip(*packages: object, errors: str = "") -> Findings:
    return read_pip_audit("constraints.txt", json.dumps({"dependencies": packages, "fixes": []}), errors)


def test_packages_of_which_nothing_is_known_are_clean() -> None:
    found = pip({"name": "django", "version": "5.2.19", "vulns": []})
    assert (found.code, found.packages, found.weak) == (CLEAN, 1, ())
    npm = read_npm_audit("a", json.dumps({**NPM_WEAK, "vulnerabilities": {}}), "")
    assert list(npm.lines()) == ["a: nothing is known against any of its 12 packages."]


def test_a_weak_package_is_named_with_what_mends_it() -> None:
    found = pip({"name": "django", "version": "5.2.19", "vulns": [WEAK_DJANGO]})
    assert (found.code, found.weak) == (WEAK, ("django 5.2.19: PYSEC-2026-1, mended in 5.2.20",))
    npm = read_npm_audit("a", json.dumps(NPM_WEAK), "")
    assert (npm.code, npm.weak) == (WEAK, ("ws <8.17.1: high, can be mended",))


@pytest.mark.parametrize(
    ("found", "why"),
    [
        (pip(SKIPPED), "1 of 1: Dependency not found on PyPI and could not be audited: django (5.2.19)."),
        (read_pip_audit("a", "", "Traceback\nrequests.ConnectionError: no name"), "requests.ConnectionError: no name"),
        (read_npm_audit("a", json.dumps(NPM_REFUSED), ""), NPM_REFUSED["message"]),
        (read_npm_audit("a", "", ""), "It said nothing."),
        (read_npm_audit("a", "[]", "npm error no network"), "npm error no network"),
    ],
)
def test_a_service_that_was_not_asked_is_never_told_as_clean(found: Findings, why: str) -> None:
    assert (found.code, found.unasked) == (UNASKED, why)
    assert "no advisory service could be asked, so nothing is known" in next(found.lines())


def test_the_package_that_is_asked_about_first_is_pinned() -> None:
    assert any(line.startswith(f"{PROBE}==") for line in CONSTRAINTS.read_text().splitlines())
