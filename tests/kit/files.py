"""Where the repository lies, and the files of it that many tests read."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FIXTURES = ROOT / "tests" / "fixtures"
FIGURE_5 = (FIXTURES / "figure-5.txt").read_bytes()
MIXER_TEXT = (ROOT / "registry" / "demo" / "devices" / "paintMixer03.ttl").read_text()


def describe_mixer(name: str) -> bytes:
    """Return the demo's description of a mixer in Turtle, for a mixer of this name."""
    return MIXER_TEXT.replace("paintMixer03", name).encode()


def link_micropython(state: Path) -> None:
    """Let a state folder begin with this machine's MicroPython, if it has one, to save fetching it."""
    fetched = ROOT / "var" / "micropython"
    if fetched.exists() and not (state / "micropython").exists():
        (state / "micropython").symlink_to(fetched)
