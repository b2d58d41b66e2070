"""Look up whether a package that VIPO is built of is known to be weak, and say so plainly where nobody can be asked.

python scripts/audit.py [--pip-audit var/audit/bin/pip-audit]

Asks the advisory services of pip-audit about constraints.txt and of npm about each package-lock.json that is kept.
Ends with 0 when nothing is known against them, 1 when something is, and 2 when a service could not be asked: an audit
that asked nobody has found nothing out.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
CONSTRAINTS = ROOT / "constraints.txt"
PROBE = "Django"
"""A package of which every service has heard: if it has not, nobody was asked."""
CLEAN, WEAK, UNASKED = 0, 1, 2


@dataclass(frozen=True, slots=True)
class Findings:
    """What a service says of one list of packages; `unasked` is why it could not be asked, empty if it could."""

    about: str
    packages: int = 0
    weak: tuple[str, ...] = ()
    unasked: str = ""

    @property
    def code(self) -> int:
        """Return how a process ends that has found this."""
        return UNASKED if self.unasked else WEAK if self.weak else CLEAN

    def lines(self) -> Iterator[str]:
        """Yield what is told."""
        if self.unasked:
            yield f"{self.about}: no advisory service could be asked, so nothing is known. {self.unasked}"
        elif self.weak:
            yield f"{self.about}: of {self.packages} packages these are known to be weak:"
            yield from (f"  {line}" for line in self.weak)
        else:
            yield f"{self.about}: nothing is known against any of its {self.packages} packages."


def read_pip_audit(about: str, output: str, errors: str) -> Findings:
    """Read what `pip-audit --format json` says. What it skips it has not audited, though it ends with 0."""
    told = _json(output)
    if told is None or "dependencies" not in told:
        return Findings(about, unasked=_last_line(errors or output))
    packages = told["dependencies"]
    if skipped := [each for each in packages if "skip_reason" in each]:
        return Findings(about, unasked=f"{len(skipped)} of {len(packages)}: {skipped[0]['skip_reason']}.")
    weak = [
        f"{each['name']} {each['version']}: {found['id']}, mended in {', '.join(found['fix_versions']) or 'none yet'}"
        for each in packages
        for found in each["vulns"]
    ]
    return Findings(about, len(packages), tuple(weak))


def read_npm_audit(about: str, output: str, errors: str) -> Findings:
    """Read what `npm audit --json` says."""
    told = _json(output)
    if told is None or "vulnerabilities" not in told:
        return Findings(about, unasked=str((told or {}).get("message") or _last_line(errors or output)))
    weak = [
        f"{name} {each['range']}: {each['severity']}, {'can be mended' if each['fixAvailable'] else 'not mended yet'}"
        for name, each in sorted(told["vulnerabilities"].items())
    ]
    return Findings(about, told["metadata"]["dependencies"]["total"], tuple(weak))


def _json(text: str) -> dict[str, Any] | None:
    try:
        told = json.loads(text)
    except ValueError:
        return None
    return told if isinstance(told, dict) else None


def _last_line(text: str) -> str:
    return (text.strip().splitlines() or ["It said nothing."])[-1]


def audit_python(pip_audit: str) -> Findings:
    """Ask about constraints.txt; first about one package alone, so that nobody is asked in vain a hundred times."""
    pinned = CONSTRAINTS.read_text()
    probe = next(line for line in pinned.splitlines() if line.lower().startswith(f"{PROBE.lower()}=="))
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
        file.write(probe + "\n")
        file.flush()
        found = _ask_pip_audit(pip_audit, file.name)
    return found if found.unasked else _ask_pip_audit(pip_audit, str(CONSTRAINTS))


def _ask_pip_audit(pip_audit: str, file: str) -> Findings:
    pinned = ["--no-deps", "--disable-pip", "--requirement", file]
    done = _run([pip_audit, "--format", "json", "--progress-spinner", "off", *pinned], ROOT)
    return read_pip_audit(CONSTRAINTS.name, done.stdout, done.stderr)


def audit_javascript() -> Iterator[Findings]:
    """Ask about each package-lock.json."""
    kept = _run(["git", "ls-files", "*package-lock.json"], ROOT).stdout.split()
    for lock in kept:
        done = _run(["npm", "audit", "--json", "--package-lock-only"], (ROOT / lock).parent)
        yield read_npm_audit(lock, done.stdout, done.stderr)


def _run(command: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    # The commands are those of this file, and the program that `make audit` has installed.
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)  # noqa: S603


def main() -> int:
    """Ask everybody and tell what they say; the worst of it is the answer."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pip-audit", default=str(ROOT / "var" / "audit" / "bin" / "pip-audit"))
    options = parser.parse_args()
    findings = [audit_python(options.pip_audit), *audit_javascript()]
    for found in findings:
        sys.stdout.write("\n".join(found.lines()) + "\n")
    codes = {found.code for found in findings}
    return WEAK if WEAK in codes else max(codes)


if __name__ == "__main__":
    sys.exit(main())
